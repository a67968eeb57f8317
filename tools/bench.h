#pragma once
// Measurements: kernels on a mesh, the compiler, contact, whole scenes, and what accuracy costs.

#include <iosfwd>
#include <string>
#include <vector>

#include "tools/rows.h"

namespace ergon {

struct BenchKernels {
  std::vector<std::string> energies;  // empty: the catalogue
  std::string element;                // "": one that fits each density
  std::string entry;                  // value, gradient, hessian; "": all three
  std::string projection = "clamp";
  std::string precision = "double";
  std::vector<std::string> set;  // inputs by NAME=VALUE; the others are chosen within their ranges
  int lanes = 0;                 // 0: as many as this machine has
  int threads = 1;
  int cells = 40;               // per edge of a cube
  int quadrature = -1;          // exactness; negative: the element's default
  std::string state = "noise";  // rest, noise, definite or indefinite
};
// States: the mesh at rest; displaced by noise of 0.15 cells; stretched to 1.1 or pressed to 0.8 times its size with
// noise of 0.02 cells, where a solid's Hessians are all definite or none is. Rows tell the share that projection
// changed. One row per energy, case and entry. Wall-clock time per call, the median of at least five calls and one
// second, after a first call that builds what later calls reuse. Throws SourceError and InputError.
void bench_kernels(const BenchKernels& options, Rows& rows);

struct BenchCompile {
  std::vector<std::string> energies;  // empty: the catalogue
  bool slowest = false;               // two rows more: the largest of every figure
};
// Two rows per energy and case: from nothing (the median of three), and again with the cache that this left (of five).
void bench_compile(const BenchCompile& options, Rows& rows);

struct BenchCcd {
  long queries = 100000;  // over all rows; subdivision, which is slow, does a twentieth of its share
  double kept = 0.1;      // fraction of each gap that steps leave
};
// Continuous collision detection by itself, on one thread, by both methods: random queries near contact and adversarial
// ones. Times per query; every answer is judged by a decision without rounding. Throws InputError for options out of
// range.
void bench_ccd(const BenchCcd& options, Rows& rows);

struct BenchContact {
  int cells = 199;  // of each cloth, per edge
  std::string barrier = "squared_log_barrier";
  int threads = 1;
};
// The parts of contact on two cloths of side 1 m with (cells + 1)^2 vertices each, noisy and close enough for the
// barrier to act everywhere: one row per part. Throws SourceError and InputError.
void bench_contact(const BenchContact& options, Rows& rows);

struct BenchAccuracy {
  std::vector<std::string> problems;  // empty: all
  bool brief = false;                 // a few coarse settings
  bool again = false;                 // runs that the folder holds too
  bool json = false;
  bool progress = false;                // a line for each run
  std::string folder = "out/accuracy";  // of accuracy.csv, PROBLEM.svg and, to go on from, every run
};
// Families of settings (element, mesh, integrator, dt, tolerance, precision) over the problems of
// tools/study/accuracy_problems.h: the error of each run against a reference, its time and its work; for each problem
// the Pareto front and the cheapest settings within 10, 1 and 0.1 percent. Throws SourceError, InputError, OutputError.
void bench_accuracy(const BenchAccuracy& options, std::ostream& out);

struct BenchStopping {
  std::string study;  // tolerance, friction or barrier; "": all
  bool brief = false;
  bool again = false;
  bool json = false;
  std::string folder = "out/stopping";  // of every run, to go on from
};
// What Newton's tolerance, the lag of friction and the barrier's reach and stiffness add to the error, each varied by
// itself, beside what dt and mesh make of it. Throws as bench_accuracy does.
void bench_stopping(const BenchStopping& options, std::ostream& out);

}  // namespace ergon

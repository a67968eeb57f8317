#pragma once
// A scene run for a study: where its probes are at the times at which frames would be written, and what that cost in
// seconds and in work that can be counted.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace ergon {

struct StudyRun {
  // m, 3 x probes for each time that is a multiple of the scene's frame_interval, the start first.
  std::vector<Eigen::Matrix3Xd> x;
  std::string failure;  // "" where the scene ran to its end
  double seconds = 0;   // of processor time, all steps; reading and building are left out
  long steps = 0;
  long newton_iterations = 0;
  long linear_solves = 0;
  double factor_flops = 0;    // of all factorisations
  double hessian_points = 0;  // Hessians evaluated, one for each point of quadrature or stencil
  int vertices = 0;

  // Floating-point operations, for comparisons that the machine's noise cannot decide: those of all factorisations, and
  // for every Hessian at a point of quadrature as many as a factorisation does in the time that it takes to evaluate,
  // project and assemble.
  double work() const;
};

// Root of the mean square over all times and probes of |x - x of the reference|, divided by that of the reference's
// displacement from the start. inf for a run that failed. Throws std::logic_error for runs of other times or probes.
double study_error(const StudyRun& run, const StudyRun& reference);

// Runs scenes with changed values, and remembers.
class StudyRunner {
 public:
  // folder: keeps what was run in FOLDER/runs, one file per run, named by its scene; "": nothing is kept. again: what
  // is there is not used.
  StudyRunner(std::string folder, bool again) : folder_(std::move(folder)), again_(again) {}

  // scene: the name of a scene in scenes/studies; changes: "PATH=VALUE", as those of `ergon run --set`. Runs on one
  // thread. Throws SourceError for what is wrong with the scene or a change; a step that fails is told in the run.
  StudyRun run(const std::string& scene, const std::vector<std::string>& changes);

 private:
  std::string folder_;
  bool again_;
};

}  // namespace ergon

#pragma once
// What a Potential holds: its data as it was given and in lane order. Included by potential*.cpp and system*.cpp only.

#include <algorithm>
#include <string>
#include <vector>

#include "runtime/aligned.h"
#include "runtime/lanes/lanes.h"
#include "runtime/potential.h"

namespace ergon {

struct Potential::Impl {
  std::string name;
  Kernel kernel;
  int lanes = 1;
  int points = 0;
  int quadrature = 1;
  int count = 0;

  std::vector<int> stencils;    // as given
  int first_vertex = 0;         // of the system, where rest begins
  Eigen::Matrix3Xd rest;        // rest positions of a density whose q is F - I, else empty
  AlignedVector<int> vertices;  // [block][points][lanes]
  AlignedVector<double> table;  // lanes::Stencils::table, empty for null
  std::vector<double> axis;     // lanes::Stencils::axis, empty for null
  std::vector<int> axis_nodes;
  AlignedVector<double> weights;   // lanes::Stencils::weights
  AlignedVector<double> volumes;   // [block][quadrature][lanes]
  AlignedVector<double> raw;       // [block][kernel->raw][lanes]
  AlignedVector<double> elements;  // [block][kernel->elements][lanes]
  AlignedVector<double> uniforms;
  std::vector<double> params;
  std::vector<char> lag_set;  // per input

  bool params_changed = true;  // uniforms and elements are to be prepared
  bool raw_changed = true;     // elements are to be prepared
  // Counted up by every change, so that a System sees which of its copies is out of date.
  unsigned long stencil_version = 1;
  unsigned long lag_version = 1;
  unsigned long param_version = 1;

  // Stencils are cut into chunks of `chunk` blocks (the last may be shorter). Within a chunk of n blocks, lane l holds
  // n stencils that follow one another: neighbours share vertices, and lanes of one block should not.
  int chunk = 1;
  int blocks() const { return (count + lanes - 1) / lanes; }
  int chunks() const { return (blocks() + chunk - 1) / chunk; }
  // The stencil in a lane; in a lane of padding, the chunk's last.
  int stencil_in(int block, int lane) const {
    const int first = block / chunk * chunk, n = std::min(chunk, blocks() - first);
    return std::min(first * lanes + lane * n + block - first, std::min((first + n) * lanes, count) - 1);
  }
  // Lanes from this one on are padding.
  int lanes_in(int block) const {
    const int first = block / chunk * chunk, n = std::min(chunk, blocks() - first);
    return std::min(lanes, (count - first * lanes - (block - first) + n - 1) / n);
  }
  void cut();

  // Checks the kernel and sets what follows from it alone.
  void bind(std::string potential_name, Kernel bound);
  void check_params(const Parameters& values) const;  // throws when one is missing
  void give_params(const Parameters& values);
  bool ascending() const { return kernel->density != 0 && table.empty(); }  // points of each stencil
  // Lane-ordered vertices of stencils.
  void order_vertices(const std::vector<int>& given);
  void allocate_raw();
  // Writes one value set for all stencils or one per stencil into raw.
  void write_raw(const ErgonInput& input, const std::vector<double>& values, const char* kind);
  const ErgonInput& input(const std::string& wanted, int role, const char* kind) const;
  // Fills rest data from `rest`, or from X for a rest vector named like a point.
  void give_rest(const Eigen::Matrix3Xd& X, const std::map<std::string, std::vector<double>>& rest);

  // Prepares uniforms and elements if anything changed. Throws std::logic_error for a lag that was never set.
  void prepare();
  lanes::Stencils view() const;

  [[noreturn]] void fail(const std::string& what) const;  // InputError that starts with the potential's name
};

}  // namespace ergon

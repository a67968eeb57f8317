#pragma once
// What a Potential holds: its data as it was given and in lane order. Included by potential*.cpp and system*.cpp only.

#include <algorithm>
#include <string>
#include <vector>

#include "runtime/aligned.h"
#include "runtime/lanes/lanes.h"
#include "runtime/potential.h"

namespace ergon {

inline int size_of(const ErgonInput& input) { return input.rows * input.cols; }
std::string values_text(size_t count);  // "1 value", "2 values"

struct Potential::Impl {
  std::string name;
  Kernel kernel;
  int lanes = 1;
  int points = 0;  // of a stencil that are evaluated
  int quadrature = 1;
  int count = 0;

  std::vector<int> stencils;  // as given, `listed` vertices each
  int listed = 0;
  bool combined = false;        // by weights of each stencil's own
  std::vector<int> names;       // of the points that are listed: kernel->point_names; empty when combined
  std::vector<int> used;        // places in the list of the points that are evaluated
  int first_vertex = 0;         // of the system, where rest begins
  Eigen::Matrix3Xd rest;        // rest positions of a density whose q is F - I, else empty
  AlignedVector<int> vertices;  // [block][points][lanes]
  AlignedVector<double> table;  // lanes::Stencils::table, empty for null
  std::vector<double> axis;     // lanes::Stencils::axis, empty for null
  std::vector<int> axis_nodes;
  AlignedVector<double> weights;   // lanes::Stencils::weights
  AlignedVector<double> frames;    // lanes::Stencils::frames, empty for null
  AlignedVector<double> volumes;   // [block][quadrature][lanes]
  AlignedVector<double> raw;       // [block][quadrature][kernel->raw][lanes]
  AlignedVector<double> elements;  // [block][quadrature][kernel->elements][lanes]
  AlignedVector<double> uniforms;
  AlignedVector<float> single_elements;  // of a kernel in single precision, in place of these two
  AlignedVector<float> single_uniforms;
  std::vector<double> params;
  std::vector<char> lag_set;  // per input
  std::map<std::string, TimedValues> timed;
  // The same potential with the kernel that gives its Hessian, where that is not the one that gives value and gradient.
  std::shared_ptr<Impl> curvature;

  bool params_changed = true;  // uniforms and elements are to be prepared
  bool raw_changed = true;     // elements are to be prepared
  // Counted up by every change, so that a System sees which of its copies is out of date.
  unsigned long stencil_version = 1;
  unsigned long lag_version = 1;
  unsigned long param_version = 1;  // of rest data as well

  // Stencils are cut into chunks of `chunk` blocks (the last may be shorter). Within a chunk of n blocks, lane l holds
  // n stencils that follow one another: neighbours share vertices, and lanes of one block should not.
  int chunk = 1;
  int blocks() const { return (count + lanes - 1) / lanes; }
  int chunks() const { return (blocks() + chunk - 1) / chunk; }
  std::vector<int> order;         // of stencils; empty: as given
  std::vector<int> lane_stencil;  // [block][lane]; in a lane of padding, the chunk's last
  // Lanes from this one on are padding.
  int lanes_in(int block) const {
    const int first = block / chunk * chunk, n = std::min(chunk, blocks() - first);
    return std::min(lanes, (count - first * lanes - (block - first) + n - 1) / n);
  }
  void order_stencils();
  void cut();
  std::vector<int> keys, start;  // room of order_stencils

  // Checks the kernel and sets what follows from it alone.
  void bind(std::string potential_name, Kernel bound);
  void check_params(const Parameters& values) const;  // throws when one is missing
  void give_params(const Parameters& values);
  bool ascending() const { return kernel->density != 0 && table.empty(); }  // points of each stencil
  void bind_stencils(std::string potential_name, Kernel bound, const Parameters& values);
  // Lists all points of a stencil energy, or those that its q depends on, and evaluates the latter.
  void list_points(bool all);
  // Takes a list of stencils over, in lanes. `vertex_count` < 0: not known.
  void take_list(const std::vector<int>& given, int vertex_count);
  // Lane-ordered vertices of stencils: `points` of each, `step` apart, at the places `chosen`.
  void order_vertices(const std::vector<int>& given, int step, const std::vector<int>& chosen);
  void take_weights(const std::vector<double>& given);
  void allocate_raw();
  // Writes one value set for all stencils, one per stencil or one per point of quadrature into raw.
  void write_raw(const ErgonInput& input, const std::vector<double>& values, const char* kind);
  bool single() const { return kernel->single != nullptr; }
  const ErgonInput& input(const std::string& wanted, int role, const char* kind) const;
  // Fills rest data from `rest`, or from X for a rest vector named like a point that is listed.
  void give_rest(const Eigen::Matrix3Xd& X, const StencilData& rest);

  // Prepares uniforms and elements if anything changed. Throws std::logic_error for a lag that was never set.
  void prepare();
  lanes::Stencils view() const;

  [[noreturn]] void fail(const std::string& what) const;  // InputError that starts with the potential's name
};

}  // namespace ergon

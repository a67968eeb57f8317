#pragma once
// A potential: a law (kernel) on a mesh (stencils) with its data. It establishes the lane-ordered copies that
// evaluation reads, so that nothing is converted while a scene runs.

#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/kernel.h"
#include "runtime/mesh/mesh.h"

namespace ergon {

// What is done to a Hessian that is not positive semi-definite: eigenvalues below zero become zero, become positive, or
// stay.
enum class Projection { clamp, absolute, none };

// A loaded kernel and whatever keeps it loaded.
struct Kernel {
  std::shared_ptr<void> library;
  const ErgonKernel* table = nullptr;
  // Where this is set it gives the Hessian, and this kernel only value and gradient: the same energy in single
  // precision, of more lanes.
  std::shared_ptr<const Kernel> curvature = nullptr;
  const ErgonKernel* operator->() const { return table; }
};

// Values of params by name, components column by column.
using Parameters = std::map<std::string, std::vector<double>>;
// Rest data by name, one value set per stencil.
using StencilData = std::map<std::string, std::vector<double>>;
// Values of a param or rest data at a time (s).
using TimedValues = std::function<std::vector<double>(double time)>;

class Potential {
 public:
  // A density on every cell of a mesh. Vertex v of the mesh is vertex first_vertex + v of the system. `exactness` of
  // the quadrature: 0 to kMaxExactness, or the element's default. Throws InputError for a param that is missing,
  // unknown or of the wrong size, an element the density cannot live on, and cells that check_mesh refuses. Rest data:
  // one value set per cell, or one per point of quadrature of each (runtime/mesh/sites.h), as params that vary are
  // (symbolic/varied.h).
  static Potential on_mesh(std::string name, Kernel kernel, const Mesh& mesh, int first_vertex,
                           const Parameters& params, std::optional<int> exactness = std::nullopt,
                           const StencilData& rest = {});

  // A stencil energy: the vertices of the kernel's points, one stencil after the other. `rest` holds rest data by name,
  // one value set per stencil (components adjacent): a rest vector that is named like a dof but with a capital first
  // letter (X0 for x0) and is absent from `rest` is filled with that point's column of X.
  static Potential on_stencils(std::string name, Kernel kernel, const std::vector<int>& stencils,
                               const Eigen::Matrix3Xd& X, const Parameters& params, const StencilData& rest);
  // The same where a stencil names only the points that the kernel's q depends on (a point beside an edge takes three
  // points of the four of point-triangle energies).
  static Potential on_used_points(std::string name, Kernel kernel, const std::vector<int>& stencils,
                                  const Eigen::Matrix3Xd& X, const Parameters& params, const StencilData& rest);
  // A stencil energy whose q is formed with weights of each stencil's own, given to set_combinations, over `points`
  // vertices per stencil, 1 to 12, whatever the points of the energy: q_k = sum_a w_ka x_a. Without stencils at first.
  static Potential on_combinations(std::string name, Kernel kernel, int points, const Parameters& params);

  const std::string& name() const;
  const ErgonKernel& kernel() const;
  int stencil_count() const;       // cells or stencils
  int points_per_stencil() const;  // that a list of stencils names
  int quadrature_points() const;   // per stencil; 1 for a stencil energy
  const std::vector<int>& stencils() const;

  // Replaces the list of stencils (contact): rest data as in on_stencils; lag data must be set again. Asks for no
  // memory while the list is not longer than every one before it.
  void set_stencils(const std::vector<int>& stencils, const Eigen::Matrix3Xd& X, const StencilData& rest);
  // The same for on_combinations: weights[(stencil*q_vectors + k)*points + a], pure numbers; all rest data is given.
  void set_combinations(const std::vector<int>& stencils, const std::vector<double>& weights, const StencilData& rest);

  // Lag data by name: one value set for all stencils, one per stencil (components adjacent), or one per point of
  // quadrature of each.
  // Evaluation throws std::logic_error while a lag has never been set.
  void set_lag(const std::string& lag, const std::vector<double>& values);
  void set_param(const std::string& param, const std::vector<double>& values);
  // Rest data by name, as set_lag.
  void set_rest(const std::string& rest, const std::vector<double>& values);

  // A param or rest data that is a function of time: set_time gives it its values, and a time step calls that at the
  // end of each stage.
  void follow(const std::string& name, TimedValues values);
  void set_time(double time);  // s
  bool follows_time() const;

  // Of a density: F at every point of quadrature of every cell, column by column, in the axes of space.
  std::vector<double> deformation(const Eigen::Matrix3Xd& x) const;
  // New values of the lags that the energy renews itself, by name, one set for every stencil or point of quadrature;
  // from what it sees at positions x and the lags as they are.
  StencilData renewed(const Eigen::Matrix3Xd& x) const;

  struct Impl;
  std::shared_ptr<Impl> impl;
};

}  // namespace ergon

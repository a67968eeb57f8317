#pragma once
// A potential: a law (kernel) on a mesh (stencils) with its data. It establishes the lane-ordered copies that
// evaluation reads, so that nothing is converted while a scene runs.

#include <Eigen/Core>
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
  const ErgonKernel* operator->() const { return table; }
};

// Values of params by name, components column by column.
using Parameters = std::map<std::string, std::vector<double>>;

class Potential {
 public:
  // A density on every cell of a mesh. Vertex v of the mesh is vertex first_vertex + v of the system. `exactness` of
  // the quadrature: 0 to kMaxExactness, or the element's default. Throws InputError for a param that is missing,
  // unknown or of the wrong size, an element the density cannot live on, and cells that check_mesh refuses.
  static Potential on_mesh(std::string name, Kernel kernel, const Mesh& mesh, int first_vertex,
                           const Parameters& params, std::optional<int> exactness = std::nullopt);

  // A stencil energy: `points` vertices per stencil, one stencil after the other. `rest` holds rest data by name, one
  // value set per stencil (components adjacent): a rest vector that is named like a dof but with a capital first letter
  // (X0 for x0) and is absent from `rest` is filled with that point's column of X.
  static Potential on_stencils(std::string name, Kernel kernel, std::vector<int> stencils, const Eigen::Matrix3Xd& X,
                               const Parameters& params, const std::map<std::string, std::vector<double>>& rest);

  const std::string& name() const;
  const ErgonKernel& kernel() const;
  int stencil_count() const;  // cells or stencils
  int points_per_stencil() const;
  int quadrature_points() const;  // per stencil; 1 for a stencil energy
  const std::vector<int>& stencils() const;

  // Replaces the list of stencils (contact): rest data as in on_stencils; lag data must be set again.
  void set_stencils(std::vector<int> stencils, const Eigen::Matrix3Xd& X,
                    const std::map<std::string, std::vector<double>>& rest);

  // Lag data by name: one value set for all stencils, or one per stencil (components adjacent).
  // Evaluation throws std::logic_error while a lag has never been set.
  void set_lag(const std::string& lag, const std::vector<double>& values);
  void set_param(const std::string& param, const std::vector<double>& values);

  struct Impl;
  std::shared_ptr<Impl> impl;
};

}  // namespace ergon

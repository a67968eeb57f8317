#pragma once
// A body in equilibrium: one mesh, laws of the catalogue on it, what holds it and what loads it. It establishes that a
// state is only looked at after Newton's method has converged to it.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/mesh/mesh.h"
#include "runtime/solver/newton.h"
#include "runtime/system.h"

namespace ergon {

// Vertices whose rest position is chosen.
std::vector<int> vertices_where(const Mesh& mesh, const std::function<bool(const Eigen::Vector3d& X)>& chosen);
// The one nearest to a place.
int vertex_near(const Mesh& mesh, const Eigen::Vector3d& place);

// A kernel of the catalogue, for as many lanes as this machine has.
Kernel catalogue_kernel(const std::string& law);

class Model {
 public:
  // `normals`: with the tips of the normals amid edges, of which laws over a shell_triangle know, as further columns of
  // x.
  explicit Model(Mesh mesh, bool normals = false);

  const Mesh& mesh() const { return mesh_; }
  Eigen::Matrix3Xd x;  // m, where the vertices are; at first as in the mesh

  // A density on the cells, or a stencil energy on all stencils of its kind; rest data are positions and sizes (X0, L0,
  // A ...), as scenes give them. Its number.
  int add(const std::string& law, const Parameters& params, std::optional<int> exactness = std::nullopt);
  // A force (N) that keeps its direction, of which each vertex has a share.
  int add_load(const Eigen::VectorXd& shares, const Eigen::Vector3d& force);
  void set_load(int load, const Eigen::Vector3d& force);

  // A plane of symmetry across an axis, of "xyz", through the origin: neither vertices in it nor the normals of edges
  // in it leave it. Comes before add().
  void mirror(char axis);
  // Vertices that do not move along axes, of "xyz". Adds to what was held before.
  void hold(const std::vector<int>& vertices, std::string_view axes = "xyz");

  // The same of the normals of edges both of whose ends are among the vertices.
  void hold_normals(const std::vector<int>& vertices);

  // x as it was at first.
  void to_rest() { x = rest_; }
  // Moves x to equilibrium, such that Newton's last step is below `tolerance` (m). Throws std::runtime_error where that
  // fails.
  NewtonResult solve(double tolerance);
  // Whether the equilibrium is stable: its tangent is positive definite.
  bool stable();
  // What potentials pull the vertices with, N: on those that are held, their reactions.
  Eigen::Matrix3Xd reactions();
  // The tangent as it is, and the block row of a vertex in it.
  const BlockMatrix& tangent();
  System& system() { return system_; }

 private:
  void apply_holds();

  Eigen::Matrix3Xd rest_;  // x at first
  Mesh mesh_;
  System system_;
  Newton newton_;
  LinearSolver solver_;
  BlockMatrix tangent_;
  std::vector<unsigned char> held_;  // per vertex, bit k: along axis k
  bool holds_changed_ = false;
};

}  // namespace ergon

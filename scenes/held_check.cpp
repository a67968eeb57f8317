#include "scenes/held_check.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

namespace ergon {
namespace {

// Rounding of a sum that would be zero, relative to what it is a sum of.
constexpr double nothing = 1e-10;

struct Translation {
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  // N/m, against moving all vertices of an object alike
  double scale = 0;                                     // N/m, of the terms
};

Eigen::Matrix3d block_of(const BlockMatrix& matrix, ptrdiff_t start, int column) {
  Eigen::Matrix3d out;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      out(r, c) = matrix.values()[static_cast<size_t>(start + c * matrix.column_stride(column) + r)];
  return out;
}

// By object: -1 for the block rows of none.
std::vector<Translation> translations(const BlockMatrix& matrix, const std::vector<int>& object, size_t objects) {
  std::vector<Translation> out(objects);
  for (int j = 0; j < matrix.block_rows(); ++j) {
    const int mine = object[static_cast<size_t>(j)];
    if (mine < 0) continue;
    const int first = matrix.column_start()[3 * static_cast<size_t>(j)];
    for (int start = first; start < first + matrix.column_stride(j); start += 3) {
      const int i = matrix.row_index()[static_cast<size_t>(start)] / 3;
      if (object[static_cast<size_t>(i)] != mine) continue;
      Eigen::Matrix3d block = block_of(matrix, start, j);
      if (i == j) block = Eigen::Matrix3d(block.selfadjointView<Eigen::Lower>());
      Translation& sum = out[static_cast<size_t>(mine)];
      sum.stiffness += i == j ? block : Eigen::Matrix3d(block + block.transpose());
      sum.scale += block.cwiseAbs().maxCoeff();
    }
  }
  return out;
}

// By object: the first of those that attachments join it with, which are held as one.
std::vector<int> groups_of(const Scene& scene) {
  std::vector<int> out(scene.objects.size());
  std::iota(out.begin(), out.end(), 0);
  const auto index = [&](const std::string& name) {
    const auto is_it = [&](const SceneObject& object) { return object.name == name; };
    return std::find_if(scene.objects.begin(), scene.objects.end(), is_it) - scene.objects.begin();
  };
  for (const SceneAttachment& attachment : scene.attachments) {
    const auto a = static_cast<size_t>(index(attachment.object)), b = static_cast<size_t>(index(attachment.to));
    if (b == out.size()) continue;  // an obstacle, or places in space
    const int from = std::max(out[a], out[b]), to = std::min(out[a], out[b]);
    std::replace(out.begin(), out.end(), from, to);
  }
  return out;
}

}  // namespace

void check_held(const Scene& scene, BuiltScene& built) {
  System& system = *built.system;
  stepper_of(built).energies(built.start);  // sets lags and contact
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;
  system.hessian(built.start.x, Projection::none, gradient, matrix);
  const std::vector<int> groups = groups_of(scene);
  std::vector<int> object(static_cast<size_t>(matrix.block_rows()), -1);
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const Body& body = built.bodies[i];
    const int first = body.affine() ? body.first_control : body.first_vertex;
    const int count = body.affine() ? 4 : body.ordered.vertices();
    for (int v = first; v < first + count; ++v)
      if (system.block_of(v) >= 0) object[static_cast<size_t>(system.block_of(v))] = groups[i];
  }
  const std::vector<Translation> sums = translations(matrix, object, scene.objects.size());
  for (size_t i = 0; i < sums.size(); ++i) {
    if (std::find(object.begin(), object.end(), static_cast<int>(i)) == object.end()) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> modes(sums[i].stiffness);
    if (modes.eigenvalues()[0] > nothing * sums[i].scale) continue;
    Eigen::Vector3d way = modes.eigenvectors().col(0);
    Eigen::Index axis = 0;
    way.cwiseAbs().maxCoeff(&axis);
    way *= way[axis] < 0 ? -1 : 1;
    way = (way.array().abs() < 1e-6).select(0, way);
    const bool joined = std::count(groups.begin(), groups.end(), static_cast<int>(i)) > 1;
    throw SourceError(
        scene.objects[i].place,
        fmt::format("nothing holds object '{}'{} along [{:.3g}, {:.3g}, {:.3g}], so that without inertia it has no "
                    "equilibrium; fix some of its vertices, or let it start within dhat of what it is to rest against",
                    scene.objects[i].name, joined ? " and what is attached to it" : "", way[0], way[1], way[2]));
  }
}

}  // namespace ergon

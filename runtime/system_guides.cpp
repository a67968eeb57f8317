// Vertices that move in some directions only: gradient and matrix are projected after they are assembled.

#include <fmt/format.h>

#include <set>

#include "runtime/error.h"
#include "runtime/system_data.h"

namespace ergon {
namespace {

constexpr double rounding = 1e-12;  // of an entry of a projector

bool is_projector(const Eigen::Matrix3d& P) {
  return (P - P.transpose()).cwiseAbs().maxCoeff() < rounding && (P * P - P).cwiseAbs().maxCoeff() < rounding;
}

}  // namespace

void System::set_guides(std::vector<Guide> guides) {
  std::set<int> seen, moved_with;
  for (const CarriedVertex& carried : impl->numbers.carriers.carried()) moved_with.insert(carried.vertex);
  for (int body = 0; body < impl->numbers.carriers.bodies(); ++body)
    for (int k = 0; k < 4; ++k) moved_with.insert(impl->numbers.carriers.first_control(body) + k);
  for (const Guide& guide : guides) {
    if (guide.vertex < 0 || guide.vertex >= impl->vertices)
      throw InputError(fmt::format("vertex {} of a guide is not one of the {} vertices", guide.vertex, impl->vertices));
    if (!is_projector(guide.along))
      throw InputError(fmt::format("the guide of vertex {} is no orthogonal projector", guide.vertex));
    if (!seen.insert(guide.vertex).second) throw InputError(fmt::format("vertex {} has two guides", guide.vertex));
    if (moved_with.contains(guide.vertex))
      throw InputError(fmt::format("vertex {} moves with an affine body and cannot be guided", guide.vertex));
  }
  impl->guides = std::move(guides);
}

void System::guide(Eigen::Matrix3Xd& field) const {
  for (const Guide& guide : impl->guides)
    if (block_of(guide.vertex) >= 0) field.col(guide.vertex) = (guide.along * field.col(guide.vertex)).eval();
}

// Between directions that are free and those that are not nothing is left, so that one factorisation solves for the
// first and finds no motion along the others.
void System::Impl::guide_matrix(BlockMatrix& matrix) const {
  if (guides.empty()) return;
  std::vector<const Eigen::Matrix3d*> along(static_cast<size_t>(matrix.block_rows()), nullptr);
  for (const Guide& guide : guides) {
    const int block = numbers.block_of[static_cast<size_t>(guide.vertex)];
    if (block >= 0) along[static_cast<size_t>(block)] = &guide.along;
  }
  for (int j = 0; j < matrix.block_rows(); ++j) {
    const Eigen::Matrix3d* right = along[static_cast<size_t>(j)];
    const Eigen::OuterStride<> stride(matrix.column_stride(j));
    for (int k = pattern->block_start[static_cast<size_t>(j)]; k < pattern->block_start[static_cast<size_t>(j) + 1];
         ++k) {
      const int i = pattern->block_row[static_cast<size_t>(k)];
      const Eigen::Matrix3d* left = along[static_cast<size_t>(i)];
      if (left == nullptr && right == nullptr) continue;
      Eigen::Map<Eigen::Matrix3d, 0, Eigen::OuterStride<>> block(matrix.values().data() + matrix.start_of(k, j),
                                                                 stride);
      if (i == j) {
        const Eigen::Matrix3d whole = block.selfadjointView<Eigen::Lower>();
        const double scale = whole.diagonal().cwiseAbs().mean();
        block = *right * whole * *right + (scale > 0 ? scale : 1) * (Eigen::Matrix3d::Identity() - *right);
      } else {
        if (left != nullptr) block = (*left * block).eval();
        if (right != nullptr) block = (block * *right).eval();
      }
    }
  }
}

}  // namespace ergon

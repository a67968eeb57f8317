// Inertia of coupled mass, and damping in proportion to it: a quadratic form with one number for each pair of vertices,
// a part of the matrix that stays.

#include <fmt/format.h>

#include "runtime/error.h"
#include "runtime/system_data.h"

namespace ergon {
namespace {

// factor/2 * sum_ij m_ij d_i.d_j, d = x - from; its gradient is added unless it is null.
double quadratic_form(const CoupledMass::Matrix& matrix, const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& from,
                      double factor, Eigen::Matrix3Xd* gradient) {
  if (matrix.nonZeros() == 0) return 0;
  const Eigen::Matrix3Xd way = x - from;
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, x.cols());
  add_product(matrix, way, factor, force);
  if (gradient != nullptr) *gradient += force;
  return force.cwiseProduct(way).sum() / 2;
}

}  // namespace

void System::set_coupled_mass(CoupledMass mass) {
  if (!mass.empty() && (mass.mass.rows() != vertices() || mass.mass.cols() != vertices()))
    throw InputError(fmt::format("a mass matrix of {} rows for a system of {} vertices", mass.mass.rows(), vertices()));
  impl->coupled = CoupledInertia{};
  impl->coupled.of = std::move(mass);
  impl->pattern = nullptr;
}

const CoupledMass& System::coupled_mass() const { return impl->coupled.of; }

void System::lag_coupled_mass(const Eigen::Matrix3Xd& xhat, double dt, const Eigen::Matrix3Xd& xlag, double lag_dt) {
  CoupledInertia& coupled = impl->coupled;
  if (coupled.of.empty()) return;
  coupled.xhat = xhat;
  coupled.dt = dt;
  coupled.xlag = xlag;
  coupled.lag_dt = lag_dt;
}

double System::coupled_inertia(const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd* gradient) const {
  const CoupledInertia& coupled = impl->coupled;
  if (coupled.dt == 0) return 0;
  return quadratic_form(coupled.of.mass, x, coupled.xhat, 1 / (coupled.dt * coupled.dt), gradient) +
         quadratic_form(coupled.of.drag, x, coupled.xlag, 1 / coupled.lag_dt, gradient);
}

void System::add_coupled_drag(const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& gradient) const {
  const CoupledInertia& coupled = impl->coupled;
  if (coupled.lag_dt == 0 || coupled.of.drag.nonZeros() == 0) return;
  add_product(coupled.of.drag, x - coupled.xlag, 1 / coupled.lag_dt, gradient);
}

bool CoupledInertia::renumbered(unsigned long fixed_version) {
  if (of.empty() || numbered_fixed == fixed_version) return false;
  numbered_fixed = fixed_version;
  return true;
}

// What fixed vertices share with free ones is no entry of the matrix.
template <class F>
static void over_free_pairs(const CoupledMass::Matrix& matrix, const SystemNumbers& numbers, F f) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const int row = numbers.block_of[static_cast<size_t>(i)];
    if (row < 0) continue;
    for (CoupledMass::Matrix::InnerIterator entry(matrix, i); entry; ++entry) {
      const int column = numbers.block_of[static_cast<size_t>(entry.col())];
      if (column >= 0 && column <= row) f(row, column, entry.value());
    }
  }
}

void CoupledInertia::add_blocks(const SystemNumbers& numbers, PatternBuilder& builder) const {
  over_free_pairs(of.mass, numbers, [&](int row, int column, double) { builder.add(row, column); });
}

void CoupledInertia::find(const SystemNumbers& numbers, const BlockPattern& pattern) {
  blocks.clear();
  const auto take = [&](double CoupledInertia::Block::*part) {
    return [&, part](int row, int column, double value) {
      Block block{pattern.start_of(pattern.index_of(row, column), column), pattern.column_stride(column)};
      block.*part = value;
      blocks.push_back(block);
    };
  };
  over_free_pairs(of.mass, numbers, take(&Block::mass));
  over_free_pairs(of.drag, numbers, take(&Block::drag));
}

bool CoupledInertia::rescaled() {
  const bool changed = based_dt != dt || (based_lag_dt != lag_dt && of.drag.nonZeros() > 0);
  based_dt = dt;
  based_lag_dt = lag_dt;
  return changed;
}

void CoupledInertia::assemble(BlockMatrix& base) const {
  if (dt == 0) return;
  double* values = base.values().data();
  for (const Block& block : blocks) {
    const double value = block.mass / (dt * dt) + block.drag / lag_dt;
    for (int c = 0; c < 3; ++c) values[block.at + c * block.stride + c] += value;
  }
}

}  // namespace ergon

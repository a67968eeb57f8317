#include "runtime/contact/contacts.h"

#include <algorithm>

namespace ergon {

void Contacts::begin_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double dt) {
  for (const auto& part : parts_) part->begin_step(x, v, dt);
}

FrictionChange Contacts::lag_friction(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& xlag, double dt) {
  FrictionChange all;
  for (const auto& part : parts_) {
    const FrictionChange one = part->lag_friction(x, xlag, dt);
    all.change += one.change;
    all.sum += one.sum;
  }
  return all;
}

void Contacts::set_active(const Eigen::Matrix3Xd& x) {
  for (const auto& part : parts_) part->set_active(x);
}

double Contacts::largest_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) {
  double fraction = 1;
  for (const auto& part : parts_) fraction = std::min(fraction, part->largest_step(x, direction));
  return fraction;
}

double Contacts::gap_change(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) {
  double largest = 0;
  for (const auto& part : parts_) largest = std::max(largest, part->gap_change(x, direction));
  return largest;
}

bool Contacts::adapt(const Eigen::Matrix3Xd& x) {
  bool changed = false;
  for (const auto& part : parts_) changed = part->adapt(x) || changed;
  return changed;
}

void Contacts::begin_hessian(const Eigen::Matrix3Xd& x) {
  for (const auto& part : parts_) part->begin_hessian(x);
}

void Contacts::end_hessian() {
  for (const auto& part : parts_) part->end_hessian();
}

void Contacts::judge_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) {
  for (const auto& part : parts_) part->judge_step(x, direction);
}

bool Contacts::owns(int potential) const {
  return std::any_of(parts_.begin(), parts_.end(), [potential](const auto& part) { return part->owns(potential); });
}

bool Contacts::rubs(int potential) const {
  return std::any_of(parts_.begin(), parts_.end(), [potential](const auto& part) { return part->rubs(potential); });
}

bool Contacts::has_friction() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->has_friction(); });
}

ContactStatus Contacts::status(const Eigen::Matrix3Xd& x) {
  ContactStatus all;
  for (const auto& part : parts_) {
    const ContactStatus one = part->status(x);
    all.reached = all.reached || one.reached;
    all.active += one.active;
    all.rubbing += one.rubbing;
    all.smallest_gap = std::min(all.smallest_gap, one.smallest_gap);
    all.stiffness = std::max(all.stiffness, one.stiffness);
    all.energy_added += one.energy_added;
  }
  return all;
}

std::vector<std::string> Contacts::skipped() const {
  std::vector<std::string> lines;
  for (const auto& part : parts_) {
    const std::vector<std::string> more = part->skipped();
    lines.insert(lines.end(), more.begin(), more.end());
  }
  return lines;
}

}  // namespace ergon

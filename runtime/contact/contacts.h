#pragma once
// All contact of a scene as one: that of surfaces with each other, that with half-spaces.

#include <memory>
#include <vector>

#include "runtime/contact/contact.h"

namespace ergon {

class Contacts : public Contact {
 public:
  void add(std::unique_ptr<Contact> part) { parts_.push_back(std::move(part)); }

  void begin_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double dt) override;
  FrictionChange lag_friction(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& xlag, double dt) override;
  void set_active(const Eigen::Matrix3Xd& x) override;
  double largest_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) override;
  double gap_change(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) override;
  bool adapt(const Eigen::Matrix3Xd& x) override;
  void begin_hessian(const Eigen::Matrix3Xd& x) override;
  void end_hessian() override;
  void judge_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) override;
  bool owns(int potential) const override;
  bool rubs(int potential) const override;
  bool has_friction() const override;
  ContactStatus status(const Eigen::Matrix3Xd& x) override;
  std::vector<std::string> skipped() const override;

 private:
  std::vector<std::unique_ptr<Contact>> parts_;
};

}  // namespace ergon

#pragma once
// Vertices that move with affine bodies. A body is four control points c_k, vertices of the system like any others; a
// vertex that it carries is x = sum_k w_k c_k, with constant weights. It establishes both ways between the two: fields
// over control points become fields over all vertices, and gradients over vertices those over control points.

#include <Eigen/Core>
#include <array>
#include <vector>

namespace ergon {

struct CarriedVertex {
  int vertex = 0;  // of the system
  int body = 0;
  std::array<double, 4> weights{};  // of its control points; their sum is 1
};

class Carriers {
 public:
  // A body with control points first_control to first_control + 3; its number.
  int add_body(int first_control);
  void carry(int vertex, int body, const std::array<double, 4>& weights);

  bool empty() const { return carried_.empty(); }
  int bodies() const { return static_cast<int>(first_control_.size()); }
  int first_control(int body) const { return first_control_[static_cast<size_t>(body)]; }
  const std::vector<CarriedVertex>& carried() const { return carried_; }

  // Per vertex, kg, what resists its motion alone: where it is carried 1/sum(w_k^2/m_k), the others being held.
  Eigen::VectorXd resisting_mass(const Eigen::VectorXd& mass) const;
  // Gives carried vertices what their control points have: 3 x vertices of the system.
  void place(Eigen::Matrix3Xd& field) const;
  // Adds to the columns of control points what those of the vertices that they carry amount to.
  void collect(Eigen::Matrix3Xd& gradient) const;

 private:
  std::vector<int> first_control_;
  std::vector<CarriedVertex> carried_;
};

}  // namespace ergon

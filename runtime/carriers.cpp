#include "runtime/carriers.h"

namespace ergon {

int Carriers::add_body(int first_control) {
  first_control_.push_back(first_control);
  return bodies() - 1;
}

void Carriers::carry(int vertex, int body, const std::array<double, 4>& weights) {
  carried_.push_back({vertex, body, weights});
}

Eigen::VectorXd Carriers::resisting_mass(const Eigen::VectorXd& mass) const {
  Eigen::VectorXd out = mass;
  for (const CarriedVertex& v : carried_) {
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      const double weight = v.weights[static_cast<size_t>(k)];
      sum += weight * weight / mass[first_control(v.body) + k];
    }
    out[v.vertex] = 1 / sum;
  }
  return out;
}

void Carriers::place(Eigen::Matrix3Xd& field) const {
  for (const CarriedVertex& v : carried_) {
    const int first = first_control(v.body);
    field.col(v.vertex) = v.weights[0] * field.col(first) + v.weights[1] * field.col(first + 1) +
                          v.weights[2] * field.col(first + 2) + v.weights[3] * field.col(first + 3);
  }
}

void Carriers::collect(Eigen::Matrix3Xd& gradient) const {
  for (const CarriedVertex& v : carried_) {
    const int first = first_control(v.body);
    for (int k = 0; k < 4; ++k) gradient.col(first + k) += v.weights[static_cast<size_t>(k)] * gradient.col(v.vertex);
  }
}

}  // namespace ergon

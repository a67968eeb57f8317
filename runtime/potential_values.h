#pragma once
// One value per potential. It establishes that those of a usual number of potentials ask for no memory, so that an
// evaluation asks for none.

#include <array>
#include <cstddef>
#include <vector>

namespace ergon {

class PotentialValues {
 public:
  void push_back(double value) {
    if (size_ == kFew) many_.assign(few_.begin(), few_.end());
    if (size_ < kFew) {
      few_[size_] = value;
    } else {
      many_.push_back(value);
    }
    ++size_;
  }
  size_t size() const { return size_; }
  const double* begin() const { return size_ <= kFew ? few_.data() : many_.data(); }
  const double* end() const { return begin() + size_; }
  double operator[](size_t i) const { return begin()[i]; }

 private:
  static constexpr size_t kFew = 24;
  std::array<double, kFew> few_{};
  std::vector<double> many_;  // all of them, when there are more
  size_t size_ = 0;
};

}  // namespace ergon

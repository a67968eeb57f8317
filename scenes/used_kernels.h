#pragma once
// The kernels that a scene uses: each is asked for once, and all are loaded at once.

#include <algorithm>
#include <string>
#include <vector>

#include "scenes/builder.h"

namespace ergon {

class UsedKernels {
 public:
  void want(const Energy* energy, const std::string& case_name = "") {
    if (energy != nullptr && place_of(*energy, case_name) == wanted_.size()) wanted_.push_back({energy, case_name});
  }
  void load(const KernelSource& source) { loaded_ = source(wanted_); }
  const Kernel& get(const Energy& energy, const std::string& case_name = "") const {
    return loaded_.at(place_of(energy, case_name));
  }

 private:
  size_t place_of(const Energy& energy, const std::string& case_name) const {
    const auto found = std::find_if(wanted_.begin(), wanted_.end(), [&](const KernelRequest& request) {
      return request.energy == &energy && request.case_name == case_name;
    });
    return static_cast<size_t>(found - wanted_.begin());
  }
  std::vector<KernelRequest> wanted_;
  std::vector<Kernel> loaded_;
};

}  // namespace ergon

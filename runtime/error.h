#pragma once
// Bad input that the runtime finds: a mesh, a state, a parameter. Programs turn it into exit code 2.

#include <stdexcept>

namespace ergon {

class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace ergon

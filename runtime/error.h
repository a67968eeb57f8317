#pragma once
// Bad input that the runtime finds: a mesh, a state, a parameter, a place for output. Programs turn it into exit
// code 2.

#include <stdexcept>

namespace ergon {

class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Output that cannot be written: a full disk, a folder without permission. The message names the path and the system's
// reason.
class OutputError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace ergon

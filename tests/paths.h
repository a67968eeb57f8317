#pragma once
// Where the project and its build are. Only tests/paths.cpp is compiled with these names: a compiler cache then serves
// every checkout.

#include <string>

namespace ergon::test {

// "/scenes" gives the absolute path of that folder of the source tree, "" the tree itself.
std::string source(const std::string& path = "");
// The same of the build folder.
std::string built(const std::string& path = "");

}  // namespace ergon::test

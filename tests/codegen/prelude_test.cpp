// Functions that emitted code brings along, against 50 digits.

#include "codegen/prelude.h"

#include <dlfcn.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "codegen/build.h"
#include "codegen/graph.h"
#include "symbolic/reference.h"
#include "tests/codegen/evaluate_kernel.h"
#include "tests/runtime/temporary_folder.h"

namespace ergon::testing {
namespace {

// f(x) - x of the function's name without "mx", correctly rounded.
double exact(const std::string& function, double x) {
  const Energy energy =
      parse_energy("energy f point\nframe fixed\ndof x m\nparam u 1/m\nparam j J\nlet y = u*x[0]\nvalue j*(" +
                       function.substr(0, function.size() - 2) + "(y) - y)\n",
                   "f.energy");
  return evaluate_reference(energy, "", {{"x", {x, 0, 0}}, {"u", {1}}, {"j", {1}}}, 80).value;
}

std::vector<double> arguments(const std::string& function) {
  std::vector<double> out;
  for (int i = 0; i < 60; ++i) {
    const double size = std::pow(10, -15 + 0.26 * i);  // to 2.4
    out.push_back(size);
    if (size < 0.999 || function != "log1pmx") out.push_back(-size);
  }
  for (const double x : {-0.9999, -0.334, -0.333, 0.499, 0.501, -0.501, 7.0, 20.0}) out.push_back(x);
  return out;
}

class Remainder : public ::testing::TestWithParam<const char*> {};

TEST_P(Remainder, OfTheInterpreterIsExactToAFewRoundings) {
  const std::string function = GetParam();
  const Call call = function == "log1pmx"   ? Call::log1pmx
                    : function == "expm1mx" ? Call::expm1mx
                    : function == "sinmx"   ? Call::sinmx
                                            : Call::atanmx;
  for (const double x : arguments(function)) {
    const double want = exact(function, x);
    EXPECT_LE(std::abs(evaluate(call, {x}) - want), 8 * 0x1p-53 * std::abs(want)) << x;
  }
}

// Errors of libmvec, up to 4 ulp, grow with the bits that the subtraction cancels: three at most.
TEST_P(Remainder, OverLanesIsExactToAFewRoundings) {
  const std::string function = GetParam();
  for (const int lanes : test_widths()) {
    const TemporaryFolder folder;
    const std::filesystem::path source = folder.path("f.cpp"), library = folder.path("f.so");
    std::ofstream(source) << prelude(lanes, {"v_" + function})
                          << "extern \"C\" __attribute__((visibility(\"default\"))) void f(const double* x, double* y) "
                             "{ *(V*)y = v_"
                          << function << "(*(const V*)x); }\n";
    build_library(default_compiler(), lanes, source, library);
    void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(handle, nullptr) << dlerror();
    const auto f = reinterpret_cast<void (*)(const double*, double*)>(dlsym(handle, "f"));
    ASSERT_NE(f, nullptr);
    const std::vector<double> all = arguments(function);
    for (size_t first = 0; first < all.size(); first += 3) {  // small and large arguments share a vector
      alignas(64) double x[8], y[8];
      for (size_t l = 0; l < 8; ++l) x[l] = all[(first + 17 * l) % all.size()];
      f(x, y);
      for (int l = 0; l < lanes; ++l) {
        const double want = exact(function, x[l]);
        EXPECT_LE(std::abs(y[l] - want), 32 * 0x1p-53 * std::abs(want)) << x[l] << " in " << lanes << " lanes";
      }
    }
    dlclose(handle);
  }
}

INSTANTIATE_TEST_SUITE_P(Functions, Remainder, ::testing::Values("log1pmx", "expm1mx", "sinmx", "atanmx"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace ergon::testing

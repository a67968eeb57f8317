// A bar in tension and compression against closed forms in its stretches: the transverse stretch solves one scalar
// equation, and nominal stress follows.

#include <fmt/format.h>

#include <cmath>

#include "runtime/mesh/mesh_build.h"
#include "tools/verify/model.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

struct TensionTest {
  const char* law;
  double nu, stretch, across, stress;  // stress over Young's modulus
};

// neo_hookean: mu/2 (I1 - 3) - mu log J + la/2 log^2 J; stable_neo_hookean: mu/2 (I1 - 3) - mu (J - 1) + (la + mu)/2 (J
// - 1)^2. With t across: mu (t - 1/t) + la log(J)/t = 0, and mu t - mu l t + (la + mu)(J - 1) l t = 0.
constexpr TensionTest tests[] = {
    {"neo_hookean", 0.3, 0.7, 1.107935, -0.405230},        {"neo_hookean", 0.3, 1.2, 0.945633, 0.174929},
    {"neo_hookean", 0.3, 1.5, 0.880175, 0.378280},         {"neo_hookean", 0.3, 2, 0.798078, 0.646745},
    {"neo_hookean", 0.45, 0.7, 1.170853, -0.433939},       {"neo_hookean", 0.45, 1.5, 0.830679, 0.358614},
    {"neo_hookean", 0.45, 2, 0.725935, 0.598796},          {"neo_hookean", 0.49, 1.5, 0.819241, 0.353209},
    {"neo_hookean", 0.49, 2, 0.710687, 0.586397},          {"stable_neo_hookean", 0.3, 1.5, 0.869227, 0.383191},
    {"stable_neo_hookean", 0.3, 2, 0.774597, 0.653846},    {"stable_neo_hookean", 0.3, 0.7, 1.087968, -0.381139},
    {"stable_neo_hookean", 0.45, 1.5, 0.829993, 0.358876}, {"stable_neo_hookean", 0.45, 2, 0.724569, 0.599138},
};

void run(const VerifyRows& rows) {
  for (const TensionTest& test : tests) {
    Model model(box_mesh(Element::hex8, {1, 1, 1}, {1, 1, 1}));
    const Mesh& mesh = model.mesh();
    model.add(test.law, {{"E", {1.0}}, {"nu", {test.nu}}});
    for (int axis = 0; axis < 3; ++axis)
      model.hold(vertices_where(mesh, [&](const Eigen::Vector3d& X) { return X[axis] == 0; }),
                 std::string(1, "xyz"[axis]));
    const std::vector<int> end = vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] == 1; });
    model.hold(end, "x");
    constexpr int steps = 10;
    for (int step = 1; step <= steps; ++step) {
      for (const int v : end) model.x(0, v) = 1 + (test.stretch - 1) * step / steps;
      model.solve(1e-12);
    }
    const std::string what = fmt::format("nu {:g}, stretch {:g}: ", test.nu, test.stretch);
    double force = 0;
    const Eigen::Matrix3Xd forces = model.reactions();
    for (const int v : end) force += forces(0, v);
    rows.add({.quantity = what + "stress/E",
              .element = test.law,
              .mesh = "1 Hex8",
              .value = force,
              .reference = test.stress,
              .bound = 1e-5});
    rows.add({.quantity = what + "stretch across",
              .element = test.law,
              .mesh = "1 Hex8",
              .value = model.x(1, vertex_near(mesh, {1, 1, 1})),
              .reference = test.across,
              .bound = 1e-5});
  }
}

}  // namespace

VerifyCase rubber_in_tension_case() {
  return {"rubber_in_tension", "a bar of neo-Hookean rubber, pulled and pressed",
          "closed form in principal stretches: Ogden 1984, Non-linear elastic deformations, for these laws", run};
}

}  // namespace ergon

#include "scenes/builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <numbers>

#include "runtime/mesh/mesh_tools.h"
#include "tests/paths.h"
#include "tests/scenes/real_kernels.h"

namespace ergon {
namespace {

const std::string time_part = "[time]\nintegrator = \"implicit_euler\"\ndt = 0.01\nsteps = 2\n";
const std::string block = R"(
[[object]]
name = "block"
box = { size = [0.1, 0.2, 0.3], cells = [2, 2, 2] }
translate = [0, 0, 0.1]
density = 1000
velocity = [1, 0, 0]
energy = [{ law = "stable_neo_hookean", E = "0.5 MPa", nu = 0.4 }]
)";
const std::string tets = block + "element = \"tet4\"\n";

// The laws whose kernels a scene asks for.
std::vector<std::string> kernels_of(const std::string& text) {
  std::vector<std::string> asked;
  build_scene(read_scene_text(text, "a.toml"), shipped_energies(), [&](const std::vector<KernelRequest>& requests) {
    for (const auto& [energy, case_name] : requests) asked.push_back(energy->name);
    return real_kernels(requests);
  });
  return asked;
}

TEST(builder, asks_only_for_the_kernels_that_are_used_and_says_what_is_left_out) {
  using testing::ElementsAre;
  EXPECT_THAT(kernels_of(time_part + block), ElementsAre("stable_neo_hookean", "inertia", "gravity"));
  EXPECT_THAT(kernels_of("gravity = [0, 0, 0]\n" + time_part + block), ElementsAre("stable_neo_hookean", "inertia"));
  EXPECT_THAT(kernels_of(time_part + block + "[[ground]]\n"),
              ElementsAre("stable_neo_hookean", "inertia", "gravity", "log_barrier:half_space"));
  EXPECT_THAT(
      kernels_of(time_part + block + "[[ground]]\n[[ground]]\nmu = 0.1\nheight = -1\n"),
      ElementsAre("stable_neo_hookean", "inertia", "gravity", "log_barrier:half_space", "friction", "friction_secant"));

  EXPECT_THAT(kernels_of(time_part + block + "[contact]\n"),
              ElementsAre("stable_neo_hookean", "inertia", "gravity", "log_barrier:point_point",
                          "log_barrier:point_edge", "log_barrier:point_triangle", "log_barrier:edge_edge",
                          "log_barrier:edge_edge", "log_barrier:edge_edge"));

  EXPECT_THAT(build_text("gravity = [0, 0, 0]\n" + time_part + block).skipped,
              ElementsAre("gravity: it is zero in this scene, no kernel loaded",
                          "ground contact: there is no ground, no kernel loaded",
                          "surface contact: the scene has no [contact], no kernels loaded",
                          "friction: nothing has a coefficient of friction 'mu', no kernel loaded"));
  EXPECT_THAT(build_text(time_part + block + "[[ground]]\n").skipped,
              ElementsAre("surface contact: the scene has no [contact], no kernels loaded",
                          "friction: nothing has a coefficient of friction 'mu', no kernel loaded"));
}

// Drag takes what it says from a body that flies free of other forces; a dashpot between its points takes nothing.
TEST(builder, takes_bdf2_that_makes_no_energy_unless_told_which_integrator) {
  const auto step = [](const std::string& more) {
    return build_text("[time]\ndt = 0.01\nsteps = 2\n" + more + block).step;
  };
  for (const char* more : {"", "integrator = \"automatic\"\n", "[contact]\n"}) {
    EXPECT_EQ(step(more).integrator, "bdf2");
    EXPECT_TRUE(step(more).creates_no_energy);
  }
  for (const std::string name : {"newmark", "bdf2", "implicit_euler"}) {
    EXPECT_EQ(step("integrator = \"" + name + "\"\n").integrator, name);
    EXPECT_FALSE(step("integrator = \"" + name + "\"\n").creates_no_energy);
  }
}

TEST(builder, damping_takes_its_lags_from_the_step) {
  const std::string law = "energy = [{ law = \"stable_neo_hookean\", E = \"0.5 MPa\", nu = 0.4 }";
  std::string damped = block;
  damped.replace(damped.find(law), law.size(), law + ", { law = \"drag\", rate = 10 }, { law = \"damper\", c = 1 }");
  BuiltScene built = build_text("gravity = [0, 0, 0]\n" + time_part + damped);
  TimeStepper stepper(*built.system, built.mass, nullptr, built.step);
  State state = built.start;
  for (int i = 1; i <= 2; ++i) {
    EXPECT_TRUE(stepper.step(state).converged);
    EXPECT_NEAR((state.v.row(0).array() - std::pow(1 + 10 * 0.01, -i)).abs().maxCoeff(), 0, 1e-6);
  }
}

TEST(builder, lays_out_masses_velocities_and_fixed_vertices) {
  BuiltScene built =
      build_text(time_part + tets + "fixed = [{ max = [inf, inf, 0.1001] }]\n" +
                 "[[object]]\nname = \"other\"\nbox = { size = [1, 1, 1], cells = [1, 1, 1] }\nelement = \"tet4\"\n"
                 "density = 7\nenergy = [{ law = \"stable_neo_hookean\", E = 1, nu = 0 }]\n");
  ASSERT_EQ(built.bodies.size(), 2u);
  EXPECT_EQ(built.bodies[1].first_vertex, 27);
  EXPECT_EQ(built.system->vertices(), 35);
  EXPECT_EQ(built.system->free_vertices(), 35 - 9);
  EXPECT_NEAR(built.mass.head(27).sum(), 6, 1e-12);
  EXPECT_NEAR(built.mass.tail(8).sum(), 7, 1e-12);
  for (int v = 0; v < 27; ++v) {
    const bool fixed = built.start.x(2, v) < 0.1001;
    EXPECT_EQ(built.system->block_of(v) < 0, fixed);
    EXPECT_EQ(built.start.v(0, v), fixed ? 0 : 1);
  }
  EXPECT_EQ(built.start.v.rightCols(8).norm(), 0);
  EXPECT_EQ(built.bodies[0].mesh.X.rows(), 3);
}

TEST(builder, moves_an_object_by_scale_then_rotation_then_translation) {
  BuiltScene built = build_text(time_part + R"(
[[object]]
name = "block"
box = { size = [0.1, 0.2, 0.3], cells = [1, 1, 1] }
element = "tet4"
scale = 2
rotate = ["90 deg", "90 deg", 0]
translate = [1, 2, 3]
density = 1000
energy = [{ law = "stable_neo_hookean", E = "0.5 MPa", nu = 0.4 }]
)");
  // (x, y, z) becomes (x, -z, y) about x, and that (y, -z, -x) about y.
  const auto bounds = bounding_box(built.bodies[0].mesh);
  EXPECT_LT((bounds.col(0) - Eigen::Vector3d(1, 2 - 0.6, 3 - 0.2)).norm(), 1e-14);
  EXPECT_LT((bounds.col(1) - Eigen::Vector3d(1 + 0.4, 2, 3)).norm(), 1e-14);
}

TEST(builder, keeps_the_order_of_the_mesh_beside_the_order_of_computing) {
  const BuiltScene built = build_text(time_part + tets);
  const Body& body = built.bodies[0];
  ASSERT_EQ(body.vertex_from.size(), 27u);
  for (size_t i = 0; i < 27; ++i)
    EXPECT_EQ(body.ordered.X.col(static_cast<int>(i)), body.mesh.X.col(body.vertex_from[i]));
  EXPECT_EQ(body.surface.size(), 26u);  // all but the one in the middle
}

TEST(builder, carries_elements_and_edge_and_point_energies) {
  for (const char* element : {"tet10", "hex8", "hex20", "hex27", "prism6"}) {
    BuiltScene built = build_text(time_part + block + "element = \"" + element + "\"\n");
    EXPECT_EQ(built.bodies[0].ordered.element, element_named(element));
    EXPECT_EQ(built.system->potential(0).stencil_count(), built.bodies[0].ordered.cell_count());
  }
  BuiltScene springs = build_text(time_part + R"(
[[object]]
name = "net"
box = { size = [1, 1, 1], cells = [1, 1, 1] }
element = "hex8"
density = 1
energy = [{ law = "spring", k = "1 N/cm" }, { law = "gravity", g = [0, "-1.6 m/s^2", 0] }]
)");
  EXPECT_EQ(springs.system->potential(0).stencil_count(), 12);
  EXPECT_EQ(springs.system->potential(1).stencil_count(), 8);
  State stretched = springs.start;
  stretched.x *= 1.01;
  TimeStepper stepper(*springs.system, springs.mass, nullptr, springs.step);
  const Energies energies = stepper.energies(stretched);
  ASSERT_EQ(energies.stored[0].first, "spring");
  EXPECT_NEAR(energies.stored[0].second, 12 * 0.5 * 100 * 1e-4, 1e-12);
}

// What is emitted for a density knows nothing of elements: Hex27 takes no more source than Tet4.
TEST(builder, one_kernel_serves_all_elements) {
  using testing::ElementsAre;
  std::string text = time_part + tets;
  for (const char* element : {"tet10", "hex20", "hex27", "prism6"}) {
    std::string other = block;
    other.replace(other.find("\"block\""), 7, "\"" + std::string(element) + "\"\nelement = \"" + element + "\"");
    text += other;
  }
  EXPECT_THAT(kernels_of(text), ElementsAre("stable_neo_hookean", "inertia", "gravity"));
  const BuiltScene built = build_text(text);
  for (int i = 1; i < 5; ++i) EXPECT_EQ(&built.system->potential(i).kernel(), &built.system->potential(0).kernel());
}

TEST(builder, quadrature_is_chosen_by_its_exactness) {
  const auto points = [](const std::string& keys) {
    return build_text(time_part + block + keys).system->potential(0).quadrature_points();
  };
  EXPECT_EQ(points(""), 27);  // of Hex27, as a box has it unless its element is stated
  EXPECT_EQ(points("element = \"tet4\"\n"), 1);
  EXPECT_EQ(points("element = \"tet4\"\nquadrature = 2\n"), 4);
  EXPECT_EQ(points("element = \"hex8\"\n"), 8);
  EXPECT_EQ(points("element = \"hex8\"\nquadrature = 0\n"), 1);
  EXPECT_EQ(points("element = \"hex27\"\nquadrature = 7\n"), 64);
}

TEST(builder, membranes_and_lines_have_the_mass_of_their_thickness_and_cross_section) {
  const std::string law = test::source() + "/tests/errors/scenes/parts/membrane.energy";
  for (const std::string element : {"tri3", "tri6", "quad4", "quad9"}) {
    const BuiltScene sheet = build_text(time_part + R"(
[[object]]
name = "sheet"
box = { size = [2, 3, 1], cells = [2, 3, 1] }
element = ")" + element + R"("
thickness = "1 mm"
density = 1000
energy = [{ law = ")" + law + R"(", k = 1 }]
)");
    EXPECT_NEAR(sheet.mass.sum(), 6, 1e-12) << element;
    EXPECT_EQ(sheet.system->potential(0).stencil_count(), element.substr(0, 3) == "tri" ? 12 : 6);
    EXPECT_EQ(sheet.bodies[0].surface.size(), static_cast<size_t>(sheet.bodies[0].ordered.vertices()));
  }
  const BuiltScene rope = build_text(time_part + R"(
[[object]]
name = "rope"
box = { size = [2, 1, 1], cells = [4, 1, 1] }
element = "edge3"
cross_section = "1 cm^2"
density = 1000
energy = [{ law = "spring", k = "1 N/cm" }]
)");
  EXPECT_NEAR(rope.mass.sum(), 0.2, 1e-12);
  EXPECT_EQ(rope.bodies[0].surface.size(), 9u);
}

TEST(builder, leaves_the_number_of_threads_as_it_is) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(3);
  build_text(time_part + R"(
[[object]]
name = "filled"
mesh = "parts/tet.obj"
density = 1000
energy = [{ law = "stable_neo_hookean", E = "0.5 MPa", nu = 0.4 }]
)",
             test::source("/tests/errors/scenes/a.toml"));
  EXPECT_EQ(omp_get_max_threads(), 3);
  omp_set_num_threads(before);
}

TEST(builder, counts_steps) {
  auto steps = [](const std::string& time) { return build_text("[time]\n" + time + block).steps; };
  EXPECT_EQ(steps("dt = 0.1\nend = 0.3\n"), 3);
  EXPECT_EQ(steps("dt = 0.1\nend = 0.31\n"), 4);
  EXPECT_EQ(steps("dt = 0.1\nend = 0.01\n"), 1);
  EXPECT_EQ(steps("dt = 0.1\nsteps = 7\n"), 7);
}

}  // namespace
}  // namespace ergon

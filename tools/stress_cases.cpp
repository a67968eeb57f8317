#include "tools/stress_cases.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace ergon {
namespace {

using Eigen::Vector3d;

std::string text_of(const Vector3d& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

// An object and all that belongs to it, in SI.
struct Block {
  std::string name = "block";
  Vector3d size{0.1, 0.1, 0.1};
  std::string cells = "[2, 2, 2]";
  Vector3d at{0, 0, 0}, velocity{0, 0, 0};
  double density = 1000, E = 1e5, nu = 0.4;
  std::string more = {};

  std::string text(const std::string& element) const {
    return fmt::format(R"([[object]]
name = "{}"
box = {{ size = {}, cells = {} }}
element = "{}"
translate = {}
velocity = {}
density = {}
energy = [{{ law = "stable_neo_hookean", E = {}, nu = {} }}]
{}
)",
                       name, text_of(size), cells, element, text_of(at), text_of(velocity), density, E, nu, more);
  }
};

struct World {
  double gravity = 9.81, dt = 0.01;
  int steps = 100;
  std::string more = {};

  std::string text() const {
    return fmt::format("gravity = [0, 0, {}]\n[time]\ndt = {}\nsteps = {}\n[output]\nframes = false\n{}\n", -gravity,
                       dt, steps, more);
  }
};

const std::string floor_below = "[[ground]]\nheight = -0.0005\nmu = 0.3\n";
const std::string contact = "[contact]\nmu = 0.3\n";

// The points of the first object about its middle.
using Map = std::function<Vector3d(const Vector3d& from_middle)>;

std::function<void(BuiltScene&)> mapped(const Map& map) {
  return [map](BuiltScene& built) {
    const Body& body = built.bodies.front();
    auto x = built.start.x.middleCols(body.first_vertex, body.ordered.vertices());
    const Vector3d middle = (x.rowwise().minCoeff() + x.rowwise().maxCoeff()) / 2;
    for (int v = 0; v < x.cols(); ++v)
      if (built.system->moves(body.first_vertex + v)) x.col(v) = middle + map(x.col(v) - middle);
  };
}

Map scrambled() {
  auto random = std::make_shared<std::mt19937>(1);
  return [random](const Vector3d&) {
    std::uniform_real_distribution<double> uniform(-0.05, 0.05);
    const double x = uniform(*random), y = uniform(*random), z = uniform(*random);
    return Vector3d(x, y, z);
  };
}

Map twisted(double turns, double length) {
  return [=](const Vector3d& x) -> Vector3d {
    return Eigen::AngleAxisd(2 * M_PI * turns * x[2] / length, Vector3d::UnitZ()) * x;
  };
}

// A block that starts in another shape and is left to itself, without gravity.
StressCase left_alone(const std::string& name, const std::string& element, const Map& map, Block block = {}) {
  const World world{.gravity = 0, .steps = 60};
  return {name, world.text() + block.text(element), mapped(map), {}};
}

StressCase dropped(const std::string& name, const std::string& element, Block block, World world = {}) {
  world.more += floor_below;
  return {name, world.text() + block.text(element), {}, {}};
}

void add_shapes(const std::string& element, std::vector<StressCase>& out) {
  out.push_back(left_alone("scrambled", element, scrambled()));
  out.push_back(left_alone("collapsed to a plane", element, [](const Vector3d& x) { return Vector3d(x[0], x[1], 0); }));
  out.push_back(left_alone("collapsed to a line", element, [](const Vector3d& x) { return Vector3d(x[0], 0, 0); }));
  out.push_back(left_alone("collapsed to a point", element, [](const Vector3d&) { return Vector3d(0, 0, 0); }));
  out.push_back(left_alone("inverted", element, [](const Vector3d& x) { return Vector3d(x[0], x[1], -x[2]); }));
  out.push_back(
      left_alone("stretched 100x", element, [](const Vector3d& x) { return Vector3d(x[0], x[1], 100 * x[2]); }));
  out.push_back(
      left_alone("twisted 10 turns", element, twisted(10, 0.4), {.size = {0.1, 0.1, 0.4}, .cells = "[2, 2, 8]"}));
}

void add_elements(const std::string& element, std::vector<StressCase>& out) {
  out.push_back(dropped("slivers of 1e-4 height", element, {.size = {0.1, 0.1, 2.5e-6}, .cells = "[4, 4, 1]"}));
  const std::string held = "fixed = [{ max = [1e-9, 1, 1] }]";
  out.push_back(
      {"aspect ratio 1e4",
       World{}.text() + Block{.size = {1, 1e-4, 1e-4}, .cells = "[1, 1, 1]", .E = 1e9, .more = held}.text(element),
       {},
       {}});
  const std::string membrane = element == "tet4" ? "tri3" : element == "tet10" ? "tri6" : "quad9";
  out.push_back({"thickness 1e-5 m",
                 World{.steps = 50, .more = floor_below}.text() + R"([[object]]
name = "sheet"
box = { size = [0.2, 0.2, 1], cells = [6, 6, 1] }
element = ")" + membrane +
                     R"("
rotate = [0, "80 deg", 0]
translate = [0, 0, 0.21]
thickness = 1e-5
density = 1000
energy = [{ law = "neo_hookean_membrane", E = "1 MPa", nu = 0.3 }]
[contact]
)",
                 {},
                 {}});
}

void add_materials(const std::string& element, std::vector<StressCase>& out) {
  out.push_back(dropped("Poisson's ratio 0.4999", element, {.at = {0, 0, 0.02}, .nu = 0.4999}));
  const auto one = [&](const char* name, double z, double E, double density) {
    return Block{.name = name, .at = {0, 0, z}, .density = density, .E = E}.text(element);
  };
  const std::string stage = World{.dt = 0.005, .steps = 60, .more = floor_below + contact}.text();
  out.push_back({"moduli 1e2 to 1e12 Pa",
                 stage + one("hard", 0, 1e12, 10) + one("firm", 0.102, 1e7, 10) + one("soft", 0.204, 1e2, 10),
                 {},
                 {}});
  out.push_back({"mass ratio 1e6", stage + one("light", 0, 1e7, 0.1) + one("heavy", 0.102, 1e7, 1e5), {}, {}});
}

void add_steps(const std::string& element, std::vector<StressCase>& out) {
  const Block above{.at = {0, 0, 0.01}};
  out.push_back(dropped("dt 1e-5 s", element, above, {.dt = 1e-5, .steps = 200}));
  out.push_back(dropped("dt 1 s", element, above, {.dt = 1, .steps = 20}));
  out.push_back(dropped("coordinates of 1e5 m", element, {.at = {1e5, -1e5, 0.01}}));
  for (const double s : {1e-4, 1e4}) {
    const double t = std::sqrt(s / 0.1), speed = s / 0.1 / t;
    const std::string solver =
        fmt::format("[solver]\ntolerance = {}\n[[ground]]\nheight = {}\ndhat = {}\nmu = 0.3\nepsv = {}\n", 1e-4 * speed,
                    -0.005 * s, 0.01 * s, 1e-3 * speed);
    out.push_back({fmt::format("size {:g} m", s),
                   World{.dt = 0.01 * t, .more = solver}.text() +
                       Block{.size = {s, s, s}, .at = {0, 0, 0.1 * s}, .E = 1e6 * s}.text(element),
                   {},
                   {}});
  }
  StressCase rest = dropped("10,000 steps at rest", element, {.cells = "[1, 1, 1]"}, {.steps = 10000});
  rest.slow = true;
  rest.judge = [](const BuiltScene&, const State& end) -> std::string {
    const double drift = end.v.cwiseAbs().maxCoeff() * end.time;
    return end.step < 1000 || drift < 1e-6 ? "" : fmt::format("drifts by {:.3g} m in {:g} s", drift, end.time);
  };
  out.push_back(rest);
}

void add_contacts(const std::string& element, std::vector<StressCase>& out) {
  const auto pair = [&](const std::string& name, const World& world, const Block& one, Block other) {
    other.name = "other";
    out.push_back({name, world.text() + one.text(element) + other.text(element), {}, {}});
  };
  out.push_back(dropped("impact at 1000 m/s", element, {.at = {0, 0, 0.5}, .velocity = {30, 0, -1000}}, {.steps = 30}));
  pair("two at 1000 m/s", {.gravity = 0, .steps = 20, .more = contact}, {.velocity = {500, 0, 0}},
       {.at = {0.5, 0.013, 0.017}, .velocity = {-500, 0, 0}});
  // All edges and faces are parallel and within dhat of one another.
  pair("parallel faces and edges", {.steps = 50, .more = floor_below + contact}, {}, {.at = {0, 0, 0.1005}});
  pair("edge on edge", {.steps = 30, .more = contact}, {.more = "fixed = [{ max = [1, 1, 1e-9] }]"},
       {.at = {0.1, 0.1, 0.1005}});
  pair("zero gravity", {.gravity = 0, .more = contact}, {.velocity = {0.5, 0, 0}}, {.at = {0.12, 0.01, 0.02}});
  Block bar{.size = {0.4, 0.1, 0.1}, .cells = "[8, 2, 2]"};
  bar.more = R"(fixed = [{ max = [1e-9, 1, 1] }]
[[object.scripted]]
min = [0.3999, -1, -1]
key = [{ time = "1 s", translate = [8, 0, 0] }])";
  out.push_back({"pulled to 20 times its length", World{.steps = 100}.text() + bar.text(element), {}, {}});
}

}  // namespace

std::vector<StressCase> stress_cases(const std::string& element) {
  std::vector<StressCase> out;
  add_shapes(element, out);
  add_elements(element, out);
  add_materials(element, out);
  add_steps(element, out);
  add_contacts(element, out);
  return out;
}

UnitPair stress_units(const std::string& element) {
  const auto scene = [&](double length, double mass) {
    const double pressure = mass / length;  // with seconds
    const Block block{.size = Vector3d(0.1, 0.1, 0.1) * length,
                      .at = Vector3d(0, 0, 0.01) * length,
                      .velocity = Vector3d(0.2, 0, 0) * length,
                      .density = 1000 * mass / std::pow(length, 3),
                      .E = 1e5 * pressure};
    const std::string more =
        fmt::format("[solver]\ntolerance = {}\n[[ground]]\nheight = {}\ndhat = {}\nmu = 0.3\nepsv = {}\n",
                    1e-6 * length, -0.0005 * length, 1e-3 * length, 1e-3 * length);
    return World{.gravity = 9.81 * length, .more = more}.text() + block.text(element);
  };
  return {scene(1, 1), scene(1000, 1e-3)};  // m, kg and mm, t
}

}  // namespace ergon

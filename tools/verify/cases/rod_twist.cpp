// Rods that twist: even twist and its moment, how fast twist swings, helices, and the loads and twists at which a
// strip, a straight rod and a ring leave their plane or line.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/verify/scene_case.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

constexpr double beyond = 1.25;  // times the reference: what a scene reaches at its end, unless it stops before

std::string quasi_static(double dt) {
  return fmt::format(
      "gravity = [0, 0, 0]\n[time]\nintegrator = \"quasi_static\"\ndt = {}\nend = 1\n[solver]\ntolerance = 1e-8\n", dt);
}

std::string object(const std::string& shape, const std::string& law) {
  return fmt::format(
      "[[object]]\nname = \"rod\"\n{}\ndensity = 1000\ncross_section = 1e-4\nenergy = [{{ law = \"rod_stretching\", "
      "EA = 1e6 }}, {{ {} }}]\n",
      shape, law);
}

// In time from 0 to 1 s: from 0 to a value.
std::string growing(double value, const char* unit) {
  return fmt::format("{{ formula = \"a*t/T\", a = \"{} {}\", T = \"1 s\" }}", value, unit);
}

// Edges along x, of which the middle of the first is at x = 0, and the middle or the end of the last at x = 1.
struct StraightRod {
  int cells;
  bool ends_amid_edge;

  double edge() const { return 1.0 / (cells - (ends_amid_edge ? 1.0 : 0.5)); }
  std::string shape() const {
    return fmt::format("element = \"edge2\"\nbox = {{ size = [{}, 1, 1], cells = [{}, 1, 1] }}\ntranslate = [{}, 0, 0]",
                       edge() * cells, cells, -edge() / 2);
  }
  std::string first_held() const { return fmt::format("[[object.fixed]]\nmax = [{}, 1, 1]\n", edge() / 2 + 1e-6); }
  std::string last_turned(double angle) const {
    return fmt::format(
        "[[object.scripted]]\nmin = [{}, -1, -1]\n[[object.scripted.key]]\ntime = 1\nrotate = [{}, 0, 0]\n",
        1 - edge() / 2 - 1e-6, angle);
  }
};

double middle(const Body& body, int cell) {
  const auto at = 2 * static_cast<size_t>(cell);
  return (body.ordered.X(0, body.ordered.cells[at]) + body.ordered.X(0, body.ordered.cells[at + 1])) / 2;
}

void even_twist(const VerifyRows& rows) {
  constexpr double angle = 20, GJ = 0.5;
  const StraightRod rod{21, true};
  const SceneCase run = run_scene_case(
      "rod", quasi_static(0.25) +
                 object(rod.shape(), fmt::format("law = \"discrete_rod\", EI1 = 5, EI2 = 9, GJ = {}", GJ)) +
                 rod.first_held() + rod.last_turned(angle));
  Eigen::Matrix3Xd gradient;
  run.built.system->gradient(run.end.x, gradient);
  const Body& body = run.built.bodies[0];
  double moment = 0, unevenness = 0;
  for (int cell = 0; cell < body.ordered.cell_count(); ++cell) {
    const double s = middle(body, cell), theta = run.end.x(0, body.first_twist + cell) / body.gyration;
    unevenness = std::max(unevenness, std::fabs(theta - angle * s));
    if (s > 1 - 1e-6) moment = gradient(0, body.first_twist + cell) * body.gyration;
  }
  const std::string mesh = std::to_string(rod.cells);
  rows.add({"moment L/(GJ angle)", "discrete_rod", mesh, moment / (GJ * angle), 1, 1e-6});
  rows.add({"largest distance from even twist, rad", "discrete_rod", mesh, unevenness, 0, 1e-6});
}

// Held at one end, started in its first mode: its phase after half of the period that the closed form says.
void frequency(int cells, const VerifyRows& rows) {
  constexpr double GJ = 0.5, gyration = 0.01;
  const double reference = M_PI / 2 * std::sqrt(GJ / (1000 * 1e-4 * gyration * gyration));  // rad/s
  const StraightRod rod{cells, false};
  SceneCaseOptions options;
  options.start = [](BuiltScene& built) {
    const Body& body = built.bodies[0];
    for (int cell = 0; cell < body.ordered.cell_count(); ++cell)
      built.start.v(0, body.first_twist + cell) = 1e-3 * std::sin(M_PI / 2 * middle(body, cell));
  };
  const SceneCase run = run_scene_case(
      "rod",
      fmt::format("gravity = [0, 0, 0]\n[time]\nintegrator = \"midpoint\"\ndt = {}\nsteps = 200\n[solver]\ntolerance = "
                  "1e-9\n",
                  M_PI / reference / 200) +
          object(rod.shape(), fmt::format("law = \"round_rod\", EI = 1, GJ = {}", GJ)) + "gyration = 0.01\n" +
          rod.first_held(),
      options);
  const Body& body = run.built.bodies[0];
  int last = 0;
  for (int cell = 0; cell < cells; ++cell) last = middle(body, cell) > middle(body, last) ? cell : last;
  const double u = run.end.x(0, body.first_twist + last), v = run.end.v(0, body.first_twist + last);
  const double phase = std::atan2(-reference * u, -v) + M_PI;
  rows.add({"first frequency of twist 2 omega L/(pi c)", "round_rod", std::to_string(cells), phase / M_PI, 1});
}

// A straight rod gets curvature and twist of its own, without load.
void helix(int cells, const VerifyRows& rows) {
  constexpr double kappa = 8, tau = 5;
  const SceneCase run = run_scene_case(
      "rod", quasi_static(0.05) +
                 object(fmt::format("element = \"edge2\"\nbox = {{ size = [1, 1, 1], cells = [{}, 1, 1] }}", cells),
                        fmt::format("law = \"curled_rod\", EI1 = 1, EI2 = 3, GJ = 0.7, k1 = {}, k2 = 0, tau = {}",
                                    growing(kappa, "m^-1"), growing(tau, "m^-1"))) +
                 fmt::format("[[object.fixed]]\nmax = [{}, 1, 1]\n", 1.0 / cells + 1e-6));
  const auto chord = [](double s) {
    const double w = std::sqrt(kappa * kappa + tau * tau), radius = kappa / (w * w);
    return std::hypot(2 * radius * std::sin(w * s / 2), tau / w * s);
  };
  const Body& body = run.built.bodies[0];
  for (const double s : {0.5, 1.0}) {
    Eigen::Index from = 0, to = 0;
    body.ordered.X.row(0).minCoeff(&from);
    (body.ordered.X.row(0).array() - s).abs().minCoeff(&to);
    rows.add({fmt::format("helix, distance along {:g} m of it, m", s), "curled_rod", std::to_string(cells),
              (run.end.x.col(to) - run.end.x.col(from)).norm(), chord(s)});
  }
  rows.add({"helix, energy without load, J", "curled_rod", std::to_string(cells), run.summary.end_energy, 0, 1e-9});
}

// Where a branch begins, in parts of the reference.
double branching(const std::string& text) {
  const SceneCase run = run_scene_case("rod", text, {true, {}});
  return run.summary.failure.empty() ? std::nan("") : beyond * run.summary.time;
}

void lateral(int cells, const VerifyRows& rows) {
  constexpr double reference = 4.01260, GJ = 0.7;
  const StraightRod rod{cells, false};
  const double part = branching(
      quasi_static(0.1) + object(rod.shape(), fmt::format("law = \"discrete_rod\", EI1 = 1, EI2 = 1e4, GJ = {}", GJ)) +
      rod.first_held() +
      fmt::format("[[object.load]]\nmin = [{}, -1, -1]\nforce = [0, 0, {}]\n", 1 - 1e-6,
                  -beyond * reference * std::sqrt(GJ)));
  rows.add({"lateral buckling P L^2/sqrt(EI GJ)", "discrete_rod", std::to_string(cells), part * reference, reference});
}

void twisted_straight(int cells, const VerifyRows& rows) {
  constexpr double reference = 8.98682, GJ = 0.7;
  const StraightRod rod{cells, true};
  const double part =
      branching(quasi_static(0.1) + object(rod.shape(), fmt::format("law = \"round_rod\", EI = 1, GJ = {}", GJ)) +
                rod.first_held() + rod.last_turned(beyond * reference / GJ));
  rows.add({"buckling by twist M L/EI", "round_rod", std::to_string(cells), part * reference, reference});
}

void twisted_ring(int cells, const VerifyRows& rows) {
  constexpr double reference = 10.88280, GJ = 0.7;  // 2 pi sqrt(3)
  std::string points;
  for (int i = 0; i < cells; ++i)
    points += fmt::format("[{}, {}, 0], ", std::cos(2 * M_PI * i / cells), std::sin(2 * M_PI * i / cells));
  const double part =
      branching(quasi_static(0.1) +
                object(fmt::format("curve = {{ points = [{}], closed = true }}", points),
                       fmt::format("law = \"curled_rod\", EI1 = 1, EI2 = 1, GJ = {}, k1 = 0, k2 = 0, tau = {}", GJ,
                                   growing(beyond * reference / (2 * M_PI) / GJ, "m^-1"))) +
                fmt::format("[[object.fixed]]\nmin = [{}, -1e-6, -1]\nmax = [2, {}, 1]\n",
                            std::cos(2 * M_PI / cells) - 1e-6, std::sin(2 * M_PI / cells) + 1e-6));
  rows.add({"twist of a ring that leaves its plane, times GJ/EI", "curled_rod", std::to_string(cells), part * reference,
            reference});
}

void run(const VerifyRows& rows) {
  even_twist(rows);
  frequency(20, rows);
  helix(50, rows);
  lateral(40, rows);
  twisted_straight(50, rows);
  twisted_ring(100, rows);
}

}  // namespace

VerifyCase rod_twist_case() {
  return {
      "rod_twist", "discrete elastic rods: twist, helices, and where twist makes a rod leave its plane or line",
      "Timoshenko, Gere 1961, Theory of elastic stability (strip); tan(x) = x at half of M L/EI (straight rod between "
      "held ends); Goriely 2006, Twisted elastic rings and the rediscoveries of Michell's instability, J. Elasticity "
      "84 (ring, 2 pi sqrt(3) EI/GJ)",
      run};
}

}  // namespace ergon

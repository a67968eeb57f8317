// Laws of the catalogue written in C++: their kernels are those of the files but for the text of the law, which a
// kernel carries as a comment, and of a file that holds what the builder tells byte for byte.

#include <gtest/gtest.h>

#include "codegen/compile.h"
#include "symbolic/energy_builder.h"
#include "tests/paths.h"

namespace ergon {
namespace {

Energy von_mises() {
  EnergyBuilder law("density", "von_mises", "solid");
  const Expr F = law.F();
  const Expr E = law.param("E", "Pa", "(0, inf)", "Young's modulus");
  const Expr nu = law.param("nu", "1", "(-1, 1/2)", "Poisson's ratio");
  const Expr yield = law.param("yield", "Pa", "(0, inf)", "stress at which a bar yields");
  const Expr plastic = law.lag("plastic[3, 3]", "1", "", "plastic strain");
  const Expr mu = law.let("mu", E / (2 * (1 + nu)));
  const Expr K = law.let("K", E / (3 * (1 - 2 * nu)));
  const Expr elastic = law.let("elastic", (transpose(F) * F - identity(3)) / 2 - plastic);
  const Expr limit = law.let("limit", yield / (sqrt(Expr(6)) * mu));
  const Expr n2 = law.let("n2", norm2(dev(elastic)));
  const Expr n = law.let("n", sqrt(max(n2, pow(limit, 2))));
  law.value(mu * (n2 - pow(n - limit, 2)) + K / 2 * pow(tr(elastic), 2));
  law.update(plastic, plastic + (1 - limit / n) * dev(elastic));
  return law.build();
}

Energy plastic_hinge() {
  EnergyBuilder law("energy", "plastic_hinge", "hinge");
  const Expr x0 = law.dof("x0", "m"), x1 = law.dof("x1", "m"), x2 = law.dof("x2", "m"), x3 = law.dof("x3", "m");
  const Expr X0 = law.rest("X0[3]", "m"), X1 = law.rest("X1[3]", "m"), X2 = law.rest("X2[3]", "m"),
             X3 = law.rest("X3[3]", "m");
  const Expr k = law.param("k", "J", "(0, inf)", "bending stiffness");
  const Expr yield = law.param("yield", "1", "(0, inf)", "angle (rad) from the rest angle that stays elastic");
  const Expr crease = law.lag("crease", "1", "", "by which the rest angle has moved");
  const Expr E = law.let("E", X1 - X0);
  const Expr area2 = law.let("area2", norm(cross(E, X2 - X0)) / 2);
  const Expr area3 = law.let("area3", norm(cross(E, X3 - X0)) / 2);
  law.require(area2 > 0);
  law.require(area3 > 0);
  const Expr bend = law.let("bend", dihedral(x0, x1, x2, x3) - dihedral(X0, X1, X2, X3) - crease);
  const Expr size = law.let("size", sqrt(max(pow(bend, 2), pow(yield, 2))));
  law.value(3 * k * norm2(E) / (area2 + area3) * (pow(bend, 2) - pow(size - yield, 2)));
  law.update(crease, crease + (1 - yield / size) * bend);
  return law.build();
}

Energy inertia() {
  EnergyBuilder law("energy", "inertia", "point");
  law.fixed_frame();
  const Expr x = law.dof("x", "m");
  const Expr mass = law.rest("mass", "kg", "(0, inf)", "lumped mass");
  const Expr dt = law.lag("dt", "s", "(0, inf)", "time step");
  const Expr xhat = law.lag("xhat[3]", "m", "", "x + dt*v at the start of the step");
  law.value(mass / (2 * pow(dt, 2)) * norm2(x - xhat));
  return law.build();
}

Energy strain_limit() {
  EnergyBuilder law("density", "strain_limit", "membrane");
  law.part("of a membrane that resists small strains");
  const Expr k = law.param("k", "N/m", "(0, inf)", "stiffness");
  const Expr threshold = law.param("threshold", "1", "[1, 1.2]", "stretch from where it acts");
  const Expr limit = law.param("limit", "1", "(1.2, inf)", "stretch that is never reached");
  const Expr s = law.let("s", stretches(law.F()));
  const Expr a = law.let("a", max(s[0] - threshold, 0) / (limit - threshold));
  const Expr b = law.let("b", max(s[1] - threshold, 0) / (limit - threshold));
  law.require(s[0] < limit);
  law.require(s[1] < limit);
  law.value(-k * (pow(a, 2) * log1p(-a) + pow(b, 2) * log1p(-b)));
  return law.build();
}

Energy data_driven() {
  EnergyBuilder law("density", "data_driven", "solid");
  const Expr mu = law.param("mu", "Pa", "(0, inf)", "initial shear modulus");
  const Expr K = law.param("K", "Pa", "(0, inf)", "bulk modulus");
  const Expr J = law.let("J", det(law.F()));
  const Expr I = law.let("I", norm2(law.F()) * pow(J, Expr(-2) / 3) - 3);
  law.require(J > 0);
  law.value(mu * spline(I, vector({0, 1, 4, 10, 20, 30, 40, 50, 56}),
                        vector({0, 0.493, 1.8, 4.301, 8.658, 13.79, 19.95, 27.226, 32.96})) +
            K / 2 * pow(J - 1, 2));
  return law.build();
}

Energy pressure() {
  EnergyBuilder law("energy", "pressure", "triangle");
  law.part("of a closed surface whose triangles are seen counterclockwise from outside");
  const Expr x0 = law.dof("x0", "m"), x1 = law.dof("x1", "m"), x2 = law.dof("x2", "m");
  const Expr p = law.param("p", "Pa", "", "pressure inside less that outside");
  law.load(p);
  law.value(-p / 6 * dot(x0, cross(x1, x2)));
  return law.build();
}

TEST(BuiltEnergies, GiveTheKernelsOfTheirFiles) {
  const std::vector<std::pair<Energy, std::string>> pairs = {
      {von_mises(), "solids/von_mises"},     {plastic_hinge(), "bending/plastic_hinge"},
      {inertia(), "bodies/inertia"},         {strain_limit(), "membranes/strain_limit"},
      {data_driven(), "solids/data_driven"}, {pressure(), "loads/pressure"}};
  for (const auto& [built, file] : pairs) {
    SCOPED_TRACE(file);
    Energy read = read_energy(test::source("/energies/" + file + ".energy"));
    CompileOptions options;
    options.lanes = 4;
    read.text = built.text;
    const std::string source = generate(built, options).source;
    EXPECT_EQ(source, generate(read, options).source);
    EXPECT_EQ(built.load, read.load);
    EXPECT_EQ(built.part_of, read.part_of);
    EXPECT_EQ(built.fixed_frame, read.fixed_frame);
    EXPECT_EQ(source, generate(parse_energy(built.text, "text"), options).source);
  }
}

}  // namespace
}  // namespace ergon

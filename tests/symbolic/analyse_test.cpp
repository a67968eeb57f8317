#include "symbolic/analyse.h"

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

const Let& let_of(const Energy& energy, const std::string& name) {
  for (const Let& let : energy.lets)
    if (let.name == name) return let;
  throw std::out_of_range(name);
}

std::string unit_of(const std::string& expression) {
  const Energy e = parse_energy(
      "energy e edge\ndof x0 x1 m\nparam k N/m\nparam speed m/s\nparam A[3,3] m^2\n"
      "let q = " +
          expression + "\nlet all = k*(norm2(x1 - x0) + 0*speed^2*tr(A)*norm2(q*[1, 0]))\nvalue 0*all\n",
      "e.energy");
  const Expression& q = *let_of(e, "q").expression;
  return to_string(q.shape) + ", " + to_string(q.unit);
}

TEST(Analyse, UnitsFollowTheOperations) {
  EXPECT_EQ(unit_of("norm(x1 - x0)"), "scalar, m");
  EXPECT_EQ(unit_of("sqrt(norm(x1))"), "scalar, m^(1/2)");
  EXPECT_EQ(unit_of("norm(x1)^(3/2)/speed"), "scalar, m^(1/2)*s");
  EXPECT_EQ(unit_of("det(A)"), "scalar, m^6");
  EXPECT_EQ(unit_of("inverse(A)[0,0]"), "scalar, 1/m^2");
  EXPECT_EQ(unit_of("atan2(x0[1], x0[0])"), "scalar, 1");
  EXPECT_EQ(unit_of("k*norm2(x1)"), "scalar, J");
  EXPECT_EQ(unit_of("pow(speed, 2 - 1)"), "scalar, m/s");
  EXPECT_EQ(unit_of("dot(x0, x1)"), "scalar, m^2");
  EXPECT_EQ(unit_of("dihedral(x0, x1, cross([1, 0, 0], x0), x1)"), "scalar, 1");
}

TEST(Analyse, ZeroFitsEveryUnit) {
  EXPECT_EQ(unit_of("max(0, norm(x0))"), "scalar, m");
  EXPECT_EQ(unit_of("norm([0, x0[0], -0])"), "scalar, m");
  EXPECT_EQ(unit_of("0 + speed"), "scalar, m/s");
  EXPECT_EQ(unit_of("norm2(x0 - [0, 0, 0])"), "scalar, m^2");
  EXPECT_THROW(unit_of("1 + speed"), SourceError);
}

TEST(Analyse, ShapesFollowTheOperations) {
  const Energy e = parse_energy(
      "density e membrane\nparam k N/m\nlet C = F'*F\nlet a = column(F, 1)\nlet n = cross(column(F, 0), a)\n"
      "let o = outer(n, a)\nlet c = columns(n, a)\nlet i = identity(2)\nlet r = a'\nlet l = [1, 2, 3; 4, 5, 6]\n"
      "value k*(tr(C - i) + norm2(o) + norm2(c) + r*n + norm2(l))\n",
      "e.energy");
  const std::vector<std::pair<const char*, Shape>> expected = {{"C", {2, 2}}, {"a", {3, 1}}, {"n", {3, 1}},
                                                               {"o", {3, 3}}, {"c", {3, 2}}, {"i", {2, 2}},
                                                               {"r", {1, 3}}, {"l", {2, 3}}};
  for (const auto& [name, shape] : expected) EXPECT_EQ(let_of(e, name).expression->shape, shape) << name;
}

TEST(Analyse, ValueUnits) {
  auto unit = [](const char* text) { return to_string(value_unit(parse_energy(text, "e.energy"))); };
  EXPECT_EQ(unit("density e solid\nparam k J/m^3\nvalue k*det(F)\n"), "Pa");
  EXPECT_EQ(unit("density e membrane\nparam k J/m^2\nvalue k*norm2(F)\n"), "N/m");
  EXPECT_EQ(unit("density e line\nparam k J/m\nvalue k*norm2(F)\n"), "N");
  EXPECT_EQ(unit("energy e point\ndof x m\nparam k N\nvalue k*norm(x)\n"), "J");
}

TEST(Analyse, EveryNodeOfTheCatalogueHasItsUnit) {
  std::function<int(const Expression&, const Energy&)> count = [&](const Expression& e, const Energy& energy) {
    int nodes = 1;
    if (e.kind == Expression::Kind::name && energy.find(e.text)) {
      EXPECT_EQ(e.unit, energy.find(e.text)->unit);
      EXPECT_EQ(e.shape, energy.find(e.text)->shape);
    }
    for (const auto& argument : e.arguments) nodes += count(*argument, energy);
    return nodes;
  };
  for (const auto& file : test::energy_files("energies")) {
    const Energy energy = read_energy(file);
    if (energy.value) {
      EXPECT_EQ(energy.value->unit, value_unit(energy)) << file;
      EXPECT_TRUE(energy.value->shape.scalar()) << file;
      EXPECT_GT(count(*energy.value, energy), 3) << file;
    }
    EXPECT_EQ(energy.name, file.stem().string()) << "a file is named like its energy";
    EXPECT_FALSE(energy.cite.empty()) << file;
    EXPECT_FALSE(energy.summary.empty()) << file;
    for (const Symbol& symbol : energy.symbols) {
      const bool chosen_by_a_user = symbol.role == Role::param || symbol.role == Role::lag;
      EXPECT_TRUE(!chosen_by_a_user || !symbol.help.empty()) << file << ": " << symbol.name;
    }
  }
}

}  // namespace
}  // namespace ergon

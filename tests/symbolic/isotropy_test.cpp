#include "symbolic/isotropy.h"

#include <gtest/gtest.h>

#include <string>

#include "symbolic/energy.h"

namespace ergon {
namespace {

bool isotropic(const std::string& text) { return is_isotropic(parse_energy(text, "law.energy"), ""); }

std::string density(const std::string& geometry, const std::string& rest) {
  return "density law " + geometry + "\nparam k Pa (0, inf) stiffness\n" + rest;
}

TEST(Isotropy, FoundHoweverItIsWritten) {
  EXPECT_TRUE(isotropic(density("solid", "value k*tr(F'*F)\n")));
  EXPECT_TRUE(
      isotropic(density("solid", "value k*norm2(column(F, 0)) + k*norm2(column(F, 1)) + k*norm2(column(F, 2))\n")));
  EXPECT_TRUE(isotropic(density("solid", "let B = F*F'\nvalue k*norm2(B*B - B)\n")));
  EXPECT_TRUE(isotropic(density("solid",
                                "let C = F'*F\nvalue k*(C[0,0]*C[1,1] + C[1,1]*C[2,2] + C[2,2]*C[0,0]"
                                " - C[0,1]^2 - C[1,2]^2 - C[0,2]^2)\n")));
  EXPECT_TRUE(isotropic(density("solid", "value k*exp(norm2(dev(F'*F))) + k/det(F)^2\n")));
  EXPECT_TRUE(isotropic(density("solid", "value k*log(det(F))^2\n")));  // not defined at every state
}

TEST(Isotropy, NotSeenWhereItIsNot) {
  EXPECT_FALSE(isotropic(density("solid", "value k*norm2(column(F, 0))\n")));  // a fibre
  EXPECT_FALSE(isotropic(density("solid", "value k*tr(F'*F) + k*F[0,1]/10^9\n")));
  EXPECT_FALSE(isotropic(density("solid", "value k*norm2(sym(F))\n")));  // not frame indifferent
  EXPECT_FALSE(isotropic(density("solid", "param a[3] 1\nvalue k*norm2(F*a)\n")));
  EXPECT_FALSE(isotropic("energy law point\ndof x m\nparam k N/m (0, inf)\nvalue k*norm2(x)\n"));
}

TEST(Isotropy, MembranesAndLines) {
  const auto flat = [](const std::string& geometry, const std::string& unit, const std::string& value) {
    return isotropic("density law " + geometry + "\nparam k " + unit + " (0, inf) stiffness\nvalue " + value + "\n");
  };
  EXPECT_TRUE(flat("membrane", "N/m", "k*norm2(F'*F - identity(2))"));
  EXPECT_FALSE(flat("membrane", "N/m", "k*norm2(column(F, 1))"));
  EXPECT_TRUE(flat("line", "N", "k*(norm2(F) - 1)^2"));
  EXPECT_FALSE(flat("line", "N", "k*F[0]^2"));
}

}  // namespace
}  // namespace ergon

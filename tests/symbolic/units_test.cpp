#include "symbolic/units.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

#include "symbolic/diagnostic.h"

namespace ergon {
namespace {

std::string message(std::string_view unit) {
  try {
    parse_unit(unit);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Units, AreReadAndToldInTheCommonSpelling) {
  const std::vector<std::pair<const char*, const char*>> cases = {{"1", "1"},
                                                                  {"m", "m"},
                                                                  {"Pa", "Pa"},
                                                                  {"N/m^2", "Pa"},
                                                                  {"J/m^3", "Pa"},
                                                                  {"J/m^4", "J/m^4"},
                                                                  {"kg*m/s", "kg*m/s"},
                                                                  {"kg*m/s^2", "N"},
                                                                  {"N*m", "J"},
                                                                  {"J/s", "W"},
                                                                  {"N/m", "N/m"},
                                                                  {"J/m^2", "N/m"},
                                                                  {"W/(m*K)", "W/(m*K)"},
                                                                  {"J/(kg*K)", "m^2/(s^2*K)"},
                                                                  {"kg/m^3", "kg/m^3"},
                                                                  {"Pa*s", "Pa*s"},
                                                                  {"1/s", "1/s"},
                                                                  {"Hz", "1/s"},
                                                                  {"rad", "1"},
                                                                  {"m^(1/2)", "m^(1/2)"},
                                                                  {"m^-2", "1/m^2"},
                                                                  {"(m/s)^2", "m^2/s^2"},
                                                                  {"mol/L", "mol/m^3"},
                                                                  {"N*s/m", "kg/s"}};
  for (const auto& [text, expected] : cases) EXPECT_EQ(to_string(parse_unit(text).unit), expected) << text;
}

TEST(Units, ToldUnitsReadBackAsThemselves) {
  for (const char* text : {"Pa", "J/m^4", "W/(m*K)", "m^(1/2)", "kg*m/s", "J*m", "N/(m*A)", "1/(m*s)", "m^(3/2)/s"}) {
    const Unit unit = parse_unit(text).unit;
    EXPECT_EQ(parse_unit(to_string(unit)).unit, unit) << text << " told as " << to_string(unit);
  }
}

TEST(Units, Scales) {
  EXPECT_DOUBLE_EQ(parse_unit("mm").scale, 1e-3);
  EXPECT_DOUBLE_EQ(parse_unit("kPa").scale, 1e3);
  EXPECT_DOUBLE_EQ(parse_unit("kg").scale, 1);
  EXPECT_DOUBLE_EQ(parse_unit("g/cm^3").scale, 1000);
  EXPECT_DOUBLE_EQ(parse_unit("t").scale, 1000);
  EXPECT_DOUBLE_EQ(parse_unit("h").scale, 3600);
  EXPECT_DOUBLE_EQ(parse_unit("deg").scale, std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(parse_unit("mm^2").scale, 1e-6);
  EXPECT_DOUBLE_EQ(parse_unit("N/mm^2").scale, 1e6);
  EXPECT_DOUBLE_EQ(parse_unit("L").scale, 1e-3);
  EXPECT_EQ(parse_unit("Pa").scale, 1);
}

TEST(Units, ErrorsNameThePartAndTheNearestUnit) {
  EXPECT_EQ(message("pa"), "unknown unit 'pa'; did you mean 'Pa'?");
  EXPECT_EQ(message("N/mn"), "unknown unit 'mn' in 'N/mn'; did you mean 'mN'?");
  EXPECT_EQ(message("kg/m3"), "unknown unit 'm3' in 'kg/m3'; powers are written with '^', as in m^3");
  EXPECT_EQ(message("foo"), "unknown unit 'foo'");
  EXPECT_EQ(message(""), "expected a unit, found nothing; a pure number has the unit 1");
  EXPECT_EQ(message("m/"), "in the unit 'm/': expected the name of a unit, found its end");
  EXPECT_EQ(message("m^x"), "in the unit 'm^x': expected a whole power, found 'x'");
  EXPECT_EQ(message("(m"), "in the unit '(m': expected ')', found its end");
  EXPECT_EQ(message("m)"), "in the unit 'm)': expected '*', '/' or '^', found ')'");
  EXPECT_EQ(message("m^(1/0)"), "in the unit 'm^(1/0)': expected a denominator other than 0, found ')'");
}

TEST(Units, ArithmeticIsExact) {
  const Unit metre = parse_unit("m").unit;
  EXPECT_EQ(pow(pow(metre, {1, 3}), {3, 1}), metre);
  EXPECT_TRUE((metre / metre).dimensionless());
  EXPECT_EQ((Exponent{1, 2} + Exponent{1, 3}), (Exponent{5, 6}));
  EXPECT_EQ((Exponent{1, 2} - Exponent{1, 2}), (Exponent{0, 1}));
  EXPECT_THROW(pow(pow(metre, {999, 1}), {999, 1}), std::invalid_argument);
}

TEST(Units, QuantitiesAreDescribed) {
  EXPECT_EQ(describe(parse_unit("m").unit), "a length (m)");
  EXPECT_EQ(describe(parse_unit("1").unit), "a pure number (1)");
  EXPECT_EQ(describe(parse_unit("kg/m^5").unit), "kg/m^5");
}

TEST(NearestNames, FindTyposAndNothingElse) {
  const std::vector<std::string> names = {"lambda", "mu", "kappa", "dhat", "E"};
  EXPECT_EQ(nearest_name("lamda", names), "lambda");
  EXPECT_EQ(nearest_name("labmda", names), "lambda");
  EXPECT_EQ(nearest_name("kapa", names), "kappa");
  EXPECT_EQ(nearest_name("Dhat", names), "dhat");
  EXPECT_EQ(nearest_name("e", names), "E");
  EXPECT_EQ(nearest_name("x", names), "");
  EXPECT_EQ(nearest_name("velocity", names), "");
  EXPECT_EQ(did_you_mean("kapa", names), "; did you mean 'kappa'?");
  EXPECT_EQ(did_you_mean("zz", names), "");
}

}  // namespace
}  // namespace ergon

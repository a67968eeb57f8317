// Every case of ergon verify holds its bounds: quick rows in the fast tests, all rows in the slow ones.

#include "tools/verify/verify.h"

#include <gmock/gmock.h>

#include "tests/tools/command.h"
#include "tests/tools/json_lines.h"

namespace ergon {
namespace {

using Json = nlohmann::ordered_json;

class Verify : public CommandTest, public testing::WithParamInterface<std::string> {
 protected:
  std::vector<Json> rows(const std::string& arguments, int code) {
    const Answer answer = ergon("verify --json " + arguments);
    EXPECT_EQ(answer.code, code) << answer.out << answer.err;
    return json_lines(answer.out);
  }
  void expect_passed(const std::string& arguments) {
    int judged = 0;
    for (const Json& row : rows(arguments, 0)) {
      EXPECT_NE(row["result"], "MISSED") << row.dump();
      if (row["result"] == "passed") {
        ++judged;
        EXPECT_LE(row["error"].get<double>(), row["bound"].get<double>()) << row.dump();
      } else {
        EXPECT_NE(row["note"], "") << "a row that is not judged says why: " << row.dump();
      }
      EXPECT_NE(row["source"], "") << row.dump();
    }
    EXPECT_GT(judged, 0);
  }
};
class VerifyWhole : public Verify {};

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const VerifyCase& each : verify_cases()) out.push_back(each.name);
  return out;
}

TEST_P(Verify, QuickRowsPass) { expect_passed("--quick " + GetParam()); }
INSTANTIATE_TEST_SUITE_P(Cases, Verify, testing::ValuesIn(names()), [](const auto& each) { return each.param; });

TEST_P(VerifyWhole, AllRowsPass) { expect_passed(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Slow, VerifyWhole, testing::ValuesIn(names()), [](const auto& each) { return each.param; });

using VerifyCommand = Verify;

TEST_F(VerifyCommand, ListsItsCases) {
  const Answer answer = ergon("verify --list");
  EXPECT_EQ(answer.code, 0);
  for (const VerifyCase& each : verify_cases()) {
    EXPECT_THAT(answer.out, testing::HasSubstr(each.name + " "));
    EXPECT_THAT(answer.out, testing::HasSubstr(each.summary));
  }
}

TEST_F(VerifyCommand, NamesTheNearestCase) {
  const Answer answer = ergon("verify pach_test");
  EXPECT_EQ(answer.code, 2);
  EXPECT_EQ(answer.err, "ergon: error: there is no verification case 'pach_test'; did you mean 'patch_test'?\n");
}

TEST(VerifyRowTest, IsJudgedByItsBound) {
  VerifyRow row{"length", "Hex8", "1", 1.009, 1, 0.01, ""};
  EXPECT_NEAR(row.error(), 0.009, 1e-12);
  EXPECT_TRUE(row.passed());
  row.value = 1.011;
  EXPECT_FALSE(row.passed());
  row.bound.reset();
  EXPECT_TRUE(row.passed());
  row = {"residual", "Hex8", "1", -2e-3, 0, 1e-3, ""};
  EXPECT_NEAR(row.error(), 2e-3, 1e-15);
  EXPECT_FALSE(row.passed());
  row.value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(row.passed());
}

TEST(VerifyRowTest, TendsToWhatIsLeftWithoutErrorsInProportionToCells) {
  const VerifyRow coarse{"length", "Tri3", "8", 2.2, 3, std::nullopt, "soft sides"};
  const VerifyRow fine{"length", "Tri3", "16", 2.1, 3, std::nullopt, "soft sides"};
  const VerifyRow limit = limit_of(coarse, fine, 2);
  EXPECT_NEAR(limit.value, 2, 1e-12);
  EXPECT_EQ(limit.reference, 2);
  EXPECT_EQ(limit.quantity, "length, limit");
  EXPECT_EQ(limit.mesh, "cells to 0");
  EXPECT_TRUE(limit.judged() && limit.passed());
}

}  // namespace
}  // namespace ergon

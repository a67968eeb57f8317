// docs/verification.md shows what `ergon verify` printed: every case, under its present name and source.

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "tests/paths.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

TEST(VerificationPage, HasEveryCaseAndNoOther) {
  std::ostringstream text;
  text << std::ifstream(test::source("/docs/verification.md")).rdbuf();
  std::string expected;
  for (const VerifyCase& each : verify_cases()) {
    expected = each.name + ": " + each.summary + "\n  source: " + each.source + "\n";
    EXPECT_THAT(text.str(), testing::HasSubstr("\n" + expected));
  }
  size_t sources = 0;
  for (size_t at = text.str().find("\n  source: "); at != std::string::npos;
       at = text.str().find("\n  source: ", at + 1))
    ++sources;
  EXPECT_EQ(sources, verify_cases().size());
  EXPECT_EQ(text.str().find("MISSED"), std::string::npos);
}

}  // namespace
}  // namespace ergon

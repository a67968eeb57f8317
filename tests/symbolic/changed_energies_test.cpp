// Energies changed at random, the same changes in every run: whatever is given, the answer is an energy or a
// SourceError with a place in the text.
#include <gtest/gtest.h>

#include <random>

#include "symbolic/energy.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

class Changes {
 public:
  explicit Changes(std::vector<std::string> texts) : texts_(std::move(texts)) {}

  std::string next() {
    std::string text = pick(texts_);
    for (size_t i = below(4) + 1; i > 0; --i) change(text);
    return text;
  }

 private:
  size_t below(size_t n) { return n == 0 ? 0 : engine_() % n; }
  const std::string& pick(const std::vector<std::string>& from) { return from[below(from.size())]; }

  // A random part of another text.
  std::string part() {
    const std::string& from = pick(texts_);
    const size_t start = below(from.size());
    return from.substr(start, below(40));
  }

  void change(std::string& text) {
    static const std::vector<std::string> pieces = {"(",       ")",       "[",
                                                    "]",       "'",       "^",
                                                    "-",       "*",       "/",
                                                    ",",       "\n",      "\n ",
                                                    "#",       "1e999",   "1e-400",
                                                    "0.5.5",   "1/0",     "inf",
                                                    "F",       "det(",    "identity(9)",
                                                    "[0]",     "pi",      "\xC3\xA9",
                                                    "\xFF",    "\t",      "\r\n",
                                                    "min(1)",  "^(1/2)",  "case a b =",
                                                    "let x =", "value 0", "999999999999",
                                                    "\0x"};
    const size_t at = below(text.size() + 1);
    switch (below(6)) {
      case 0:
        text.insert(at, pick(pieces));
        break;
      case 1:
        text.erase(at, below(20));
        break;
      case 2:
        text.insert(at, part());
        break;
      case 3:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 4: {  // a line again, or gone
        const size_t start = text.rfind('\n', at) + 1, end = std::min(text.find('\n', at), text.size());
        if (start > end) break;
        const std::string line = text.substr(start, end - start);
        below(2) == 0 ? text.insert(start, line + "\n") : text.erase(start, end - start);
        break;
      }
      default: {  // deep nesting
        const size_t depth = below(300);
        text.insert(at, std::string(depth, below(2) == 0 ? '(' : '-'));
      }
    }
  }

  std::vector<std::string> texts_;
  std::mt19937 engine_{7};
};

TEST(ChangedEnergies, AreReadOrRefusedAtAPlace) {
  std::vector<std::string> texts;
  for (const char* folder : {"energies", "tests/errors/energies", "tests/errors/checks"})
    for (const auto& file : test::energy_files(folder)) texts.push_back(test::contents(file));
  Changes changes(texts);
  int read = 0, refused = 0;
  for (int i = 0; i < 6000; ++i) {
    const std::string text = changes.next();
    try {
      parse_energy(text, "changed.energy");
      ++read;
    } catch (const SourceError& error) {
      ++refused;
      const Place& place = error.place();
      EXPECT_EQ(place.file, "changed.energy");
      EXPECT_LE(place.line, 1 + std::count(text.begin(), text.end(), '\n'));
      EXPECT_TRUE(place.line == 0 || place.column >= 1) << error.what();
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 2000);
}

}  // namespace
}  // namespace ergon

// Scenes changed at random, the same changes in every run: whatever is given, the answer is a scene or a SourceError.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "scenes/scene_reader.h"
#include "symbolic/diagnostic.h"
#include "tests/paths.h"

namespace ergon {
namespace {

std::vector<std::string> scene_texts() {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"/scenes", "/tests/errors/scenes"})
    for (const auto& entry : std::filesystem::directory_iterator(test::source() + folder))
      if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const auto& file : files) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    texts.push_back(text.str());
  }
  return texts;
}

TEST(changed_scenes, are_read_or_refused_at_a_place) {
  const std::vector<std::string> texts = scene_texts();
  ASSERT_GT(texts.size(), 20u);
  std::mt19937 engine{11};
  auto below = [&](size_t n) { return n == 0 ? 0 : engine() % n; };
  const std::vector<std::string> pieces = {"[",
                                           "]",
                                           "{",
                                           "}",
                                           "\"",
                                           "=",
                                           ",",
                                           "\n",
                                           "#",
                                           "[[object]]\n",
                                           "-1",
                                           "nan",
                                           "-inf",
                                           "1e999",
                                           "[1, 2]",
                                           "true",
                                           "\"1 m\"",
                                           "''",
                                           "\xC3\xA9",
                                           "\xFF",
                                           "9223372036854775808",
                                           "0x",
                                           "1979-05-27",
                                           "a.b = 1\n"};
  int read = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = texts[below(texts.size())];
    for (size_t changes = below(3) + 1; changes > 0; --changes) {
      const size_t at = below(text.size() + 1);
      const std::string& other = texts[below(texts.size())];
      const size_t kind = below(4);
      if (kind == 0) text.insert(at, pieces[below(pieces.size())]);
      if (kind == 1) text.erase(at, below(15));
      if (kind == 2) text.insert(at, other.substr(below(other.size()), below(40)));
      if (kind == 3 && at < text.size()) text[at] = static_cast<char>(below(256));
    }
    try {
      read_scene_text(text, "changed.toml");
      ++read;
    } catch (const SourceError& error) {
      ++refused;
      EXPECT_EQ(error.place().file, "changed.toml") << error.what();
      EXPECT_GE(error.place().line, 0);
    }
  }
  EXPECT_GT(read, 40);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace ergon

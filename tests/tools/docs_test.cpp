// What the documents show is read by the program itself.

#include <gmock/gmock.h>

#include <algorithm>

#include "symbolic/energy.h"
#include "symbolic/functions.h"
#include "tests/paths.h"
#include "tests/symbolic/energy_files.h"
#include "tests/tools/command.h"

namespace ergon {
namespace {

std::string file_text(const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(test::source("/") + name).rdbuf();
  return text.str();
}

// The contents of the fenced blocks with this info string.
std::vector<std::string> blocks(const std::string& text, const std::string& info) {
  std::vector<std::string> found;
  std::istringstream lines(text);
  std::string line;
  bool inside = false;
  while (std::getline(lines, line)) {
    if (line.starts_with("```")) {
      inside = !inside && line == "```" + info;
      if (inside) found.emplace_back();
    } else if (inside) {
      found.back() += line + "\n";
    }
  }
  return found;
}

// Whether the word stands in the text on its own.
bool has_word(const std::string& text, const std::string& word) {
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    auto inner = [&](size_t i) { return i < text.size() && (std::isalnum(text[i]) || text[i] == '_'); };
    if (!inner(at - 1) && !inner(at + word.size())) return true;
  }
  return false;
}

class Docs : public CommandTest {};
class SlowDocs : public Docs {};

TEST_F(Docs, EnergiesInTheLanguageReferenceAreSound) {
  const std::vector<std::string> energies = blocks(file_text("docs/language.md"), "energy");
  EXPECT_GE(energies.size(), 2u);
  for (const std::string& text : energies) {
    write("example.energy", text);
    const Answer answer = ergon("check example.energy");
    EXPECT_EQ(answer.code, 0) << text << answer.out << answer.err;
  }
}

TEST_F(SlowDocs, TheStepsOfAuthoringWork) {
  const std::vector<std::string> scripts = blocks(file_text("docs/language.md"), "sh");
  ASSERT_EQ(scripts.size(), 1u);
  std::filesystem::create_symlink(test::source("/tests"), folder / "tests");
  const Answer answer = shell("set -e; PATH=" + test::built() + ":$PATH\n" + scripts[0]);
  EXPECT_EQ(answer.code, 0) << answer.out << answer.err;
  for (const char* made : {"my_rubber.energy", "my_rubber.svg", "my_fit.svg", "my_bending.svg", "my_bending.csv",
                           "out/my_scene/my_scene.pvd", "out/my_sheet/my_sheet.pvd"})
    EXPECT_TRUE(std::filesystem::exists(folder / made)) << made;
}

TEST_F(Docs, TheLanguageReferenceNamesEveryFunctionAndStencil) {
  const std::string text = file_text("docs/language.md");
  for (const std::string& name : function_names()) EXPECT_TRUE(has_word(text, name)) << name;
  for (const std::string& name : stencil_names()) EXPECT_TRUE(has_word(text, name)) << name;
  for (const char* geometry : {"solid", "membrane", "line"}) EXPECT_TRUE(has_word(text, geometry));
}

TEST_F(Docs, FoldersAndFilesThatAreNamedExist) {
  for (const char* document : {"README.md", "docs/design.md"}) {
    const std::string text = file_text(document);
    ASSERT_FALSE(text.empty()) << document;
    // `folder/file` in code quotes
    for (size_t at = text.find('`'); at != std::string::npos;) {
      const size_t end = text.find('`', at + 1);
      if (end == std::string::npos) break;
      const std::string word = text.substr(at + 1, end - at - 1);
      const bool path = word.find('/') != std::string::npos && word.find_first_of(" *<>{}()^\n$=") == std::string::npos;
      const std::string top = word.substr(0, word.find('/'));
      if (path && top != "build" && top != "out" && top != "." && top != "") {
        EXPECT_TRUE(std::filesystem::exists(test::source("/") + word)) << document << ": " << word;
      }
      at = text.find('`', end + 1);
    }
  }
}

TEST_F(Docs, TheEmittedCodeInTheReadmeIsWhatIsEmitted) {
  const std::vector<std::string> shown = blocks(file_text("README.md"), "cpp");
  ASSERT_EQ(shown.size(), 1u);
  const Answer answer = ergon("show stable_neo_hookean --source");
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_NE(answer.out.find(shown[0]), std::string::npos) << answer.out;
}

TEST_F(SlowDocs, EveryProcessEmitsTheSameBytes) {
  for (const std::string& name : test::catalogue_names()) {
    const std::string command = "show " + name + " --source";
    const std::string first = ergon(command).out;
    EXPECT_NE(first.find("hessian_entry"), std::string::npos) << name;
    EXPECT_EQ(ergon(command).out, first) << name;
  }
}

// Every command in the README's shell blocks, in a folder that holds the repository's energies and scenes.
class SlowReadme : public CommandTest {};

TEST_F(SlowReadme, EveryCommandWorks) {
  const std::string text = file_text("README.md");
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 150);
  for (const char* name : {"energies", "docs"}) {
    std::filesystem::create_symlink(test::source("/") + name, folder / name);
  }
  // Laws beside it are named as "../LAW", which leads elsewhere from a link.
  std::filesystem::copy(test::source("/scenes"), folder / "scenes", std::filesystem::copy_options::recursive);
  std::filesystem::create_symlink(test::built(), folder / "build");
  int commands = 0;
  for (const std::string& block : blocks(text, "sh")) {
    std::istringstream lines(block);
    for (std::string line; std::getline(lines, line);) {
      const std::string command = line.substr(0, line.find(" #"));
      if (command.empty() || command.starts_with("#")) continue;
      ++commands;
      const std::string program = command.substr(0, command.find(' '));
      if (program == "./tools/run" || program == "./tools/test" || program == "./tools/checks.sh") {
        // They would build and test again from within the tests.
        const auto script = std::filesystem::path(test::source()) / program;
        EXPECT_NE(std::filesystem::status(script).permissions() & std::filesystem::perms::owner_exec,
                  std::filesystem::perms::none)
            << script;
        EXPECT_EQ(shell("bash -n '" + script.string() + "'").code, 0) << script;
        continue;
      }
      const Answer answer = shell(command);
      EXPECT_EQ(answer.code, 0) << command << "\n" << answer.err;
      EXPECT_FALSE(answer.out.empty()) << command;
    }
  }
  EXPECT_GE(commands, 5);
}

}  // namespace
}  // namespace ergon

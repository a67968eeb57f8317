#pragma once
// Runs commands of a shell as a user would, in a folder of the test's own.

#include <sys/wait.h>

#include <gtest/gtest.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/paths.h"
#include "tests/runtime/temporary_folder.h"

namespace ergon {

struct Answer {
  int code = -1;
  std::string out;
  std::string err;
};

class CommandTest : public testing::Test {
 protected:
  void SetUp() override {
    folder = own_.path("");
    setenv("ERGON_CACHE", (folder / "cache").c_str(), 1);
  }

  std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder / name).rdbuf();
    return text.str();
  }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << text;
  }

  // With the folder as the working directory.
  Answer shell(const std::string& command) const {
    const std::string all = "cd '" + folder.string() + "' && { " + command + "\n} >stdout.txt 2>stderr.txt </dev/null";
    const int status = std::system(all.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, read("stdout.txt"), read("stderr.txt")};
  }
  Answer ergon(const std::string& arguments) const { return shell(test::built("/ergon") + " " + arguments); }

  std::filesystem::path folder;

 private:
  // Of this process alone: the same test may run from another checkout at the same time.
  TemporaryFolder own_;
};

}  // namespace ergon

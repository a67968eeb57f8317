#include "codegen/build.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include "codegen/hash.h"

extern char** environ;

namespace ergon {
namespace {

std::string first_lines(const std::filesystem::path& file, int lines) {
  std::ifstream in(file);
  std::string out, line;
  for (int i = 0; i < lines && std::getline(in, line); ++i) out += "\n  " + line;
  return out;
}

}  // namespace

std::string default_compiler() {
  const char* chosen = std::getenv("ERGON_CXX");
  return chosen && *chosen ? chosen : "g++";
}

std::string compiler_identity(const std::string& compiler) {
  namespace fs = std::filesystem;
  std::vector<fs::path> places;
  if (compiler.find('/') != std::string::npos) {
    places.emplace_back(compiler);
  } else {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');) places.push_back(fs::path(folder) / compiler);
  }
  for (const fs::path& place : places) {
    std::error_code error;
    const fs::path file = fs::canonical(place, error);
    if (error || access(file.c_str(), X_OK) != 0) continue;
    const auto size = fs::file_size(file, error);
    const auto time = fs::last_write_time(file, error).time_since_epoch().count();
    return content_hash(fmt::format("{} {} {}", file.string(), size, time)).substr(0, 8);
  }
  return "";
}

std::vector<std::string> compiler_flags(VectorType type) {
  std::vector<std::string> flags = {"-O1",
                                    "-w",
                                    "-fno-math-errno",
                                    "-fno-trapping-math",
                                    "-fvisibility=hidden",
                                    "-fno-exceptions",
                                    "-fno-rtti",
                                    "-fno-asynchronous-unwind-tables",
                                    "-fPIC",
                                    "-shared",
                                    "-nostdlib"};  // of C++ nothing is used; looking it up takes the linker longest
#if defined(__x86_64__)
  if (type.bytes() == 32) flags.push_back("-march=x86-64-v3");
  if (type.bytes() == 64) flags.push_back("-march=x86-64-v4");
  if (type.lanes > 1) flags.push_back("-lmvec");
#endif
  flags.push_back("-lm");
  flags.push_back("-lc");
  return flags;
}

void build_library(const std::string& compiler, VectorType type, const std::filesystem::path& source,
                   const std::filesystem::path& library) {
  std::filesystem::path messages = library;
  messages += ".log";
  // The source goes before the libraries it needs.
  std::vector<std::string> words = {compiler, source.string(), "-o", library.string()};
  for (const std::string& f : compiler_flags(type)) words.push_back(f);
  std::vector<char*> arguments;
  for (std::string& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t pid = 0;
  int error = posix_spawnp(&pid, compiler.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  auto missing = [&](const std::string& why) {
    return BuildError(fmt::format(
        "no C++ compiler to make a kernel with: '{}': {}; install one (Debian: apt-get install g++) or name "
        "one in the environment variable ERGON_CXX",
        compiler, why));
  };
  if (error != 0) {
    std::error_code none;
    std::filesystem::remove(messages, none);
    throw missing(std::strerror(error));
  }
  int status = 0;
  while (waitpid(pid, &status, 0) < 0)
    if (errno != EINTR) throw BuildError(fmt::format("waiting for '{}': {}", compiler, std::strerror(errno)));
  std::string log = first_lines(messages, 5);
  std::filesystem::remove(messages);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) throw missing("it could not be started");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw BuildError(fmt::format("'{}' could not compile {}; its first messages:{}", compiler, source.string(), log));
}

}  // namespace ergon

#include "codegen/cache.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <dlfcn.h>
#include <unistd.h>

#include <fmt/format.h>

#include "codegen/build.h"
#include "codegen/hash.h"

namespace ergon {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSeal = "ERGON-KERNEL-";  // followed by the hash of all bytes before it

std::string read_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

std::string seal(const std::string& content) { return std::string(kSeal) + content_hash(content); }

constexpr size_t kSealSize = kSeal.size() + 32;

bool sealed(const std::string& bytes) {
  size_t tail = kSealSize;
  if (bytes.size() <= tail) return false;
  size_t content = bytes.size() - tail;
  return bytes.compare(content, kSeal.size(), kSeal) == 0 &&
         bytes.compare(content + kSeal.size(), 32, content_hash(std::string_view(bytes).substr(0, content))) == 0;
}

std::optional<LoadedKernel> open_library(const fs::path& file) {
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) return std::nullopt;
  LoadedKernel kernel;
  kernel.library = std::shared_ptr<void>(handle, [](void* h) { dlclose(h); });
  kernel.table = static_cast<const ErgonKernel*>(dlsym(handle, "ergon_kernel"));
  if (!kernel.table || kernel.table->abi != ERGON_KERNEL_ABI) return std::nullopt;
  return kernel;
}

void write_file(const fs::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out << bytes;
  out.close();
  if (!out) throw std::runtime_error(fmt::format("cannot write {}; is the disk full?", file.string()));
}

// Of a file that is being written.
std::string unique_name(const std::string& key) {
  return fmt::format("{}.{}-{:x}", key, getpid(), std::chrono::steady_clock::now().time_since_epoch().count());
}

std::string name_of(const std::string& key, const std::string& maker) { return key + "-" + maker + ".so"; }

// The files of that key, whoever made them, sorted.
std::vector<fs::path> files_of(const fs::path& folder, const std::string& key) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".so" && entry.path().filename().string().starts_with(key + "-"))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

KernelCache::KernelCache(std::vector<fs::path> folders) : folders_(std::move(folders)) {}

fs::path KernelCache::user_folder() {
  auto set = [](const char* name) -> const char* {
    const char* v = std::getenv(name);
    return v && *v ? v : nullptr;
  };
  if (const char* chosen = set("ERGON_CACHE")) return chosen;
  if (const char* xdg = set("XDG_CACHE_HOME")) return fs::path(xdg) / "ergon";
  if (const char* home = set("HOME")) return fs::path(home) / ".cache" / "ergon";
  return fs::temp_directory_path() / fmt::format("ergon-{}", getuid());
}

std::optional<LoadedKernel> KernelCache::load(const std::string& key, const std::string& maker) const {
  for (const fs::path& folder : folders_) {
    for (const fs::path& file : maker.empty() ? files_of(folder, key) : std::vector{folder / name_of(key, maker)}) {
      std::error_code none;
      if (!fs::is_regular_file(file, none)) continue;
      if (!sealed(read_file(file))) continue;
      if (auto kernel = open_library(file)) return kernel;
    }
  }
  return std::nullopt;
}

std::optional<std::string> KernelCache::note(const std::string& key) const {
  for (const fs::path& folder : folders_) {
    std::string bytes = read_file(folder / (key + ".note"));
    if (sealed(bytes)) return bytes.substr(0, bytes.size() - kSealSize);
  }
  return std::nullopt;
}

void KernelCache::keep_note(const std::string& key, const std::string& text) const {
  for (const fs::path& folder : folders_) {
    std::error_code error;
    fs::create_directories(folder, error);
    const fs::path unique = folder / unique_name(key);
    try {
      write_file(unique, text + seal(text));
    } catch (const std::exception&) {
      fs::remove(unique, error);
      continue;
    }
    fs::rename(unique, folder / (key + ".note"), error);
    if (!error) return;
    fs::remove(unique, error);
  }
}

LoadedKernel KernelCache::make(const std::string& key, const std::string& maker, const std::string& source,
                               VectorType type, const std::string& compiler, double* compile_seconds) const {
  const std::string name = name_of(key, maker);
  std::string tried;
  for (const fs::path& folder : folders_) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error || access(folder.c_str(), W_OK) != 0) {
      tried += " " + folder.string();
      continue;
    }
    const std::string unique = unique_name(key);
    fs::path text = folder / (unique + ".cpp"), library = folder / (unique + ".tmp");
    struct Cleanup {
      fs::path a, b;
      ~Cleanup() {
        std::error_code none;
        fs::remove(a, none);
        fs::remove(b, none);
      }
    } cleanup{text, library};
    write_file(text, source);
    auto start = std::chrono::steady_clock::now();
    build_library(compiler, type, text, library);
    if (compile_seconds)
      *compile_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::string bytes = read_file(library);
    write_file(library, bytes + seal(bytes));
    fs::rename(library, folder / name);
    fs::rename(text, (folder / name).replace_extension(".cpp"));
    if (auto kernel = open_library(folder / name)) return *kernel;
    const char* why = dlerror();
    throw BuildError(fmt::format("the kernel {} was built but cannot be loaded: {}", (folder / name).string(),
                                 why ? why : "wrong interface version"));
  }
  throw std::runtime_error("no folder to keep kernels in can be written (tried:" + tried +
                           "); set ERGON_CACHE to one that can");
}

}  // namespace ergon

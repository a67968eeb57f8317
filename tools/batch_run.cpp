#include "tools/batch_run.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <thread>

#include "runtime/error.h"
#include "runtime/output/atomic_file.h"
#include "runtime/output/progress.h"

extern char** environ;

namespace ergon {
namespace fs = std::filesystem;
namespace {

constexpr double memory_margin = 1.25;  // free memory that a further job must find, over the largest seen so far
constexpr auto pause = std::chrono::milliseconds(20);

// A number in kB after a word in a file of /proc; 0 where there is none.
double proc_number(const std::string& file, const std::string& word) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(word)) return std::atof(line.c_str() + word.size());
  return 0;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw OutputError(fmt::format("{}: this folder cannot be made: {}", folder.string(), error.message()));
}

void copy_inputs(const BatchPlan& plan) {
  const fs::path to = fs::path(plan.folder) / "inputs";
  make_folder(to);
  for (const auto& [file, name] : plan.inputs) {
    std::error_code error;
    fs::copy_file(file, to / name, fs::copy_options::overwrite_existing, error);
    if (error && fs::exists(file))
      throw OutputError(fmt::format("{}: cannot be copied to {}: {}", file, to.string(), error.message()));
  }
}

// The message of a run that failed: the last line of its log.
std::string reason_of(const fs::path& log, int status) {
  if (WIFSIGNALED(status)) return fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  std::ifstream in(log);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  const std::string start = "ergon: error: ";
  if (last.starts_with(start)) last.erase(0, start.size());
  return last.empty() ? fmt::format("exit code {}", WEXITSTATUS(status)) : last;
}

class Batch {
 public:
  Batch(const BatchPlan& plan, const BatchOptions& options)
      : plan_(plan), options_(options), outcomes_(plan.jobs.size()), pids_(plan.jobs.size(), -1) {
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    limit_ = plan.at_once > 0 ? plan.at_once : std::max(1, static_cast<int>(cores) / plan.threads);
  }

  std::vector<JobOutcome> run() {
    make_folder(plan_.folder);
    copy_inputs(plan_);
    for (size_t i = 0; i < plan_.jobs.size() && !options_.again; ++i) {
      outcomes_[i] = outcome_of(plan_, plan_.jobs[i]);
      outcomes_[i].skipped = outcomes_[i].state == JobState::done;
    }
    write_table();
    size_t next = 0;
    bool stopping = false;
    while (true) {
      if (!stopping && options_.stop && options_.stop()) {
        stopping = true;
        for (const pid_t pid : pids_)
          if (pid > 0) kill(pid, SIGTERM);
      }
      while (next < plan_.jobs.size() && outcomes_[next].state == JobState::done) ++next;
      if (!stopping && next < plan_.jobs.size() && may_start())
        start(next++);
      else if (running_ == 0)
        break;
      else if (!collect(stopping))
        std::this_thread::sleep_for(pause);
      tell();
    }
    tell(true);
    return outcomes_;
  }

 private:
  bool may_start() {
    if (running_ == 0) return true;
    if (running_ >= limit_) return false;
    for (const pid_t pid : pids_)
      if (pid > 0) largest_ = std::max(largest_, proc_number(fmt::format("/proc/{}/status", pid), "VmHWM:"));
    const double free = proc_number("/proc/meminfo", "MemAvailable:");
    // Until a job has ended nobody knows what one takes: the second starts when the first has shown something.
    return largest_ > 0 && free > memory_margin * largest_;
  }

  void start(size_t i) {
    const BatchJob& job = plan_.jobs[i];
    const fs::path folder = fs::path(plan_.folder) / job.name;
    make_folder(folder);
    fs::remove(folder / "summary.json");
    write_file((folder / "scene.toml").string(), job.scene);
    write_file((folder / "fingerprint.txt").string(), job.fingerprint + "\n");
    const std::string scene = (folder / "scene.toml").string(), out = folder.string(),
                      log = (folder / "log.txt").string();
    const std::string threads = std::to_string(plan_.threads);
    std::vector<std::string> words = {options_.program, "run", scene, "--out", out, "--threads", threads, "--quiet"};
    if (plan_.verify) words.emplace_back("--verify");
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    // A group of its own: an interrupt from the terminal reaches jobs through us, so that each ends after a whole step.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int error = posix_spawn(&pids_[i], options_.program.c_str(), &files, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    if (error != 0) {
      pids_[i] = -1;
      end(i,
          {JobState::failed, fmt::format("{} cannot be started: {}", options_.program, std::strerror(error)), false});
      return;
    }
    outcomes_[i] = {JobState::running, "", false};
    ++running_;
  }

  // True when a job has ended.
  bool collect(bool stopping) {
    for (size_t i = 0; i < pids_.size(); ++i) {
      if (pids_[i] <= 0) continue;
      int status = 0;
      if (waitpid(pids_[i], &status, WNOHANG) != pids_[i]) continue;
      pids_[i] = -1;
      --running_;
      JobOutcome outcome = outcome_of(plan_, plan_.jobs[i]);
      if (outcome.state != JobState::done && !stopping)
        outcome = {JobState::failed, reason_of(fs::path(plan_.folder) / plan_.jobs[i].name / "log.txt", status), false};
      end(i, outcome);
      return true;
    }
    return false;
  }

  void end(size_t i, const JobOutcome& outcome) {
    outcomes_[i] = outcome;
    ++ended_;
    write_table();
  }

  void write_table() { write_file((fs::path(plan_.folder) / "table.csv").string(), batch_table(plan_, outcomes_)); }

  void tell(bool last = false) {
    if (options_.progress == nullptr) return;
    const double now = Progress::steady_seconds();
    const bool terminal = isatty(STDOUT_FILENO) != 0;
    if (!last && (told_ == ended_ || !terminal) && (!terminal || now - told_at_ < 1)) return;
    told_ = ended_;
    told_at_ = now;
    std::string line = progress_text(now - began_);
    if (terminal) line = "\r" + line + "\x1b[K" + (last ? "\n" : "");
    *options_.progress << line << (terminal ? "" : "\n") << std::flush;
  }

  std::string progress_text(double seconds) const {
    const auto count = [&](JobState state) {
      return std::count_if(outcomes_.begin(), outcomes_.end(), [&](const auto& o) { return o.state == state; });
    };
    const auto skipped = std::count_if(outcomes_.begin(), outcomes_.end(), [](const auto& o) { return o.skipped; });
    const auto left = count(JobState::open) + count(JobState::running);
    std::string text = fmt::format("{}/{} done", count(JobState::done), outcomes_.size());
    if (skipped > 0) text += fmt::format(" ({} before)", skipped);
    if (count(JobState::failed) > 0) text += fmt::format(", {} failed", count(JobState::failed));
    if (running_ > 0) text += fmt::format(", {} running", running_);
    if (left > 0 && ended_ > 0)
      text += fmt::format(", {} left", duration_text(seconds / ended_ * static_cast<double>(left)));
    return text;
  }

  const BatchPlan& plan_;
  const BatchOptions& options_;
  std::vector<JobOutcome> outcomes_;
  std::vector<pid_t> pids_;
  int limit_ = 1, running_ = 0, ended_ = 0, told_ = -1;
  double largest_ = 0;  // kB, of any job so far
  double told_at_ = 0, began_ = Progress::steady_seconds();
};

}  // namespace

std::vector<JobOutcome> run_batch(const BatchPlan& plan, const BatchOptions& options) {
  return Batch(plan, options).run();
}

}  // namespace ergon

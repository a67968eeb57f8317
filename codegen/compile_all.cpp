#include "codegen/compile_all.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <queue>
#include <thread>

#include <fmt/format.h>

#include "codegen/build.h"

namespace ergon {
namespace {

void record_failure(CompileOutcome& outcome) {
  outcome.error = std::current_exception();
  try {
    throw;
  } catch (const std::exception& error) {
    outcome.message = error.what();
  } catch (...) {
    outcome.message = "an error without a message";
  }
}

// Threads that finish what was prepared. Each outcome is written by one of them, and read when all have ended.
class Finishers {
 public:
  Finishers(int workers, std::vector<CompileOutcome>& outcomes) : outcomes_(outcomes) {
    for (int i = 0; i < workers; ++i) threads_.emplace_back([this] { work(); });
  }
  ~Finishers() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    ready_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  Finishers(const Finishers&) = delete;
  Finishers& operator=(const Finishers&) = delete;

  void add(size_t job, PreparedKernel prepared) {
    {
      const std::lock_guard lock(mutex_);
      waiting_.emplace(job, std::move(prepared));
    }
    ready_.notify_one();
  }

 private:
  std::optional<std::pair<size_t, PreparedKernel>> next() {
    std::unique_lock lock(mutex_);
    ready_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
    if (waiting_.empty()) return std::nullopt;
    auto first = std::move(waiting_.front());
    waiting_.pop();
    return first;
  }

  void work() {
    while (auto item = next()) {
      CompileOutcome& outcome = outcomes_[item->first];
      try {
        outcome.kernel = finish(std::move(item->second));
      } catch (...) {
        record_failure(outcome);
      }
    }
  }

  std::vector<CompileOutcome>& outcomes_;
  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable ready_;
  std::queue<std::pair<size_t, PreparedKernel>> waiting_;
  bool closed_ = false;
};

}  // namespace

std::vector<CompileOutcome> compile_all(const std::vector<CompileJob>& jobs, int workers) {
  std::vector<CompileOutcome> outcomes(jobs.size());
  if (workers <= 0) workers = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  {
    Finishers finishers(std::min(workers, static_cast<int>(jobs.size())), outcomes);
    for (size_t i = 0; i < jobs.size(); ++i) {
      try {
        PreparedKernel prepared = prepare(*jobs[i].energy, jobs[i].options);
        if (prepared.kernel.cached) {
          outcomes[i].kernel = finish(std::move(prepared));
        } else {
          finishers.add(i, std::move(prepared));
        }
      } catch (...) {
        record_failure(outcomes[i]);
      }
    }
  }  // all have ended
  return outcomes;
}

std::vector<CompiledKernel> kernels_of(std::vector<CompileOutcome> outcomes) {
  std::vector<const CompileOutcome*> failed;
  for (const CompileOutcome& outcome : outcomes)
    if (outcome.error) failed.push_back(&outcome);
  if (failed.size() == 1) std::rethrow_exception(failed.front()->error);
  if (!failed.empty()) {
    std::string text = fmt::format("{} of {} kernels could not be compiled:", failed.size(), outcomes.size());
    for (const CompileOutcome* outcome : failed) text += "\n" + outcome->message;
    throw BuildError(text);
  }
  std::vector<CompiledKernel> kernels;
  for (CompileOutcome& outcome : outcomes) kernels.push_back(std::move(outcome.kernel));
  return kernels;
}

}  // namespace ergon

#pragma once
// Runs the jobs of a sweep in processes of their own, as many at once as fit cores and memory. It establishes that no
// job is lost: each ends as done, failed with its reason, or open, and a later run of the same sweep does what is open
// or failed and skips what is done.

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "tools/batch_plan.h"

namespace ergon {

enum class JobState { open, running, done, failed };

struct JobOutcome {
  JobState state = JobState::open;
  std::string reason;    // why it failed
  bool skipped = false;  // it was done before
};

struct BatchOptions {
  std::string program;               // the executable that runs a scene: PROGRAM run SCENE --out FOLDER ...
  bool again = false;                // jobs that are done too
  std::ostream* progress = nullptr;  // null: none
  std::function<bool()> stop;        // asked now and then; true ends what runs and leaves the rest open
};

// Writes FOLDER/inputs, FOLDER/JOB/{scene.toml, log.txt, fingerprint.txt and what a run writes}, and FOLDER/table.csv
// after each job: job, state, reason, swept keys, measures. Throws OutputError where the folder cannot be written.
std::vector<JobOutcome> run_batch(const BatchPlan& plan, const BatchOptions& options);

// Of a job that has ended: its state by what is in its folder.
JobOutcome outcome_of(const BatchPlan& plan, const BatchJob& job);

// The table as CSV (RFC 4180); measures of jobs that are not done are empty.
std::string batch_table(const BatchPlan& plan, const std::vector<JobOutcome>& outcomes);

}  // namespace ergon

#include "scenes/run.h"

#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>

#include <filesystem>
#include <memory>

#include "runtime/error.h"
#include "runtime/output/atomic_file.h"
#include "runtime/output/report.h"
#include "runtime/solver/stopwatch.h"
#include "scenes/frames.h"
#include "scenes/surface_check.h"

namespace ergon {
namespace fs = std::filesystem;
namespace {

std::string name_of_scene(const Scene& scene) { return fs::path(scene.file).stem().string(); }

std::vector<ObjectForces> forces_by_object(const ContactForces& forces, const std::vector<Body>& bodies) {
  std::vector<ObjectForces> out;
  for (const Body& body : bodies) {
    const auto sum = [&](const Eigen::Matrix3Xd& field) {
      const Eigen::Vector3d total = field.middleCols(body.first_vertex, body.ordered.vertices()).rowwise().sum();
      return std::array{total[0], total[1], total[2]};
    };
    out.push_back({body.name, sum(forces.normal), sum(forces.friction)});
  }
  return out;
}

std::vector<std::pair<std::string, std::array<double, 3>>> probed(const BuiltScene& built, const Eigen::Matrix3Xd& x) {
  std::vector<std::pair<std::string, std::array<double, 3>>> out;
  for (const Probe& probe : built.probes)
    out.emplace_back(probe.name, std::array{x(0, probe.vertex), x(1, probe.vertex), x(2, probe.vertex)});
  return out;
}

ReportRecord report_of(const StepRecord& record, const BuiltScene& built, const Eigen::Matrix3Xd& x) {
  ReportRecord out;
  out.step = static_cast<int>(record.step);
  out.time = record.time;
  out.dt = record.dt;
  out.converged = record.converged;
  out.newton_iterations = record.newton_iterations;
  out.residual = record.residual;
  out.energies = record.energy.stored;
  out.energies.emplace_back("kinetic", record.energy.kinetic);
  out.energies.emplace_back("total", record.energy.total);
  out.times = seconds_by_part(record.seconds);
  for (const std::string& text : record.skipped) {
    auto [part, reason] = part_and_reason(text);
    out.skipped.push_back({part, reason});
  }
  if (std::isfinite(record.smallest_gap)) out.smallest_gap = record.smallest_gap;
  out.contacts = record.contacts;
  const Budget& budget = record.budget;
  out.budget = {{"change", budget.change},          {"script", budget.script},      {"loads", budget.loads},
                {"barrier", budget.barrier},        {"friction", -budget.friction}, {"damping", -budget.damping},
                {"integrator", -budget.integrator}, {"residual", budget.residual}};
  const auto numbers = [](const Eigen::Vector3d& v) { return std::array{v[0], v[1], v[2]}; };
  out.momentum = {{"linear", numbers(record.momentum.linear)}, {"angular", numbers(record.momentum.angular)}};
  if (record.forces) out.forces = forces_by_object(*record.forces, built.bodies);
  out.probes = probed(built, x);
  out.more = {{"step_speed", record.step_speed},
              {"factorisations", static_cast<double>(record.factorisations)},
              {"halvings", static_cast<double>(record.halvings)},
              {"shifts", static_cast<double>(record.shifts)},
              {"indefinite", static_cast<double>(record.indefinite)},
              {"friction_iterations", static_cast<double>(record.friction_iterations)},
              {"friction_change", record.friction_change},
              {"barrier_stiffness", record.barrier_stiffness},
              {"energy_added", record.energy_added}};
  if (built.limits || built.step.creates_no_energy) out.more.emplace_back("refused", record.refused);
  if (built.limits && std::isfinite(built.limits->tolerance)) out.more.emplace_back("error", record.error);
  if (!built.constraints.empty()) {
    out.more.emplace_back("constraint_iterations", record.constraint_iterations);
    out.more.emplace_back("constraint_excess", record.constraint_excess);
  }
  if (!built.loads.empty()) out.more.emplace_back("load_factor", record.load_factor);
  return out;
}

// The files of a run; without a folder, none.
class Output {
 public:
  Output(const Scene& scene, const BuiltScene& built, const std::string& folder) : built_(&built), folder_(folder) {
    if (folder.empty()) return;
    prepare_output(folder);
    fs::remove(fs::path(folder) / "summary.json");
    report_ = std::make_unique<Report>((fs::path(folder) / "report.jsonl").string());
    if (scene.output.forces) {
      const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, built.system->vertices());
      forces_ = ContactForces{none, none};
    }
    if (scene.output.frames)
      frames_ = std::make_unique<FrameWriter>(folder, name_of_scene(scene),
                                              built.limits ? built.limits->interval : scene.output.frame_interval);
  }

  void state(const State& state, bool last = false) {
    if (frames_ != nullptr && frames_->last_step() != state.step && (last || frames_->due(state)))
      frames_->write(built_->bodies, state, forces_ ? &*forces_ : nullptr);
  }
  void step(const StepRecord& record, const State& state) {
    if (report_ == nullptr) return;
    report_->append(report_of(record, *built_, state.x));
    if (record.forces && record.accepted) forces_ = *record.forces;
  }
  void summary(const RunSummary& summary) {
    if (!folder_.empty()) write_file((fs::path(folder_) / "summary.json").string(), to_json(summary) + "\n");
  }
  int frames() const { return frames_ == nullptr ? 0 : frames_->frames(); }

 private:
  const BuiltScene* built_;
  std::string folder_;
  std::unique_ptr<Report> report_;
  std::unique_ptr<FrameWriter> frames_;
  std::optional<ContactForces> forces_;  // of the last step; zero at the start
};

RunSummary summary_of_start(const Scene& scene, const BuiltScene& built, double start_energy) {
  RunSummary out;
  out.scene = scene.file;
  out.integrator = scene.integrator();
  out.threads = omp_get_max_threads();
  out.vertices = vertices_of(built.bodies);
  for (const Body& body : built.bodies) out.cells += body.mesh.cell_count();
  out.start_energy = out.end_energy = start_energy;
  out.build = built.seconds;
  for (const std::string& text : built.skipped) out.skipped.emplace_back(text, 0);
  out.warnings = built.warnings;
  return out;
}

// "" when the step may stand.
std::string failure_of(const StepRecord& record, const State& state, const BuiltScene& built, bool verify) {
  if (!record.accepted) {
    const std::string where =
        record.worst_vertex < 0 ? "" : fmt::format(" ({})", vertex_text(built, record.worst_vertex));
    return fmt::format("step {} (to {:.6g} s) failed: {}{}", state.step + 1, state.time + record.dt, record.reason,
                       where);
  }
  if (!verify || built.surfaces == nullptr) return "";
  const SurfaceFaults faults = find_surface_faults(built, state.x);
  if (faults.none()) return "";
  return fmt::format("after step {} ({:.6g} s) surfaces intersect: {}", state.step, state.time,
                     to_text(faults, built, state.x));
}

// Whether the state is at the end of the run. Steps that adapt end at all multiples of dt.
bool is_done(const State& state, const BuiltScene& built) {
  if (!built.limits) return state.step >= built.steps;
  return state.time >= built.limits->end;
}

long peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024;  // ru_maxrss is in KiB
}

}  // namespace

std::string output_folder(const Scene& scene) {
  return scene.output.folder.empty() ? (fs::path("out") / name_of_scene(scene)).string() : scene.output.folder;
}

void prepare_output(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw OutputError(fmt::format("{}: this output folder cannot be made: {}", folder, error.message()));
  if (!fs::is_directory(folder)) throw OutputError(fmt::format("{}: the output folder is a file", folder));
  AtomicFile trial((fs::path(folder) / "report.jsonl").string());  // throws; leaves nothing behind
}

RunSummary run_scene(const Scene& scene, BuiltScene& built, const RunOptions& options) {
  double output_seconds = 0;
  std::unique_ptr<Output> output;
  State state = built.start;
  {
    Stopwatch watch(output_seconds);
    output = std::make_unique<Output>(scene, built, options.folder);
    output->state(state);
  }
  TimeStepper stepper = stepper_of(built);
  std::optional<StepControl> control;
  if (built.limits) control.emplace(stepper, *built.limits);
  RunSummary summary = summary_of_start(scene, built, stepper.energies(state).total);
  if (options.observe) options.observe(state);
  while (!is_done(state, built) && summary.failure.empty()) {
    if (options.stop && options.stop()) {
      summary.stopped = true;
      break;
    }
    const State before = options.verify ? state : State{};
    const StepRecord record = control ? control->step(state) : stepper.step(state);
    add_step(summary, record);
    summary.failure = failure_of(record, state, built, options.verify);
    if (options.verify && record.accepted && !summary.failure.empty()) state = before;
    {
      Stopwatch watch(output_seconds);
      output->step(record, state);
      output->state(state);
    }
    if (options.progress) options.progress(record, built.steps);
    if (options.observe && record.accepted) options.observe(state);
  }
  {
    Stopwatch watch(output_seconds);
    output->state(state, true);
  }
  summary.frames = output->frames();
  summary.largest_speed = std::sqrt(state.v.colwise().squaredNorm().maxCoeff());
  summary.probes = probed(built, state.x);
  summary.peak_memory = peak_memory();
  summary.output_seconds = output_seconds;
  output->summary(summary);
  if (options.last_state != nullptr) *options.last_state = state;
  return summary;
}

}  // namespace ergon

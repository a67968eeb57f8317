#include "tools/study/study_run.h"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "codegen/hash.h"
#include "runtime/error.h"
#include "runtime/lanes/lanes.h"
#include "runtime/output/atomic_file.h"
#include "scenes/run.h"
#include "scenes/scene_reader.h"
#include "scenes/scene_text.h"
#include "tools/choices.h"
#include "tools/installation.h"

namespace ergon {
namespace fs = std::filesystem;
namespace {

// Of a factorisation in the time of one Hessian at a point: 0.1 to 0.3 us (`ergon bench kernels`), while factorisations
// do 2.8 (scenes/cantilever.toml) to 11 (bunny_drop.toml) operations in a nanosecond (factor_flops of summary.json).
constexpr double flops_per_hessian = 1000;
constexpr double same_time = 1e-9;  // of the interval

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double hessian_points(BuiltScene& built) {
  double sum = 0;
  for (int i = 0; i < built.system->potential_count(); ++i) {
    const Potential& potential = built.system->potential(i);
    if (!potential.kernel().constant_hessian)
      sum += static_cast<double>(potential.stencil_count()) * potential.quadrature_points();
  }
  return sum;
}

Eigen::Matrix3Xd probed(const BuiltScene& built, const State& state) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(built.probes.size()));
  for (Eigen::Index i = 0; i < out.cols(); ++i) out.col(i) = state.x.col(built.probes[static_cast<size_t>(i)].vertex);
  return out;
}

StudyRun run_now(const Scene& scene) {
  const Catalogue catalogue(Catalogue::default_folders());
  BuiltScene built = build_scene(scene, catalogue, [&](const std::vector<KernelRequest>& requests) {
    return load_kernels(requests, lanes::best_lanes(), precision_named(scene.solver.precision));
  });
  StudyRun out;
  const double interval = scene.output.frame_interval;
  RunOptions options;
  options.observe = [&](const State& state) {
    const double due = interval * static_cast<double>(out.x.size());
    if (state.time >= due - same_time * interval) out.x.push_back(probed(built, state));
  };
  const double start = processor_seconds();
  const RunSummary summary = run_scene(scene, built, options);
  out.seconds = processor_seconds() - start;
  out.failure = summary.failure;
  out.steps = summary.steps;
  out.newton_iterations = summary.newton_iterations;
  out.linear_solves = summary.linear_solves;
  out.factor_flops = summary.factor_flops;
  out.hessian_points = hessian_points(built) * static_cast<double>(summary.linear_solves);
  out.vertices = summary.vertices;
  return out;
}

std::string text_of(const StudyRun& run) {
  nlohmann::ordered_json json = {{"failure", run.failure},
                                 {"seconds", run.seconds},
                                 {"steps", run.steps},
                                 {"newton_iterations", run.newton_iterations},
                                 {"linear_solves", run.linear_solves},
                                 {"factor_flops", run.factor_flops},
                                 {"hessian_points", run.hessian_points},
                                 {"vertices", run.vertices}};
  for (const Eigen::Matrix3Xd& x : run.x) json["x"].push_back(std::vector<double>(x.data(), x.data() + x.size()));
  return json.dump() + "\n";
}

// False for a file that is not there or not whole.
bool read_run(const fs::path& file, StudyRun& run) {
  std::ifstream in(file);
  const nlohmann::json json = in ? nlohmann::json::parse(in, nullptr, false) : nlohmann::json();
  if (!json.is_object()) return false;
  run = {{},
         json.at("failure"),
         json.at("seconds"),
         json.at("steps"),
         json.at("newton_iterations"),
         json.at("linear_solves"),
         json.at("factor_flops"),
         json.at("hessian_points"),
         json.at("vertices")};
  for (const auto& at : json.at("x")) {
    const auto numbers = at.get<std::vector<double>>();
    run.x.emplace_back(
        Eigen::Map<const Eigen::Matrix3Xd>(numbers.data(), 3, static_cast<Eigen::Index>(numbers.size() / 3)));
  }
  return true;
}

std::string scene_file(const std::string& name) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  return (program / "studies" / (name + ".toml")).string();
}

// A change that a step of fixed length cannot meet times of comparison with would make a wrong error.
void check_times(const Scene& scene) {
  const double interval = scene.output.frame_interval, steps = interval / scene.time.dt;
  if (!(interval > 0) || scene.probes.empty())
    throw InputError(scene.file + ": a study needs probes, and frame_interval, the time between comparisons");
  if (std::abs(steps - std::round(steps)) > 1e-6 * steps || std::round(steps) < 1)
    throw InputError(
        fmt::format("{}: frame_interval is {:g} s, no multiple of dt, {:g} s", scene.file, interval, scene.time.dt));
}

}  // namespace

double StudyRun::work() const { return factor_flops + flops_per_hessian * hessian_points; }

double study_error(const StudyRun& run, const StudyRun& reference) {
  if (!run.failure.empty()) return std::numeric_limits<double>::infinity();
  if (run.x.size() != reference.x.size() || run.x.empty() || run.x[0].cols() != reference.x[0].cols())
    throw std::logic_error("study_error: runs of other times or probes");
  if ((run.x[0] - reference.x[0]).cwiseAbs().maxCoeff() > 1e-6 * reference.x[0].cwiseAbs().maxCoeff())
    throw std::logic_error("study_error: the meshes have no vertices at the same probes");
  double error = 0, size = 0;
  for (size_t i = 0; i < run.x.size(); ++i) {
    error += (run.x[i] - reference.x[i]).squaredNorm();
    size += (reference.x[i] - reference.x[0]).squaredNorm();
  }
  return std::sqrt(error / size);
}

StudyRun StudyRunner::run(const std::string& scene, const std::vector<std::string>& changes) {
  SceneText text(scene_file(scene));
  const Place place{scene, 0, 0};
  for (const std::string& change : changes) {
    const auto [path, value] = read_change(change, place);
    text.set(path, *value.get("value"), place);
  }
  const Scene read = text.read();
  check_times(read);
  set_threads(1);
  if (folder_.empty()) return run_now(read);
  const fs::path file = fs::path(folder_) / "runs" / (content_hash(text.text()) + ".json");
  StudyRun out;
  if (!again_ && read_run(file, out)) return out;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);  // where it cannot be made, writing says so
  out = run_now(read);
  write_file(file.string(), text_of(out));
  return out;
}

}  // namespace ergon

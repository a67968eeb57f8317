#include "tools/batch_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "codegen/hash.h"
#include "scenes/scene_keys.h"
#include "scenes/scene_reader.h"
#include "scenes/scene_text.h"
#include "scenes/summary.h"

namespace ergon {
namespace fs = std::filesystem;
namespace {

constexpr size_t most_jobs = 100000;  // a grid that makes more is taken for a mistake

struct SweepList : Located {
  std::vector<std::pair<std::string, const toml::node*>> values;
};

struct Sweep : Located {
  std::string scene, folder;
  int jobs = 0;
  int threads = 1;
  bool verify = false;
  std::vector<std::string> measures;
  std::vector<Place> measure_places;
  std::vector<std::pair<std::string, const toml::array*>> grid;
  std::vector<SweepList> list;
};

Key<Sweep> measures_key() {
  Key<Sweep> key;
  key.text = {"measures", "strings", "1", "", "none", "columns of the table: paths into a job's summary.json"};
  key.read = [](const toml::node& node, const std::string& file, Sweep& out) {
    const toml::array* array = node.as_array();
    if (array == nullptr)
      throw SourceError(place_of(node.source(), file),
                        fmt::format("'measures' must be an array of strings, found {}", describe(node)));
    for (const toml::node& item : *array) {
      out.measures.push_back(read_text(item, {"measures", "1", {}}, file));
      out.measure_places.push_back(place_of(item.source(), file));
    }
  };
  return key;
}

Key<Sweep> grid_key() {
  Key<Sweep> key;
  key.text = {"grid", "table", "1", "", "none", "arrays of values of which every combination is run"};
  key.read = [](const toml::node& node, const std::string& file, Sweep& out) {
    const toml::table* table = node.as_table();
    if (table == nullptr)
      throw SourceError(place_of(node.source(), file), fmt::format("'grid' must be a table, found {}", describe(node)));
    for (const auto& [place, entry] : in_order_of_text(*table)) {
      const toml::array* values = entry.second.as_array();
      if (values == nullptr || values->empty())
        throw SourceError(place_of(entry.second.source(), file),
                          fmt::format("'{}' must be an array of values to run, found {}", entry.first.str(),
                                      values == nullptr ? describe(entry.second) : "an empty one"));
      out.grid.emplace_back(std::string(entry.first.str()), values);
    }
  };
  return key;
}

Section<SweepList> list_section() {
  Section<SweepList> out{"[[list]]", "Values that are run together.", {}, {}, {}};
  out.other = [](const toml::key& key, const toml::node& node, const std::string&, SweepList& list) {
    list.values.emplace_back(std::string(key.str()), &node);
  };
  return out;
}

Section<Sweep> sweep_section() {
  using T = Sweep;
  Section<T> out{"the sweep", "Top level of the file.", {}, {}, {}};
  constexpr Range at_least_one{1, std::numeric_limits<double>::infinity(), false, true};
  out.keys = {text_key("scene", &T::scene, Need::required,
                       "the scene file, relative to this one; * in its name stands for any text"),
              text_key("folder", &T::folder, Need::optional, "of all results, relative to the working directory"),
              integer_key("jobs", &T::jobs, at_least_one, Need::optional, "at once"),
              integer_key("threads", &T::threads, at_least_one, Need::optional, "of each job"),
              boolean_key("verify", &T::verify, "every step is tested for intersections"),
              measures_key(),
              grid_key(),
              tables_key("list", &T::list, list_section, Need::optional, "values that are run together")};
  return out;
}

using Change = std::pair<std::string, const toml::node*>;

// Every combination of the grid with every table of the list.
std::vector<std::vector<Change>> combinations(const Sweep& sweep, const std::string& file) {
  std::vector<std::vector<Change>> out(1);
  const auto multiply = [&](const std::vector<std::vector<Change>>& by) {
    std::vector<std::vector<Change>> product;
    if (out.size() * by.size() > most_jobs)
      throw SourceError(Place{file, 1, 1}, fmt::format("this makes more than {} jobs", most_jobs));
    for (const auto& one : out) {
      for (const auto& other : by) {
        product.push_back(one);
        product.back().insert(product.back().end(), other.begin(), other.end());
      }
    }
    out = std::move(product);
  };
  for (const auto& [key, values] : sweep.grid) {
    std::vector<std::vector<Change>> by;
    for (const toml::node& value : *values) by.push_back({{key, &value}});
    multiply(by);
  }
  std::vector<std::vector<Change>> by;
  for (const SweepList& list : sweep.list) by.push_back(list.values);
  if (!by.empty()) multiply(by);
  return out;
}

// Those that `scene` names, in the order of their names.
std::vector<std::string> scene_files(const Sweep& sweep, const std::string& file) {
  const fs::path path = (fs::path(file).parent_path() / sweep.scene).lexically_normal();
  const std::string pattern = path.filename().string();
  const size_t star = pattern.find('*');
  if (star == std::string::npos) return {path.string()};
  const std::string start = pattern.substr(0, star), end = pattern.substr(star + 1);
  std::vector<std::string> out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path.has_parent_path() ? path.parent_path() : ".", error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() >= start.size() + end.size() && name.starts_with(start) && name.ends_with(end))
      out.push_back((path.parent_path() / name).string());
  }
  if (out.empty()) throw SourceError(sweep.at("scene"), fmt::format("no file is named like {}", path.string()));
  std::sort(out.begin(), out.end());
  return out;
}

std::string text_of_value(const toml::node& value) {
  std::ostringstream out;
  if (const auto text = value.value<std::string>()) return *text;
  value.visit([&](const auto& node) { out << node; });
  return out.str();
}

// Names of their own for the files that any job's scene names.
void add_inputs(const SceneText& scene, std::vector<std::pair<std::string, std::string>>& inputs) {
  for (const std::string& file : scene.files()) {
    const auto known = [&](const auto& input) { return input.first == file; };
    if (std::any_of(inputs.begin(), inputs.end(), known)) continue;
    const fs::path path(file);
    std::string name = path.filename().string();
    const auto taken = [&](const auto& input) { return input.second == name; };
    for (int n = 2; std::any_of(inputs.begin(), inputs.end(), taken); ++n)
      name = fmt::format("{}_{}{}", path.stem().string(), n, path.extension().string());
    inputs.emplace_back(file, name);
  }
}

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return in ? text.str() : "";  // the run of the job says that it cannot be read
}

// A measure must be a number that a summary has.
void check_measures(const Sweep& sweep, const Scene& scene) {
  RunSummary summary;
  for (const SceneProbe& probe : scene.probes) summary.probes.push_back({probe.name, {}});
  const nlohmann::json all = nlohmann::json::parse(to_json(summary)).flatten();
  std::vector<std::string> names;
  for (const auto& [pointer, value] : all.items()) {
    std::string name = pointer.substr(1);
    std::replace(name.begin(), name.end(), '/', '.');
    if (!value.is_string()) names.push_back(name);
  }
  for (size_t i = 0; i < sweep.measures.size(); ++i) {
    const std::string& measure = sweep.measures[i];
    if (std::find(names.begin(), names.end(), measure) == names.end())
      throw SourceError(sweep.measure_places[i],
                        fmt::format("there is no measure '{}'{}; a job's summary.json has: {}", measure,
                                    did_you_mean(measure, names), fmt::join(names, ", ")));
  }
}

}  // namespace

BatchPlan read_batch(const std::string& file) {
  const toml::table table = parse_scene(read_scene_file_text(file), file);
  Sweep sweep;
  read_section(table, sweep_section(), file, sweep);

  BatchPlan plan;
  plan.folder = sweep.folder.empty() ? (fs::path("out") / fs::path(file).stem()).string() : sweep.folder;
  plan.at_once = sweep.jobs;
  plan.threads = sweep.threads;
  plan.measures = sweep.measures;
  plan.verify = sweep.verify;
  const std::vector<std::string> files = scene_files(sweep, file);
  const auto changes = combinations(sweep, file);
  if (files.size() > 1) plan.keys.emplace_back("scene");

  std::vector<SceneText> scenes;
  for (const std::string& scene_file : files) {
    for (const auto& values : changes) {
      scenes.emplace_back(scene_file);
      BatchJob job;
      job.name = fmt::format("{:04}", plan.jobs.size());
      if (files.size() > 1) job.values.emplace_back("scene", fs::path(scene_file).stem().string());
      for (const auto& [key, value] : values) {
        scenes.back().set(key, *value, place_of(value->source(), file));
        job.values.emplace_back(key, text_of_value(*value));
        if (std::find(plan.keys.begin(), plan.keys.end(), key) == plan.keys.end()) plan.keys.push_back(key);
      }
      add_inputs(scenes.back(), plan.inputs);
      plan.jobs.push_back(std::move(job));
    }
  }

  std::vector<std::pair<std::string, std::string>> renamed = plan.inputs;
  for (auto& [path, name] : renamed) name = "../inputs/" + name;
  std::string contents;
  for (const auto& [path, name] : plan.inputs) contents += name + "\n" + content_of(path);
  for (size_t i = 0; i < plan.jobs.size(); ++i) {
    BatchJob& job = plan.jobs[i];
    scenes[i].rename_files(renamed);
    job.scene = scenes[i].text();
    job.fingerprint = content_hash(job.scene + contents + (plan.verify ? "verify" : ""));
    const std::string as_job = (fs::path(plan.folder) / job.name / "scene.toml").string();
    try {
      check_measures(sweep, read_scene_text(job.scene, as_job));
    } catch (const SourceError& bad) {
      if (bad.place().file == file) throw;
      std::string values;
      for (const auto& [key, value] : job.values)
        values += fmt::format("{}{} = {}", values.empty() ? "" : ", ", key, value);
      throw SourceError(sweep.place, fmt::format("job {} ({}): {}", job.name, values, bad.what()));
    }
  }
  return plan;
}

}  // namespace ergon

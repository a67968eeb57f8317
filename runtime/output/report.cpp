#include "runtime/output/report.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "runtime/error.h"

namespace ergon {
namespace {

nlohmann::ordered_json object_of(const std::vector<std::pair<std::string, double>>& numbers) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const auto& [name, number] : numbers) object[name] = number;
  return object;
}

}  // namespace

std::string to_json(const ReportRecord& record) {
  nlohmann::ordered_json skipped = nlohmann::ordered_json::array();
  for (const SkippedPart& part : record.skipped) skipped.push_back({{"part", part.part}, {"reason", part.reason}});
  nlohmann::ordered_json json;
  json["step"] = record.step;
  json["time"] = record.time;
  json["dt"] = record.dt;
  json["converged"] = record.converged;
  json["newton_iterations"] = record.newton_iterations;
  json["linear_iterations"] = record.linear_iterations;
  json["residual"] = record.residual;
  json["energy"] = object_of(record.energies);
  if (!record.budget.empty()) json["budget"] = object_of(record.budget);
  for (const auto& [name, p] : record.momentum) json["momentum"][name] = p;
  json["seconds"] = object_of(record.times);
  json["skipped"] = skipped;
  json["smallest_gap"] = record.smallest_gap ? nlohmann::ordered_json(*record.smallest_gap) : nlohmann::ordered_json();
  json["contacts"] = record.contacts;
  for (const ObjectForces& sum : record.forces) {
    json["forces"][sum.object] = {{"contact", sum.contact}, {"friction", sum.friction}};
  }
  for (const auto& [name, x] : record.probes) json["probes"][name] = x;
  for (const auto& [name, number] : record.more) json[name] = number;
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

Report::Report(std::string path, bool go_on) : path_(std::move(path)) {
  descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | (go_on ? 0 : O_TRUNC), 0666);
  if (descriptor_ < 0) {
    throw OutputError(fmt::format("{}: cannot be opened for writing: {}", path_, std::strerror(errno)));
  }
}

Report::~Report() { close(descriptor_); }

void Report::append_line(const std::string& json) {
  const std::string line = json + "\n";
  struct stat before;
  const bool regular = fstat(descriptor_, &before) == 0 && S_ISREG(before.st_mode);
  for (size_t done = 0; done < line.size();) {
    const ssize_t count = write(descriptor_, line.data() + done, line.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int reason = errno;
      const bool taken_back = !regular || done == 0 || ftruncate(descriptor_, before.st_size) == 0;
      throw OutputError(fmt::format("{}: cannot be written: {}{}", path_, std::strerror(reason),
                                    taken_back ? "" : "; its last line is incomplete"));
    }
    done += static_cast<size_t>(count);
  }
}

}  // namespace ergon

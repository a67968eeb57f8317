#pragma once
// What a command with --json prints: one object a line.

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace ergon {

inline std::vector<nlohmann::ordered_json> json_lines(const std::string& text) {
  std::vector<nlohmann::ordered_json> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) all.push_back(nlohmann::ordered_json::parse(line));
  return all;
}

}  // namespace ergon

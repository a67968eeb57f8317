#include "symbolic/diagnostic.h"

#include <algorithm>
#include <cctype>

namespace ergon {

std::string to_string(const Place& place) {
  if (place.line == 0) return place.file;
  const std::string line = place.file + ":" + std::to_string(place.line);
  return place.column == 0 ? line : line + ":" + std::to_string(place.column);
}

SourceError::SourceError(const Place& place, const std::string& message)
    : std::runtime_error(to_string(place) + ": " + message), place_(place) {}

namespace {

constexpr int edit = 2;  // a change of case costs half an edit

int change_cost(char a, char b) {
  if (a == b) return 0;
  const bool same_letter = std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  return same_letter ? edit / 2 : edit;
}

int distance(std::string_view a, std::string_view b) {
  const size_t width = b.size() + 1;
  std::vector<int> d((a.size() + 1) * width);
  auto at = [&](size_t i, size_t j) -> int& { return d[i * width + j]; };
  for (size_t i = 0; i <= a.size(); ++i) at(i, 0) = edit * static_cast<int>(i);
  for (size_t j = 0; j <= b.size(); ++j) at(0, j) = edit * static_cast<int>(j);
  for (size_t i = 1; i <= a.size(); ++i) {
    for (size_t j = 1; j <= b.size(); ++j) {
      int best = at(i - 1, j - 1) + change_cost(a[i - 1], b[j - 1]);
      best = std::min({best, at(i - 1, j) + edit, at(i, j - 1) + edit});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        best = std::min(best, at(i - 2, j - 2) + edit);
      at(i, j) = best;
    }
  }
  return at(a.size(), b.size());
}

}  // namespace

std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates) {
  const int length = static_cast<int>(word.size());
  // A third of the letters may be wrong, but never all of them.
  int best = std::min(edit * std::max(1, length / 3), edit * length - 1) + 1;
  std::string nearest;
  for (const std::string& candidate : candidates) {
    const int d = distance(word, candidate);
    if (d >= best || d >= edit * static_cast<int>(candidate.size())) continue;
    best = d;
    nearest = candidate;
  }
  return nearest;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_name(word, candidates);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

}  // namespace ergon

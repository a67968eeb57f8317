#pragma once
// Errors that point into a text file, and the nearest-name suggestion they end with.

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ergon {

// A position in a source text. Lines and columns count from 1; 0 is the file, or the line, as a whole.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

// "file:line:column", "file:line" where the column is 0, "file" where the line is.
std::string to_string(const Place& place);

// Bad input at a known place. what() is "file:line:column: message".
class SourceError : public std::runtime_error {
 public:
  SourceError(const Place& place, const std::string& message);
  const Place& place() const { return place_; }

 private:
  Place place_;
};

// The candidate closest to `word` by edit distance (transpositions count once), or "" when none is near enough
// to be a likely typo.
std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);

// "; did you mean 'x'?" for the nearest candidate, or "".
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace ergon

#pragma once
// The words and binary numbers of a .msh file, one after the other. Whatever is not as asked for is an InputError with
// the line, in text.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/error.h"

namespace ergon {

class MshWords {
 public:
  // `data` is not copied.
  MshWords(std::string_view data, std::string path) : rest_(data), path_(std::move(path)) {}

 protected:
  [[noreturn]] void fail(const std::string& message) const {
    // Lines do not count in binary data.
    throw InputError(binary_ ? fmt::format("{}: {}", path_, message) : fmt::format("{}:{}: {}", path_, line_, message));
  }

  std::optional<std::string_view> next_word() {
    size_t start = 0;
    for (; start < rest_.size() && std::strchr(" \t\r\n", rest_[start]); ++start) line_ += rest_[start] == '\n';
    if (start == rest_.size()) return std::nullopt;
    const size_t end = std::min(rest_.find_first_of(" \t\r\n", start), rest_.size());
    const std::string_view word = rest_.substr(start, end - start);
    rest_.remove_prefix(end);
    return word;
  }

  std::string_view word(const char* what) {
    const auto next = next_word();
    if (!next) fail(fmt::format("the file ends before {}", what));
    return *next;
  }

  void expect(std::string_view wanted) {
    const std::string_view found = word(std::string(wanted).c_str());
    if (found != wanted) fail(fmt::format("expected '{}', found '{}'", wanted, found));
  }

  template <class Number>
  Number binary_number(const char* what) {
    Number value;
    if (rest_.size() < sizeof value) fail(fmt::format("the file ends before {}", what));
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }

  // A whole number that is binary data of the type Stored, or a word.
  template <class Stored>
  long long whole(const char* what, bool as_text = false) {
    if (binary_ && !as_text) return static_cast<long long>(binary_number<Stored>(what));
    const std::string_view text = word(what);
    long long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      fail(fmt::format("{} is '{}', which is not a whole number", what, text));
    }
    return value;
  }

  template <class Stored>
  long long count(const char* what, bool as_text = false) {
    const long long value = whole<Stored>(what, as_text);
    if (value < 0) fail(fmt::format("{} is {}; it must not be negative", what, value));
    return value;
  }

  double number(const char* what) {
    if (binary_) return binary_number<double>(what);
    const std::string_view text = word(what);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      fail(fmt::format("{} is '{}', which is not a number", what, text));
    }
    return value;
  }

  // Binary data starts right behind the end of a line.
  void end_line() {
    if (!binary_) return;
    const size_t end = rest_.find('\n');
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  }

  void skip_section(std::string_view name) {
    const std::string end = "$End" + std::string(name.substr(1));
    const size_t at = rest_.find(end);
    if (at == std::string_view::npos) fail(fmt::format("the section {} has no {}", name, end));
    line_ += static_cast<int>(std::count(rest_.begin(), rest_.begin() + static_cast<long>(at), '\n'));
    rest_.remove_prefix(at + end.size());
  }

  std::string_view rest_;
  std::string path_;
  int line_ = 1;
  bool binary_ = false;
};

}  // namespace ergon

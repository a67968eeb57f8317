#include "scenes/scene_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>
#include <sstream>

#include "scenes/scene_keys.h"

namespace ergon {
namespace fs = std::filesystem;
namespace {

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> out(1);
  for (const char c : path) {
    if (c == '.')
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

std::string name_of(const toml::node& item) {
  const toml::table* table = item.as_table();
  return table != nullptr ? (*table)["name"].value_or(std::string()) : "";
}

// One of several tables by name or number; null where there is none.
toml::node* element_of(toml::array& array, const std::string& word) {
  for (toml::node& item : array)
    if (name_of(item) == word) return &item;
  size_t index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  if (error != std::errc() || end != word.data() + word.size() || index >= array.size()) return nullptr;
  return array.get(index);
}

[[noreturn]] void refuse(const std::string& path, const std::string& word, const toml::array& array,
                         const Place& place) {
  std::vector<std::string> names;
  for (const toml::node& item : array)
    if (const std::string name = name_of(item); !name.empty()) names.push_back(name);
  const std::string numbers = fmt::format("a number from 0 to {}", array.size() - 1);
  throw SourceError(place, fmt::format("'{}': there is no '{}' here; give {}{}{}", path, word, numbers,
                                       names.empty() ? "" : fmt::format(" or a name: {}", fmt::join(names, ", ")),
                                       did_you_mean(word, names)));
}

// Where the keys of a scene that name files stand; laws only where they end in .energy.
struct FileKey {
  std::vector<const char*> path;  // of tables or arrays of tables, then the key
  bool is_law;
};
const FileKey file_keys[] = {
    {{"object", "mesh"}, false},         {{"obstacle", "mesh"}, false}, {{"obstacle", "shape", "mesh"}, false},
    {{"object", "energy", "law"}, true}, {{"attachment", "law"}, true}, {{"contact", "barrier"}, true}};

void visit(toml::node& node, const FileKey& key, size_t depth, const std::function<void(toml::node&)>& call) {
  if (toml::array* array = node.as_array()) {
    for (toml::node& item : *array) visit(item, key, depth, call);
    return;
  }
  if (depth == key.path.size()) {
    const auto text = node.value<std::string>();
    if (text && (!key.is_law || text->ends_with(".energy"))) call(node);
    return;
  }
  toml::table* table = node.as_table();
  if (table == nullptr) return;
  if (toml::node* inner = table->get(key.path[depth])) visit(*inner, key, depth + 1, call);
}

}  // namespace

SceneText::SceneText(const std::string& file) : file_(file), folder_(fs::path(file).parent_path().string()) {
  table_ = parse_scene(read_scene_file_text(file), file);
}

void SceneText::set(const std::string& path, const toml::node& value, const Place& place) {
  const std::vector<std::string> words = split(path);
  toml::node* at = &table_;
  for (size_t i = 0; i < words.size(); ++i) {
    const bool last = i + 1 == words.size();
    if (words[i].empty()) throw SourceError(place, fmt::format("'{}' is not a path of keys joined by dots", path));
    if (toml::array* array = at->as_array()) {
      if (array->empty() || !array->is_array_of_tables() || last)
        throw SourceError(place, fmt::format("'{}': '{}' is not in a table; a path ends at a key", path, words[i]));
      toml::node* element = element_of(*array, words[i]);
      if (element == nullptr) refuse(path, words[i], *array, place);
      at = element;
      continue;
    }
    toml::table* table = at->as_table();
    if (table == nullptr)
      throw SourceError(place, fmt::format("'{}': there is a value before '{}', not a table", path, words[i]));
    if (last) {
      table->insert_or_assign(words[i], value);
      return;
    }
    if (table->get(words[i]) == nullptr) table->insert(words[i], toml::table{});
    at = table->get(words[i]);
  }
}

template <class F>
void SceneText::for_each_file(F f) {
  for (const FileKey& key : file_keys) visit(table_, key, 0, f);
}

std::vector<std::string> SceneText::files() const {
  std::vector<std::string> out;
  SceneText copy = *this;
  copy.for_each_file([&](toml::node& node) {
    const std::string path = (fs::path(folder_) / *node.value<std::string>()).lexically_normal().string();
    if (std::find(out.begin(), out.end(), path) == out.end()) out.push_back(path);
  });
  return out;
}

void SceneText::rename_files(const std::vector<std::pair<std::string, std::string>>& to) {
  for_each_file([&](toml::node& node) {
    const std::string path = (fs::path(folder_) / *node.value<std::string>()).lexically_normal().string();
    for (const auto& [from, name] : to)
      if (from == path) *node.as_string() = name;
  });
}

std::string SceneText::text() const {
  std::ostringstream out;
  out << toml::toml_formatter(table_, toml::toml_formatter::default_flags & ~toml::format_flags::allow_literal_strings);
  return out.str() + "\n";
}

Scene SceneText::read() const {
  Scene scene;
  scene.file = file_;
  read_section(table_, scene_section(), file_, scene);
  return scene;
}

std::pair<std::string, toml::table> read_change(const std::string& text, const Place& place) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw SourceError(place, fmt::format("'{}' is not PATH=VALUE, as time.dt=0.01", text));
  const std::string path = text.substr(0, equals), value = text.substr(equals + 1);
  try {
    return {path, toml::parse("value = " + value)};
  } catch (const toml::parse_error&) {
    return {path, toml::table{{"value", value}}};
  }
}

}  // namespace ergon

#pragma once
// Enough of XML to tell whether a text is well formed.

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace ergon::test {

// What is wrong with the text as XML, or "": tags that do not match, attributes without quotes or given twice, a bare
// '&' or '<', more than one root.
inline std::string fault_of_xml(const std::string& text) {
  std::vector<std::string> open;
  int roots = 0;
  auto bad_entity = [&](size_t from, size_t to) {
    for (size_t at = text.find('&', from); at < to; at = text.find('&', at + 1)) {
      const size_t end = text.find(';', at);
      if (end > std::min(to, at + 10)) return true;
    }
    return false;
  };
  for (size_t at = 0; at < text.size();) {
    const size_t tag = std::min(text.find('<', at), text.size());
    if (bad_entity(at, tag)) return "a bare '&' in '" + text.substr(at, tag - at) + "'";
    if (open.empty() && text.find_first_not_of(" \t\r\n", at) < tag) return "text outside of the root";
    if (tag == text.size()) break;
    if (text.compare(tag, 2, "<!") == 0) {
      at = text.find('>', tag) + 1;
      continue;
    }
    size_t i = tag + 1;
    const bool closing = text[i] == '/';
    if (closing) ++i;
    const size_t name_start = i;
    while (i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '-' || text[i] == ':'))
      ++i;
    const std::string name = text.substr(name_start, i - name_start);
    if (name.empty()) return "a bare '<' at " + text.substr(tag, 30);
    std::vector<std::string> attributes;
    for (;;) {
      i = text.find_first_not_of(" \t\r\n", i);
      if (i == std::string::npos) return "the tag " + name + " has no end";
      if (text[i] == '>' || text[i] == '/') break;
      const size_t equals = text.find('=', i);
      if (equals == std::string::npos || equals + 1 >= text.size() || text[equals + 1] != '"')
        return "an attribute without quotes in " + name + ": " + text.substr(i, 30);
      const std::string attribute = text.substr(i, equals - i);
      if (std::find(attributes.begin(), attributes.end(), attribute) != attributes.end())
        return "twice the attribute " + attribute + " in " + name;
      attributes.push_back(attribute);
      const size_t end = text.find('"', equals + 2);
      if (end == std::string::npos) return "an attribute of " + name + " has no end";
      if (text.substr(equals, end - equals).find('<') != std::string::npos || bad_entity(equals, end))
        return "a bare sign in an attribute of " + name;
      i = end + 1;
    }
    const bool alone = text[i] == '/';
    if (alone && text[i + 1] != '>') return "the tag " + name + " has no end";
    if (closing) {
      if (open.empty() || open.back() != name) return "unexpected </" + name + ">";
      open.pop_back();
    } else {
      if (open.empty() && ++roots > 1) return "a second root " + name;
      if (!alone) open.push_back(name);
    }
    at = i + (alone ? 2 : 1);
  }
  if (roots == 0) return "no root";
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

inline int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

}  // namespace ergon::test

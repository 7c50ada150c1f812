// SPDX-License-Identifier: Apache-2.0
#include "xml_scanner.h"

#include <algorithm>

#include "pellucid/scene/error.h"
#include "scene_json_document.h"

namespace pellucid {

std::optional<XmlTag> XmlScanner::next() {
  skip_to('<');
  while (rest_.starts_with("<?") || rest_.starts_with("<!")) {
    advance(find(rest_.starts_with("<!--") ? "-->" : ">") + 1);
    skip_to('<');
  }
  if (rest_.empty()) return std::nullopt;
  XmlTag tag;
  tag.line = line_;
  const std::size_t end = find(">");
  std::string_view inside = rest_.substr(1, end - 1);
  tag.closes = inside.starts_with('/');
  if (tag.closes) inside.remove_prefix(1);
  tag.closed = inside.ends_with('/');
  if (tag.closed) inside.remove_suffix(1);
  tag.name = inside.substr(0, inside.find_first_of(" \t\r\n"));
  inside.remove_prefix(tag.name.size());
  read_attributes(inside, tag);
  advance(end + 1);
  tag.text = rest_.substr(0, rest_.find('<'));
  return tag;
}

std::string XmlScanner::where(const XmlTag& tag) const {
  return name_ + ": line " + std::to_string(tag.line);
}

std::size_t XmlScanner::find(std::string_view what) const {
  const std::size_t at = rest_.find(what);
  if (at == std::string_view::npos) {
    throw Error(name_ + ": line " + std::to_string(line_) +
                ": a tag does not end; is the file complete?");
  }
  return at;
}

void XmlScanner::advance(std::size_t count) {
  for (const char c : rest_.substr(0, count)) line_ += c == '\n';
  rest_.remove_prefix(std::min(count, rest_.size()));
}

void XmlScanner::skip_to(char c) {
  advance(std::min(rest_.find(c), rest_.size()));
}

void XmlScanner::read_attributes(std::string_view inside, XmlTag& tag) const {
  for (;;) {
    const std::size_t begin = inside.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return;
    const std::size_t equals = inside.find('=', begin);
    const char quote = equals < inside.size() - 1 ? inside[equals + 1] : ' ';
    const std::size_t end = equals == std::string_view::npos || (quote != '"' && quote != '\'')
                                ? std::string_view::npos
                                : inside.find(quote, equals + 2);
    if (end == std::string_view::npos) {
      throw Error(where(tag) + ": <" + scene_json::printable(tag.name) +
                  "> has an attribute without a quoted value");
    }
    tag.attributes[inside.substr(begin, equals - begin)] =
        inside.substr(equals + 2, end - equals - 2);
    inside.remove_prefix(end + 1);
  }
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include "xml_scanner.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "pellucid/scene/error.h"
#include "printable.h"
#include "text.h"

namespace pellucid {

std::optional<XmlTag> XmlScanner::next() {
  skip_to('<');
  while (rest_.starts_with("<?") || rest_.starts_with("<!")) {
    advance(find(rest_.starts_with("<!--")        ? "-->"
                 : rest_.starts_with("<![CDATA[") ? "]]>"
                                                  : ">") +
            1);
    skip_to('<');
  }
  if (rest_.empty()) return std::nullopt;
  XmlTag tag;
  tag.line = line_;
  const std::size_t end = tag_end();
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

// A value in quotes may have a ">" in it.
std::size_t XmlScanner::tag_end() const {
  char quote = 0;
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    const char c = rest_[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '>') {
      return i;
    } else if (c == '"' || c == '\'') {
      quote = c;
    }
  }
  return find(">");
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
      throw Error(where(tag) + ": <" + printable(tag.name) +
                  "> has an attribute without a quoted value");
    }
    tag.attributes[inside.substr(begin, equals - begin)] =
        inside.substr(equals + 2, end - equals - 2);
    inside.remove_prefix(end + 1);
  }
}

std::string xml_text(std::string_view raw) {
  static constexpr std::pair<std::string_view, char> entities[] = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string text;
  while (!raw.empty()) {
    const auto entity = std::ranges::find_if(
        entities, [&](const auto& known) { return raw.starts_with(known.first); });
    const std::size_t end = raw.starts_with("&#") ? raw.find(';') : std::string_view::npos;
    if (entity != std::end(entities)) {
      text += entity->second;
      raw.remove_prefix(entity->first.size());
    } else if (end != std::string_view::npos) {
      const bool is_hex = raw.starts_with("&#x");
      unsigned code = 0;
      std::from_chars(raw.data() + (is_hex ? 3 : 2), raw.data() + end, code, is_hex ? 16 : 10);
      append_utf8(text, code);
      raw.remove_prefix(end + 1);
    } else {
      text += raw.front();
      raw.remove_prefix(1);
    }
  }
  return text;
}

}  // namespace pellucid

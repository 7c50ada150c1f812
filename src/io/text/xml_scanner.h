// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace pellucid {

/// A start or end tag, and the text behind it up to the next one.
struct XmlTag {
  std::string_view name;
  std::map<std::string_view, std::string_view> attributes;
  std::string_view text;
  bool closes = false;  ///< "</name>"
  bool closed = false;  ///< "<name/>"
  std::size_t line = 0;
};

/// Tags one after the other, without entities: what other programs write of numbers and names. The
/// text and the name (for messages) must outlive it. Throws Error where a tag does not end.
class XmlScanner {
 public:
  XmlScanner(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  std::optional<XmlTag> next();
  std::string where(const XmlTag& tag) const;

 private:
  std::size_t find(std::string_view what) const;
  std::size_t tag_end() const;
  void advance(std::size_t count);
  void skip_to(char c);
  void read_attributes(std::string_view inside, XmlTag& tag) const;

  std::string_view rest_;
  const std::string& name_;
  std::size_t line_ = 1;
};

/// Returns a value or text of XML with its entities (&amp;, &#181;) replaced.
std::string xml_text(std::string_view raw);

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
//
// OME-XML 2016-06: <OME><Image><Pixels SizeX= … SizeC= SizeT= PhysicalSizeX= PhysicalSizeXUnit= …>.
// Only the attributes of Pixels are looked for: the rest says nothing of where values stand.

#include "ome_xml.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

/// What stands between < and >, of the first element of this name, with a prefix or without.
std::string_view element(std::string_view text, std::string_view name) {
  for (std::size_t at = text.find(name); at != std::string_view::npos;
       at = text.find(name, at + 1)) {
    if (at == 0 || (text[at - 1] != '<' && text[at - 1] != ':')) continue;
    const std::string_view rest = text.substr(at + name.size());
    if (!rest.empty() && std::string_view(" \t\r\n").find(rest.front()) != std::string_view::npos) {
      return rest.substr(0, rest.find('>'));
    }
  }
  return {};
}

std::string_view attribute(std::string_view element, std::string_view key) {
  for (const char quote : {'"', '\''}) {
    const std::size_t at = element.find(std::string(key) + "=" + quote);
    if (at == std::string_view::npos || at == 0 || element[at - 1] > ' ') continue;
    const std::string_view rest = element.substr(at + key.size() + 2);
    return rest.substr(0, rest.find(quote));
  }
  return {};
}

std::optional<double> number(std::string_view word) {
  double value = 0;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || result.ec != std::errc{} || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::size_t count_of(std::string_view text, std::string_view what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string_view::npos;
       at = text.find(what, at + 1)) {
    ++count;
  }
  return count;
}

}  // namespace

bool is_ome_xml(std::string_view description) {
  return description.find("<OME") != std::string_view::npos;
}

PageSpacing read_ome_xml(std::string_view description, int samples, const std::string& name) {
  const std::string_view pixels = element(description, "Pixels");
  const auto refuse = [&](const std::string& what) {
    throw Error(name + ": an OME-TIFF of several " + what +
                " is not read; save one of them as a stack");
  };
  if (number(attribute(pixels, "SizeC")).value_or(1) > samples) refuse("channels");
  if (number(attribute(pixels, "SizeT")).value_or(1) > 1) refuse("times");
  if (count_of(description, "<Pixels") + count_of(description, ":Pixels ") > 1) refuse("images");

  PageSpacing spacing;
  const auto unit = [&](const char* key) {
    const std::string_view said = attribute(pixels, key);
    return said.empty() ? std::string("µm") : std::string(said);
  };
  const auto x = number(attribute(pixels, "PhysicalSizeX"));
  const auto y = number(attribute(pixels, "PhysicalSizeY"));
  const auto z = number(attribute(pixels, "PhysicalSizeZ"));
  if (!x || !y || unit("PhysicalSizeXUnit") != unit("PhysicalSizeYUnit")) return spacing;
  spacing.unit = unit("PhysicalSizeXUnit");
  spacing.pixels = {*x, *y};
  if (z && unit("PhysicalSizeZUnit") == spacing.unit) spacing.slices = z;
  return spacing;
}

}  // namespace pellucid

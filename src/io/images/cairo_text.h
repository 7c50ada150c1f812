// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cairo.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "text/text.h"

namespace pellucid {

template <auto destroy>
struct DestroyCairo {
  template <class T>
  void operator()(T* object) const {
    destroy(object);
  }
};
using CairoSurface = std::unique_ptr<cairo_surface_t, DestroyCairo<cairo_surface_destroy>>;
using CairoContext = std::unique_ptr<cairo_t, DestroyCairo<cairo_destroy>>;

/// Returns the text as UTF-8 that Cairo takes: other bytes become '?'.
inline std::string utf8(const std::string& text) {
  std::string made;
  for (std::string_view rest = text; !rest.empty();) {
    const auto first = static_cast<unsigned char>(rest.front());
    const std::size_t length = first < 0x20 || first == 0x7f ? 0 : utf8_length(rest);
    made += length > 0 ? rest.substr(0, length) : "?";
    rest.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return made;
}

/// Returns the text if `width_of` it is at most `most`, else its longest beginning that fits before
/// an ellipsis.
template <class WidthOf>
std::string cut_to_width(const std::string& text, double most, const WidthOf& width_of) {
  if (width_of(text) <= most) return text;
  const auto beginning = [&](std::size_t bytes) {
    while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
    return text.substr(0, bytes) + "\u2026";
  };
  // Measuring takes as long as the text is: from short beginnings to long ones.
  std::size_t fits = 0, too_long = 1;
  while (too_long < text.size() && width_of(beginning(too_long)) <= most) {
    fits = too_long;
    too_long = std::min(2 * too_long, text.size());
  }
  while (too_long - fits > 1) {
    const std::size_t middle = fits + (too_long - fits) / 2;
    (width_of(beginning(middle)) <= most ? fits : too_long) = middle;
  }
  return beginning(fits);
}

}  // namespace pellucid

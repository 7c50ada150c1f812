// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "pellucid/io/channel_source.h"
#include "pellucid/io/transfer_function_description.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/srgb.h"
#include "text/json_document.h"
#include "text/printable.h"
#include "text/text.h"

namespace pellucid {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t at = text.find(separator);
    parts.push_back(trimmed(text.substr(0, at)));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

/// Digits and a leading point would be the rest of a number that is not one, as in 1.2.3, and so
/// would a lone e. A percent sign would be a hundredth of the number.
bool is_unit(std::string_view text) {
  return text.find_first_of("0123456789,+-%") == std::string_view::npos && !text.starts_with('.') &&
         text != "e" && text != "E";
}

/// Reads one text; messages show it whole.
class GaussianReader {
 public:
  explicit GaussianReader(std::string_view text) : text_(text) {}

  GaussianPrimitive read() {
    const std::vector<std::string_view> parts = split(text_, ';');
    read_place(parts.front());
    bool has_extinction = false, has_color = false;
    gaussian_.color = {1, 1, 1};
    for (std::size_t i = 1; i < parts.size(); ++i) {
      if (parts[i].empty() && i + 1 == parts.size()) break;
      const std::string_view word = parts[i].substr(0, parts[i].find_first_of(" \t="));
      std::string_view value = trimmed(parts[i].substr(word.size()));
      if (value.starts_with('=')) value = trimmed(value.substr(1));
      if (word == "extinction" && !std::exchange(has_extinction, true)) {
        gaussian_.extinction = number(value, "the extinction", scene_json::largest_number);
        if (gaussian_.extinction < 0) fail("the extinction is negative; give 0 or more");
      } else if (word == "color" && !std::exchange(has_color, true)) {
        gaussian_.color = color(value);
      } else {
        fail("\"" + printable(parts[i]) +
             "\" is not understood; behind the centre stand \"extinction NUMBER\" and \"color "
             "#RRGGBB\", each once");
      }
    }
    if (!has_extinction) {
      fail("it has no extinction; give it, per world length, as in \"; extinction 0.5\"");
    }
    return gaussian_;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error("Gaussian \"" + printable(text_) + "\": " + what);
  }

  double number(std::string_view text, const std::string& what, double largest) const {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double value = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    const auto used = static_cast<std::size_t>(result.ptr - text.data());
    if (result.ec != std::errc() || !is_unit(text.substr(used)) || !(std::abs(value) <= largest)) {
      fail(what + " is \"" + printable(text) + "\", but must be a number up to " +
           (largest == scene_json::largest_number ? "1e30" : "2.1e37"));
    }
    return value;
  }

  /// Reads "CHANNEL=CENTER~WIDTH" or "CENTER~WIDTH".
  void read_axis(std::string_view text) {
    const std::size_t equals = text.find('=');
    std::string name;
    if (equals != std::string_view::npos) {
      name = trimmed(text.substr(0, equals));
      if (!is_channel_name(name)) fail("\"" + printable(name) + "\" is no name of a channel");
      text = trimmed(text.substr(equals + 1));
    }
    constexpr std::string_view plus_minus = "\xc2\xb1";
    std::size_t sign = text.find('~'), length = 1;
    if (sign == std::string_view::npos) {
      sign = text.find(plus_minus);
      length = plus_minus.size();
    }
    if (sign == std::string_view::npos) {
      fail("\"" + printable(text) + "\" has no width; give CENTER~WIDTH, as in 80~10");
    }
    gaussian_.center.push_back(
        number(trimmed(text.substr(0, sign)), "a centre", scene_json::largest_value));
    const double width =
        number(trimmed(text.substr(sign + length)), "a width", scene_json::largest_value);
    if (!(width >= smallest_width)) fail("a width is not positive; it is the distance to 1/e");
    widths_.widths.push_back(width);
    if (!name.empty()) gaussian_.channels.emplace_back(std::move(name));
  }

  void read_place(std::string_view text) {
    for (const std::string_view part : split(text, ',')) read_axis(part);
    const std::vector<ChannelRef>& names = gaussian_.channels;
    if (!names.empty() && names.size() != gaussian_.center.size()) {
      fail("some centres have a channel and some have none; name all or none");
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (names[i] == names[j])
          fail("channel \"" + printable(names[i].name()) + "\" stands twice");
      }
    }
    gaussian_.shape = std::move(widths_);
  }

  Rgb<double> color(std::string_view text) const {
    if (text.starts_with('#') && text.size() == 7) {
      std::uint32_t rgb = 0;
      const char* const end = text.data() + text.size();
      const auto result = std::from_chars(text.data() + 1, end, rgb, 16);
      if (result.ec == std::errc() && result.ptr == end) {
        const auto part = [&](int shift) { return srgb_to_linear((rgb >> shift & 0xff) / 255.0); };
        return {part(16), part(8), part(0)};
      }
    }
    const std::vector<std::string_view> parts = split(text, ',');
    if (parts.size() != 3) {
      fail("the color is \"" + printable(text) +
           "\", but must be #RRGGBB in sRGB, as #ffcc99, or linear R,G,B");
    }
    std::array<double, 3> rgb{};
    for (std::size_t i = 0; i < 3; ++i) {
      rgb[i] = number(parts[i], "a part of the color", scene_json::largest_number);
      if (rgb[i] < 0) fail("a part of the color is negative; give 0 or more");
    }
    return {rgb[0], rgb[1], rgb[2]};
  }

  std::string_view text_;
  GaussianPrimitive gaussian_;
  GaussianWidths widths_;
};

}  // namespace

GaussianPrimitive parse_gaussian(std::string_view text) {
  return GaussianReader(text).read();
}

}  // namespace pellucid

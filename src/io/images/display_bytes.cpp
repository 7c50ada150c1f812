// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/display_bytes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "pellucid/scene/srgb.h"

namespace pellucid {

namespace {

/// Clamps to [0, 1]; NaN becomes 0.
double in_unit_range(double x) {
  return x > 0 ? std::min(x, 1.0) : 0;
}

/// Rounds the sRGB signal of linear light in [0, 1] to 8 bits.
int rounded_signal(double linear) {
  return static_cast<int>(std::lround(255 * linear_to_srgb(linear)));
}

/// Rounds sRGB signals by a search in the 255 places where the rounded signal grows. Some ten times
/// faster than the power that it is made from, with the same result.
class SignalTable {
 public:
  SignalTable() {
    for (int code = 1; code < 256; ++code) {
      double below = 0, above = 1;
      for (double middle = 0.5; below < middle && middle < above; middle = (below + above) / 2) {
        (rounded_signal(middle) < code ? below : above) = middle;
      }
      first_[static_cast<std::size_t>(code)] = above;
    }
    for (int i = 0; i <= bins; ++i) {
      start_[static_cast<std::size_t>(i)] =
          static_cast<std::uint8_t>(rounded_signal(i * 1.0 / bins));
    }
  }

  std::uint8_t operator()(double linear) const {
    const double x = in_unit_range(linear);
    std::uint8_t code = start_[static_cast<std::size_t>(x * bins)];
    while (code < 255 && x >= first_[code + 1U]) ++code;
    return code;
  }

 private:
  static constexpr int bins = 4096;
  std::array<double, 256> first_{};  ///< the least light of each code; of 0 not used
  std::array<std::uint8_t, bins + 1> start_{};
};

const SignalTable& signal_table() {
  static const SignalTable table;
  return table;
}

/// Returns the bytes of an Image or an ImageView.
template <class Picture>
std::vector<std::uint8_t> bytes_of(const Picture& image, const Background& background,
                                   DisplayLayout layout, int stride) {
  const SignalTable& signal = signal_table();
  const std::size_t channels = layout == DisplayLayout::rgba ? 4 : 3;
  const auto count = [stride](int size) {
    return static_cast<std::size_t>((size + stride - 1) / stride);
  };
  std::vector<std::uint8_t> bytes(count(image.width) * count(image.height) * channels, 255);
  std::uint8_t* out = bytes.data();
  for (int row = 0; row < image.height; row += stride) {
    const Rgb<double> behind = background.at_row(row, image.height);
    for (int column = 0; column < image.width; column += stride, out += channels) {
      const std::array<float, 4>& pixel = image.at(column, row);
      const double transparency = 1 - in_unit_range(static_cast<double>(pixel[3]));
      out[0] = signal(static_cast<double>(pixel[0]) + transparency * behind.r);
      out[1] = signal(static_cast<double>(pixel[1]) + transparency * behind.g);
      out[2] = signal(static_cast<double>(pixel[2]) + transparency * behind.b);
    }
  }
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> display_bytes(const Image& image, const Background& background,
                                        DisplayLayout layout) {
  return bytes_of(image, background, layout, 1);
}

std::vector<std::uint8_t> display_bytes(const ImageView& image, const Background& background,
                                        DisplayLayout layout, int stride) {
  return bytes_of(image, background, layout, stride);
}

std::vector<std::uint8_t> transparent_display_bytes(const Image& image) {
  const SignalTable& signal = signal_table();
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * 4);
  for (const std::array<float, 4>& pixel : image.pixels) {
    const double alpha = in_unit_range(static_cast<double>(pixel[3]));
    for (std::size_t c = 0; c < 3; ++c) {
      bytes.push_back(alpha > 0 ? signal(static_cast<double>(pixel[c]) / alpha) : std::uint8_t{0});
    }
    bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * alpha)));
  }
  return bytes;
}

std::vector<std::uint8_t> to_srgb8(const Image& image,
                                   const std::optional<Background>& background) {
  return background ? display_bytes(image, *background) : transparent_display_bytes(image);
}

}  // namespace pellucid

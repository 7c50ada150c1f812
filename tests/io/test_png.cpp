// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/image_files.h"
#include "pellucid/scene/error.h"
#include "scratch_folder.h"

namespace pellucid::test_png {
namespace {

using test::contains;
using test::error_of;

// The whole file as libpng sees it, nothing converted.
struct Decoded {
  unsigned width = 0, height = 0;
  int bit_depth = 0, channels = 0, srgb_intent = -1;
  std::vector<std::uint8_t> bytes;
  std::map<std::string, std::string> text;
};

Decoded decode(const std::filesystem::path& path) {
  Decoded result;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  result.width = png_get_image_width(png, info);
  result.height = png_get_image_height(png, info);
  result.bit_depth = png_get_bit_depth(png, info);
  result.channels = png_get_channels(png, info);
  png_get_sRGB(png, info, &result.srgb_intent);
  const png_bytepp rows = png_get_rows(png, info);
  for (unsigned y = 0; y < result.height; ++y) {
    result.bytes.insert(result.bytes.end(), rows[y],
                        rows[y] + result.width * static_cast<unsigned>(result.channels));
  }
  png_textp text = nullptr;
  const int texts = png_get_text(png, info, &text, nullptr);
  for (int i = 0; i < texts; ++i) result.text[text[i].key] = text[i].text;
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(file);
  return result;
}

Image image_of(int width, int height, std::vector<std::array<float, 4>> pixels) {
  Image image;
  image.width = width;
  image.height = height;
  image.pixels = std::move(pixels);
  return image;
}

class PngTest : public test::ScratchFolder {
 protected:
  std::vector<int> bytes(const Image& image,
                         const std::optional<Rgb<double>>& background = std::nullopt) {
    write_png(image, path("a.png"), background);
    const Decoded decoded = decode(path("a.png"));
    EXPECT_EQ(decoded.width, static_cast<unsigned>(image.width));
    EXPECT_EQ(decoded.height, static_cast<unsigned>(image.height));
    EXPECT_EQ(decoded.bit_depth, 8);
    EXPECT_EQ(decoded.channels, background ? 3 : 4);
    EXPECT_EQ(decoded.srgb_intent, PNG_sRGB_INTENT_RELATIVE);
    return {decoded.bytes.begin(), decoded.bytes.end()};
  }
};

// The signal values of linear 0.5 and 0.214041 (sRGB 0.5) are well known: 188 and 128 (127.5).
TEST_F(PngTest, KnownPixels) {
  EXPECT_EQ(bytes(image_of(
                2, 2, {{0, 0, 0, 1}, {1, 0.5F, 0.21586F, 1}, {0.25F, 0, 0, 0.5F}, {0, 0, 0, 0}})),
            (std::vector<int>{0, 0, 0, 255, 255, 188, 128, 255, 188, 0, 0, 128, 0, 0, 0, 0}));
}

TEST_F(PngTest, RowZeroIsAtTheTop) {
  Image image = image_of(1, 3, {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}});
  EXPECT_EQ(bytes(image), (std::vector<int>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255}));
}

// Every 8-bit signal decoded by the definition in IEC 61966-2-1 must come back as itself.
TEST_F(PngTest, EverySignalComesBack) {
  std::vector<std::array<float, 4>> pixels;
  for (int i = 0; i < 256; ++i) {
    const double s = i / 255.0;
    const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    pixels.push_back({static_cast<float>(linear), 0, 0, 1});
  }
  const std::vector<int> result = bytes(image_of(256, 1, pixels));
  for (std::size_t i = 0; i < 256; ++i) {
    ASSERT_EQ(result[4 * i], static_cast<int>(i));
  }
}

TEST_F(PngTest, ClampsWhatIsOutOfRange) {
  EXPECT_EQ(bytes(image_of(2, 1, {{2, -1, 0.5F, 1.0001F}, {5, 5, 5, -0.5F}})),
            (std::vector<int>{255, 0, 188, 255, 0, 0, 0, 0}));
  // Radiance without opacity: over a background it is seen, straight it cannot be said.
  EXPECT_EQ(bytes(image_of(1, 1, {{0.5F, 0, 0, 0}})), (std::vector<int>{0, 0, 0, 0}));
}

// encode_png() is the file of write_png(), and to_srgb8() what is in it.
TEST_F(PngTest, InMemoryIsTheSame) {
  const Image image = image_of(2, 1, {{0.1F, 0.2F, 0.3F, 0.5F}, {1, 0.5F, 0, 1}});
  for (const std::optional<Rgb<double>>& background :
       {std::optional<Rgb<double>>(), std::optional(Rgb<double>{0.2, 0.4, 0.6})}) {
    const std::vector<int> file = bytes(image, background);
    const std::vector<std::uint8_t> memory = to_srgb8(image, background);
    EXPECT_EQ(file, std::vector<int>(memory.begin(), memory.end()));
    const std::string encoded = encode_png(image, background);
    std::ifstream written(path("a.png"), std::ios::binary);
    EXPECT_EQ(encoded, std::string(std::istreambuf_iterator<char>(written), {}));
  }
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(to_srgb8(image_of(1, 1, {{nan, 1, 1, 1}})),
            (std::vector<std::uint8_t>{0, 255, 255, 255}));
  EXPECT_THROW(encode_png(image_of(1, 1, {{nan, 1, 1, 1}})), Error);
}

TEST_F(PngTest, SmallestOpacityKeepsItsColor) {
  const float alpha = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(bytes(image_of(1, 1, {{alpha, 0, alpha, alpha}})), (std::vector<int>{255, 0, 255, 0}));
}

TEST_F(PngTest, CompositesOverTheBackgroundInLinearLight) {
  // Half red over white: (1, 0.5, 0.5) linear, whose signal is (255, 188, 188). Composited in sRGB
  // it would be (255, 128, 128).
  EXPECT_EQ(bytes(image_of(2, 1, {{0.5F, 0, 0, 0.5F}, {0, 0, 0, 0}}), Rgb<double>{1, 1, 1}),
            (std::vector<int>{255, 188, 188, 255, 255, 255}));
  EXPECT_EQ(bytes(image_of(1, 1, {{0.25F, 0.25F, 0.25F, 1}}), Rgb<double>{1, 1, 1}),
            (std::vector<int>{137, 137, 137}));
}

TEST_F(PngTest, KeepsTheMetadata) {
  Image image = image_of(1, 1, {{0, 0, 0, 1}});
  image.metadata = {{"method", "exact"}, {"camera", "{\"up\": [0, 1, 0]} τ"}, {"empty", ""}};
  write_png(image, path("a.png"));
  EXPECT_EQ(decode(path("a.png")).text, image.metadata);
}

TEST_F(PngTest, RefusesNanAndInfinityAndSaysWhere) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf}) {
    for (std::size_t c = 0; c < 4; ++c) {
      Image image = image_of(2, 2, {{}, {}, {}, {}});
      image.pixels[2][c] = bad;
      EXPECT_TRUE(contains(error_of([&] { write_png(image, path("a.png")); }), "pixel (0, 1)"));
    }
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(PngTest, RefusesABackgroundThatIsNoColor) {
  const Rgb<double> background{0, std::numeric_limits<double>::quiet_NaN(), 0};
  const Image image = image_of(1, 1, {{}});
  EXPECT_TRUE(
      contains(error_of([&] { write_png(image, path("a.png"), background); }), "background"));
  EXPECT_TRUE(files().empty());
}

TEST_F(PngTest, RefusesAKeyThatPngCannotHold) {
  Image image = image_of(1, 1, {{}});
  image.metadata[""] = "value";
  EXPECT_TRUE(contains(error_of([&] { write_png(image, path("a.png")); }), "keyword"));
  EXPECT_TRUE(files().empty());
}

TEST_F(PngTest, RefusesImagesThatDoNotAgreeWithTheirSize) {
  const Image missing = image_of(2, 2, {{}, {}, {}});
  EXPECT_TRUE(contains(error_of([&] { write_png(missing, path("a.png")); }), "3 pixels"));
  EXPECT_TRUE(contains(error_of([&] { write_png(Image{}, path("a.png")); }), "0 x 0"));
  EXPECT_TRUE(files().empty());
}

TEST_F(PngTest, NoFileWhereItCannotBeWritten) {
  const Image image = image_of(1, 1, {{}});
  EXPECT_TRUE(contains(error_of([&] { write_png(image, path("none/a.png")); }), "does not exist"));
  EXPECT_TRUE(contains(error_of([&] { write_png(image, folder_); }), "is a folder"));
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace pellucid::test_png

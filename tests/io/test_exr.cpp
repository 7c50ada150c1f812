// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "pellucid/io/image_files.h"
#include "scratch_folder.h"

namespace pellucid::test_exr {
namespace {

using test::contains;
using test::error_of;

constexpr float inf = std::numeric_limits<float>::infinity();

class ExrTest : public test::ScratchFolder {};

Image test_image() {
  Image image;
  image.width = 5;
  image.height = 3;
  for (int i = 0; i < 15; ++i) {
    const float x = static_cast<float>(i);
    // Values that half could not hold, and ones beyond [0, 1].
    image.pixels.push_back({x / 7, 1e-20F * x, -1e10F * x, 1 - x * 0x1p-24F});
    image.depth.push_back(i % 4 == 0 ? inf : x * 100.25F);
  }
  image.metadata = {{"pellucid:version", "0.1.0"}, {"pellucid:method", "exact\nτ"}};
  return image;
}

TEST_F(ExrTest, ComesBackBitForBit) {
  const Image image = test_image();
  write_exr(image, path("a.exr"));
  const Image back = read_exr(path("a.exr"));
  EXPECT_EQ(back.width, 5);
  EXPECT_EQ(back.height, 3);
  EXPECT_EQ(back.pixels, image.pixels);
  EXPECT_EQ(back.depth, image.depth);
  EXPECT_EQ(back.metadata, image.metadata);
  EXPECT_EQ(files(), std::vector<std::string>{"a.exr"});
}

TEST_F(ExrTest, IsWhatOtherProgramsExpect) {
  const Image image = test_image();
  write_exr(image, path("a.exr"));
  Imf::InputFile file(path("a.exr").c_str());
  EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
  std::string channels;
  for (auto i = file.header().channels().begin(); i != file.header().channels().end(); ++i) {
    channels += i.name();
    EXPECT_EQ(i.channel().type, Imf::FLOAT);
  }
  EXPECT_EQ(channels, "ABGRZ");
  std::vector<float> green(15);
  Imf::FrameBuffer buffer;
  buffer.insert("G", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(green.data()), 4, 20));
  file.setFrameBuffer(buffer);
  file.readPixels(0, 2);
  for (std::size_t i = 0; i < 15; ++i) EXPECT_EQ(green[i], image.pixels[i][1]);
}

Image image_with_error() {
  Image image = test_image();
  for (int i = 0; i < 15; ++i) {
    image.error.push_back(i == 3 ? inf : 1e-7F * static_cast<float>(i));
    image.proved.push_back(i % 3 == 0 ? 1 : 0);
  }
  return image;
}

TEST_F(ExrTest, ErrorAndItsProofComeBack) {
  const Image image = image_with_error();
  write_exr(image, path("a.exr"));
  const Image back = read_exr(path("a.exr"));
  EXPECT_EQ(back.pixels, image.pixels);
  EXPECT_EQ(back.depth, image.depth);
  EXPECT_EQ(back.error, image.error);
  EXPECT_EQ(back.proved, image.proved);
}

TEST_F(ExrTest, ErrorIsWhatOtherProgramsExpect) {
  write_exr(image_with_error(), path("a.exr"));
  write_error_exr(image_with_error(), 1e-6, path("e.exr"));
  Imf::InputFile image(path("a.exr").c_str()), map(path("e.exr").c_str());
  const auto types = [](const Imf::InputFile& file) {
    std::map<std::string, Imf::PixelType> result;
    const Imf::ChannelList& channels = file.header().channels();
    for (auto i = channels.begin(); i != channels.end(); ++i) result[i.name()] = i.channel().type;
    return result;
  };
  EXPECT_EQ(types(image), (std::map<std::string, Imf::PixelType>{{"A", Imf::FLOAT},
                                                                 {"B", Imf::FLOAT},
                                                                 {"G", Imf::FLOAT},
                                                                 {"R", Imf::FLOAT},
                                                                 {"Z", Imf::FLOAT},
                                                                 {"error", Imf::FLOAT},
                                                                 {"error.proved", Imf::HALF}}));
  EXPECT_EQ(types(map),
            (std::map<std::string, Imf::PixelType>{
                {"Y", Imf::FLOAT}, {"error", Imf::FLOAT}, {"error.proved", Imf::HALF}}));
}

TEST_F(ExrTest, ErrorMapHoldsTheErrorAndItsShareOfTheTolerance) {
  const Image image = image_with_error();
  write_error_exr(image, 4e-6, path("e.exr"));
  Imf::InputFile file(path("e.exr").c_str());
  std::vector<float> share(15), error(15), proved(15);
  Imf::FrameBuffer buffer;
  const auto insert = [&](const char* name, std::vector<float>& values) {
    buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 20));
  };
  insert("Y", share);
  insert("error", error);
  insert("error.proved", proved);
  file.setFrameBuffer(buffer);
  file.readPixels(0, 2);
  EXPECT_EQ(error, image.error);
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_EQ(proved[i], static_cast<float>(image.proved[i])) << i;
    EXPECT_FLOAT_EQ(share[i], image.error[i] / 4e-6F) << i;
  }
  const auto* method = file.header().findTypedAttribute<Imf::StringAttribute>("pellucid:method");
  ASSERT_NE(method, nullptr);
  EXPECT_EQ(method->value(), "exact\nτ");
}

TEST_F(ExrTest, ErrorWithoutAMarkIsAnEstimate) {
  Imf::Header header(2, 1);
  for (const char* name : {"R", "G", "B", "error"}) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  }
  std::vector<float> values = {0.25F, 0.5F};
  {
    Imf::OutputFile file(path("e.exr").c_str(), header);
    Imf::FrameBuffer buffer;
    for (const char* name : {"R", "G", "B", "error"}) {
      buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 8));
    }
    file.setFrameBuffer(buffer);
    file.writePixels(1);
  }
  const Image image = read_exr(path("e.exr"));
  EXPECT_EQ(image.error, values);
  EXPECT_EQ(image.proved, (std::vector<std::uint8_t>{0, 0}));
}

TEST_F(ExrTest, RefusesErrorsThatDoNotAgreeWithTheImage) {
  Image image = image_with_error();
  image.error.pop_back();
  EXPECT_TRUE(contains(error_of([&] { write_exr(image, path("a.exr")); }), "14 errors"));
  EXPECT_TRUE(contains(error_of([&] { write_error_exr(image, 1, path("a.exr")); }), "14 errors"));
  image = image_with_error();
  image.proved.clear();
  EXPECT_TRUE(contains(error_of([&] { write_exr(image, path("a.exr")); }), "0 marks of proof"));
  image = image_with_error();
  image.error.clear();
  EXPECT_TRUE(contains(error_of([&] { write_exr(image, path("a.exr")); }), "0 errors"));
  EXPECT_TRUE(
      contains(error_of([&] { write_error_exr(test_image(), 1, path("a.exr")); }), "0 errors"));
  for (const double tolerance : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_TRUE(
        contains(error_of([&] { write_error_exr(image_with_error(), tolerance, path("a.exr")); }),
                 "tolerance"));
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(ExrTest, HasNoDepthWhereNoneIsGiven) {
  Image image = test_image();
  image.depth.clear();
  write_exr(image, path("a.exr"));
  EXPECT_EQ(Imf::InputFile(path("a.exr").c_str()).header().channels().findChannel("Z"), nullptr);
  EXPECT_TRUE(read_exr(path("a.exr")).depth.empty());
  EXPECT_TRUE(read_exr(path("a.exr")).error.empty());
  EXPECT_TRUE(read_exr(path("a.exr")).proved.empty());
}

// A half RGB image whose data window [3,5]×[-1,2] overhangs the display window [2,6]×[0,3] above.
void write_window(const std::string& path, bool tiled) {
  const Imath::Box2i display({2, 0}, {6, 3}), data({3, -1}, {5, 2});
  Imf::Header header(display, data);
  for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::HALF));
  std::vector<Imath::half> values;
  for (int y = data.min.y; y <= data.max.y; ++y) {
    for (int x = data.min.x; x <= data.max.x; ++x) {
      values.emplace_back(static_cast<float>(10 * y + x));
    }
  }
  Imf::FrameBuffer buffer;
  for (const char* name : {"R", "G", "B"}) {
    buffer.insert(name, Imf::Slice::Make(Imf::HALF, values.data(), data));
  }
  if (tiled) {
    header.setTileDescription(Imf::TileDescription(2, 2));
    Imf::TiledOutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  } else {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(4);
  }
}

TEST_F(ExrTest, PlacesTheDataWindowInTheDisplayWindow) {
  for (const bool tiled : {false, true}) {
    write_window(path("w.exr").string(), tiled);
    const Image image = read_exr(path("w.exr"));
    ASSERT_EQ(image.width, 5);
    ASSERT_EQ(image.height, 4);
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 5; ++column) {
        const int x = column + 2, y = row;
        const bool inside = x >= 3 && x <= 5 && y <= 2;
        const float value = inside ? static_cast<float>(10 * y + x) : 0;
        EXPECT_EQ(image.at(column, row),
                  (std::array<float, 4>{value, value, value, inside ? 1.F : 0.F}))
            << column << ' ' << row;
      }
    }
  }
}

TEST_F(ExrTest, RefusesWhatIsNoColorImage) {
  Imf::Header header(2, 2);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  std::vector<float> values(4);
  {
    Imf::OutputFile file(path("y.exr").c_str(), header);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 8));
    file.setFrameBuffer(buffer);
    file.writePixels(2);
  }
  EXPECT_TRUE(contains(error_of([&] { read_exr(path("y.exr")); }), "no channel R"));
}

TEST_F(ExrTest, RefusesWhatIsNotThereOrNoExr) {
  EXPECT_TRUE(contains(error_of([&] { read_exr(path("none.exr")); }), "no such file"));
  EXPECT_TRUE(contains(error_of([&] { read_exr(folder_); }), "is a folder"));
  write("empty.exr", "");
  write("text.exr", "not an image, but long enough to look into");
  EXPECT_TRUE(contains(error_of([&] { read_exr(path("empty.exr")); }), "cannot read"));
  EXPECT_TRUE(contains(error_of([&] { read_exr(path("text.exr")); }), "cannot read"));
}

TEST_F(ExrTest, EveryTruncationIsAnError) {
  write_exr(test_image(), path("a.exr"));
  const std::string whole = read(path("a.exr"));
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    write("cut.exr", whole.substr(0, length));
    error_of([&] { read_exr(path("cut.exr")); });
  }
}

// Sides in the header are two 32-bit corners; put enormous ones there.
TEST_F(ExrTest, RefusesEnormousSidesBeforeAllocating) {
  write_exr(test_image(), path("a.exr"));
  const std::string whole = read(path("a.exr"));
  for (const std::string name : {"dataWindow", "displayWindow"}) {
    const std::size_t at = whole.find(name + '\0' + "box2i") + name.size() + 7 + 4;
    for (const std::int32_t side : {70000, 2147483646, -5}) {
      std::string changed = whole;
      std::memcpy(changed.data() + at + 8, &side, 4);
      write("big.exr", changed);
      error_of([&] { read_exr(path("big.exr")); });
    }
  }
}

// Whatever a damaged file does, it is an image or an Error, and no memory is touched that is not
// the reader's (the sanitizer build watches).
TEST_F(ExrTest, DamagedFilesAreAnImageOrAnError) {
  write_exr(image_with_error(), path("a.exr"));
  const std::string whole = read(path("a.exr"));
  std::mt19937 random(1);
  int errors = 0;
  for (int run = 0; run < 400; ++run) {
    std::string changed = whole;
    for (unsigned n = 1 + random() % 4; n > 0; --n) {
      changed[random() % changed.size()] = static_cast<char>(random());
    }
    write("damaged.exr", changed);
    try {
      const Image image = read_exr(path("damaged.exr"));
      EXPECT_EQ(image.pixels.size(),
                static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    } catch (const Error& e) {
      ++errors;
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(errors, 100);
}

TEST_F(ExrTest, NoFileWhereItCannotBeWritten) {
  const Image image = test_image();
  EXPECT_TRUE(contains(error_of([&] { write_exr(image, path("none/a.exr")); }), "does not exist"));
  EXPECT_TRUE(contains(error_of([&] { write_exr(image, folder_); }), "is a folder"));
  Image reserved = image;
  reserved.metadata["channels"] = "not the list of channels";
  EXPECT_TRUE(contains(error_of([&] { write_exr(reserved, path("a.exr")); }), "cannot write"));
  Image wrong = image;
  wrong.depth.pop_back();
  EXPECT_TRUE(contains(error_of([&] { write_exr(wrong, path("a.exr")); }), "14 depths"));
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace pellucid::test_exr

// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "files/input_file.h"
#include "files/memory_limit.h"
#include "image_checks.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

// Those of a pixel, and what else is read of a file.
const char* const color_channels[4] = {"R", "G", "B", "A"};
const char* const read_channels[7] = {"R", "G", "B", "A", "Z", "error", "error.proved"};

// The first line of what the library says.
std::string first_line(const std::exception& e) {
  const std::string text = e.what();
  return text.substr(0, text.find('\n'));
}

// A file in the making: its header, and where its pixels lie.
class ChannelList {
 public:
  explicit ChannelList(const Image& image)
      : image_(image),
        header_(image.width, image.height),
        width_(static_cast<std::size_t>(image.width)) {
    header_.compression() = Imf::ZIP_COMPRESSION;
  }

  /// Adds a channel. The numbers must live until the file is written; from one to the next it is
  /// `stride` bytes.
  template <class Number>
  void add(const char* name, Imf::PixelType type, const Number* first,
           std::size_t stride = sizeof(Number)) {
    header_.channels().insert(name, Imf::Channel(type));
    // The library's buffers are not const, though it only reads from them here.
    char* bytes = reinterpret_cast<char*>(const_cast<Number*>(first));
    buffer_.insert(name, Imf::Slice(type, bytes, stride, stride * width_));
  }

  void write(const std::filesystem::path& path) {
    AtomicFile file(path);
    try {
      for (const auto& [key, value] : image_.metadata) {
        header_.insert(key, Imf::StringAttribute(value));
      }
      Imf::OutputFile output(file.temporary_path().c_str(), header_);
      output.setFrameBuffer(buffer_);
      output.writePixels(image_.height);
    } catch (const std::exception& e) {
      throw Error(path.string() + ": cannot write: " + first_line(e));
    }
    file.commit();
  }

 private:
  const Image& image_;
  Imf::Header header_;
  Imf::FrameBuffer buffer_;
  std::size_t width_;
};

void check_error(const Image& image, const std::filesystem::path& path) {
  if (image.error.size() == image.pixels.size() && image.proved.size() == image.error.size()) {
    return;
  }
  throw Error(path.string() + ": cannot write: the image has " +
              std::to_string(image.error.size()) + " errors, " +
              std::to_string(image.proved.size()) + " marks of proof and " +
              std::to_string(image.pixels.size()) + " pixels");
}

// Half and not an integer: viewers that show any channel show this one, and 0 and 1 are exact.
std::vector<Imath::half> proved_as_half(const Image& image) {
  std::vector<Imath::half> marks;
  marks.reserve(image.proved.size());
  for (const std::uint8_t proved : image.proved) marks.emplace_back(proved != 0 ? 1.F : 0.F);
  return marks;
}

// Columns or rows of a box, in 64 bits: a hostile header may say anything.
std::int64_t extent(int lower, int upper) {
  return std::int64_t{upper} - lower + 1;
}

void check_header(const Imf::Header& header, const std::string& name) {
  const Imath::Box2i& data = header.dataWindow();
  const Imath::Box2i& display = header.displayWindow();
  for (const Imath::Box2i* box : {&data, &display}) {
    for (const std::int64_t side :
         {extent(box->min.x, box->max.x), extent(box->min.y, box->max.y)}) {
      if (side < 1 || side > largest_image_side) {
        throw Error(name + ": the image has a side of " + std::to_string(side) +
                    " pixels; sides are from 1 to " + std::to_string(largest_image_side));
      }
    }
  }
  for (const char* channel : {"R", "G", "B"}) {
    if (header.channels().findChannel(channel) == nullptr) {
      throw Error(name + ": there is no channel " + channel +
                  "; an image has the channels R, G, B and maybe A and Z");
    }
  }
  for (const char* channel : read_channels) {
    const Imf::Channel* c = header.channels().findChannel(channel);
    if (c != nullptr && (c->xSampling != 1 || c->ySampling != 1)) {
      throw Error(name + ": channel " + channel + " is subsampled; save it at full resolution");
    }
  }
}

// Display window of the file; what of it the data window does not cover is empty.
Image read_pixels(Imf::InputFile& file, const std::string& name) {
  check_header(file.header(), name);
  const Imath::Box2i data = file.header().dataWindow();
  const Imath::Box2i display = file.header().displayWindow();
  const bool has_depth = file.header().channels().findChannel("Z") != nullptr;
  const bool has_error = file.header().channels().findChannel("error") != nullptr;

  Image image;
  image.width = static_cast<int>(extent(display.min.x, display.max.x));
  image.height = static_cast<int>(extent(display.min.y, display.max.y));
  const std::size_t count =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  check_memory(count * (sizeof(image.pixels[0]) + (has_depth ? sizeof(float) : 0) +
                        (has_error ? sizeof(float) + 1 : 0)),
               name + ": the image");
  image.pixels.resize(count);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  if (has_depth) image.depth.assign(count, infinity);
  if (has_error) image.error.assign(count, infinity);
  if (has_error) image.proved.assign(count, 0);

  // One row of the data window at a time: rows share the buffer by a row stride of 0.
  struct Pixel {
    float channel[7];
  };
  std::vector<Pixel> row(static_cast<std::size_t>(extent(data.min.x, data.max.x)));
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < 7; ++c) {
    const std::uintptr_t first = reinterpret_cast<std::uintptr_t>(&row[0].channel[c]);
    const std::uintptr_t shift =
        static_cast<std::uintptr_t>(std::int64_t{data.min.x}) * sizeof(Pixel);
    buffer.insert(read_channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(first - shift),
                                               sizeof(Pixel), 0, 1, 1, c == 3 ? 1.0 : 0.0));
  }
  file.setFrameBuffer(buffer);
  const int first_row = std::max(data.min.y, display.min.y);
  const int last_row = std::min(data.max.y, display.max.y);
  const int first_column = std::max(data.min.x, display.min.x);
  const int last_column = std::min(data.max.x, display.max.x);
  for (int y = first_row; y <= last_row; ++y) {
    file.readPixels(y);
    for (int x = first_column; x <= last_column; ++x) {
      const Pixel& pixel = row[static_cast<std::size_t>(extent(data.min.x, x) - 1)];
      const int column = static_cast<int>(extent(display.min.x, x) - 1);
      const int image_row = static_cast<int>(extent(display.min.y, y) - 1);
      image.at(column, image_row) = {pixel.channel[0], pixel.channel[1], pixel.channel[2],
                                     pixel.channel[3]};
      const std::size_t index =
          static_cast<std::size_t>(image_row) * static_cast<std::size_t>(image.width) +
          static_cast<std::size_t>(column);
      if (has_depth) image.depth[index] = pixel.channel[4];
      if (has_error) image.error[index] = pixel.channel[5];
      if (has_error) image.proved[index] = pixel.channel[6] > 0.5F ? 1 : 0;
    }
  }
  for (auto i = file.header().begin(); i != file.header().end(); ++i) {
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute())) {
      image.metadata[i.name()] = text->value();
    }
  }
  return image;
}

}  // namespace

void write_exr(const Image& image, const std::filesystem::path& path) {
  check_image(image, path);
  ChannelList channels(image);
  for (std::size_t c = 0; c < 4; ++c) {
    channels.add(color_channels[c], Imf::FLOAT, &image.pixels[0][c], sizeof(image.pixels[0]));
  }
  if (!image.depth.empty()) channels.add("Z", Imf::FLOAT, image.depth.data());
  if (!image.values.empty()) {
    check_values(image, path);
    channels.add("value", Imf::FLOAT, image.values.data());
  }
  std::vector<Imath::half> proved;
  if (!image.error.empty() || !image.proved.empty()) {
    check_error(image, path);
    proved = proved_as_half(image);
    channels.add("error", Imf::FLOAT, image.error.data());
    channels.add("error.proved", Imf::HALF, proved.data());
  }
  channels.write(path);
}

void write_error_exr(const Image& image, double tolerance, const std::filesystem::path& path) {
  check_image(image, path);
  check_error(image, path);
  if (!(tolerance > 0)) {
    throw Error(path.string() + ": cannot write: the tolerance is not a positive number");
  }
  const std::vector<Imath::half> proved = proved_as_half(image);
  std::vector<float> scaled;
  scaled.reserve(image.error.size());
  for (const float error : image.error) {
    scaled.push_back(static_cast<float>(static_cast<double>(error) / tolerance));
  }
  ChannelList channels(image);
  channels.add("Y", Imf::FLOAT, scaled.data());
  channels.add("error", Imf::FLOAT, image.error.data());
  channels.add("error.proved", Imf::HALF, proved.data());
  channels.write(path);
}

void write_values_exr(const Image& image, const std::filesystem::path& path) {
  check_image(image, path);
  check_values(image, path);
  ChannelList channels(image);
  channels.add("Y", Imf::FLOAT, image.values.data());
  channels.write(path);
}

Image read_exr(const std::filesystem::path& path) {
  check_input_file(path);
  try {
    Imf::InputFile file(path.c_str());
    return read_pixels(file, path.string());
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(path.string() + ": cannot read the image: " + first_line(e));
  }
}

}  // namespace pellucid

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
#include <string>
#include <vector>

#include "image_checks.h"
#include "input_file.h"
#include "pellucid/io/atomic_file.h"
#include "pellucid/io/image_files.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

const char* const channel_name[4] = {"R", "G", "B", "A"};

// The first line of what the library says.
std::string first_line(const std::exception& e) {
  const std::string text = e.what();
  return text.substr(0, text.find('\n'));
}

Imf::Header make_header(const Image& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const char* name : channel_name) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  }
  if (!image.depth.empty()) header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  for (const auto& [key, value] : image.metadata) {
    header.insert(key, Imf::StringAttribute(value));
  }
  return header;
}

void write_pixels(const Image& image, const std::filesystem::path& path) {
  Imf::OutputFile file(path.c_str(), make_header(image));
  Imf::FrameBuffer buffer;
  // The library's buffers are not const, though it only reads from them here.
  char* pixels = reinterpret_cast<char*>(const_cast<std::array<float, 4>*>(image.pixels.data()));
  const std::size_t stride = sizeof(image.pixels[0]);
  const std::size_t row = stride * static_cast<std::size_t>(image.width);
  for (std::size_t c = 0; c < 4; ++c) {
    buffer.insert(channel_name[c], Imf::Slice(Imf::FLOAT, pixels + c * sizeof(float), stride, row));
  }
  if (!image.depth.empty()) {
    char* depth = reinterpret_cast<char*>(const_cast<float*>(image.depth.data()));
    buffer.insert("Z", Imf::Slice(Imf::FLOAT, depth, sizeof(float),
                                  sizeof(float) * static_cast<std::size_t>(image.width)));
  }
  file.setFrameBuffer(buffer);
  file.writePixels(image.height);
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
  for (const char* channel : {"R", "G", "B", "A", "Z"}) {
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

  Image image;
  image.width = static_cast<int>(extent(display.min.x, display.max.x));
  image.height = static_cast<int>(extent(display.min.y, display.max.y));
  const std::size_t count =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  check_memory(count * (sizeof(image.pixels[0]) + (has_depth ? sizeof(float) : 0)), name);
  image.pixels.resize(count);
  if (has_depth) image.depth.assign(count, std::numeric_limits<float>::infinity());

  // One row of the data window at a time: rows share the buffer by a row stride of 0.
  struct Pixel {
    float channel[5];
  };
  std::vector<Pixel> row(static_cast<std::size_t>(extent(data.min.x, data.max.x)));
  Imf::FrameBuffer buffer;
  const char* const names[5] = {"R", "G", "B", "A", "Z"};
  for (std::size_t c = 0; c < 5; ++c) {
    const std::uintptr_t first = reinterpret_cast<std::uintptr_t>(&row[0].channel[c]);
    const std::uintptr_t shift =
        static_cast<std::uintptr_t>(std::int64_t{data.min.x}) * sizeof(Pixel);
    buffer.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(first - shift),
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
      if (has_depth) {
        image.depth[static_cast<std::size_t>(image_row) * static_cast<std::size_t>(image.width) +
                    static_cast<std::size_t>(column)] = pixel.channel[4];
      }
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
  AtomicFile file(path);
  try {
    write_pixels(image, file.temporary_path());
  } catch (const std::exception& e) {
    throw Error(path.string() + ": cannot write: " + first_line(e));
  }
  file.commit();
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

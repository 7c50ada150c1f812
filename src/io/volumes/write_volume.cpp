// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/write_volume.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <string_view>

#include "files/deflater.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "text/text.h"
#include "volume_writers.h"

namespace pellucid {

namespace {

const VolumeWriter* writer_of(const std::filesystem::path& path) {
  const std::string name = in_small_letters(path.filename().string());
  const auto writers = volume_writers();
  const auto writer = std::ranges::find_if(
      writers, [&](const VolumeWriter* known) { return name.ends_with(known->extension); });
  return writer == writers.end() ? nullptr : *writer;
}

void check(const WrittenVolume& volume, bool keeps_positions) {
  if (volume.components.empty()) throw Error(volume.path + ": not written: there is no volume");
  const Volume::Description& first = volume.description();
  for (std::size_t a = 0; a < 3; ++a) {
    if (keeps_positions || first.coordinates[a].empty()) continue;
    throw Error(volume.path + ": not written: the values stand at positions of their own along " +
                std::string(1, "xyz"[a]) +
                ", which the format cannot hold; write .npz, or tetrahedra, .vtu");
  }
  for (const Volume& component : volume.components) {
    const Volume::Description& d = component.description();
    if (component.data().index() == volume.data().index() && d.dimensions == first.dimensions &&
        d.centering == first.centering) {
      continue;
    }
    throw Error(volume.path +
                ": not written: its components differ in type, dimensions or centering");
  }
}

}  // namespace

bool is_writable_volume(const std::filesystem::path& path) {
  return writer_of(path) != nullptr;
}

std::string writable_volume_extensions() {
  std::string known;
  for (const VolumeWriter* const writer : volume_writers()) {
    known += (known.empty() ? "" : " ") + std::string(writer->extension);
  }
  return known;
}

std::vector<std::string> write_volume(std::span<const Volume> components,
                                      const std::filesystem::path& path, const std::string& array) {
  const WrittenVolume volume{components, array, path.string()};
  const VolumeWriter* const writer = writer_of(path);
  if (writer == nullptr) {
    throw Error(path.string() + ": not written: a volume is written as one of " +
                writable_volume_extensions());
  }
  check(volume, writer->keeps_positions);
  AtomicFile file(path);
  std::ofstream stream(file.temporary_path(), std::ios::binary);
  const Sink to_file = [&](std::span<const std::byte> bytes) {
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    if (!stream) throw Error(path.string() + ": cannot write: is the disk full?");
  };
  Losses losses;
  if (writer->compressed) {
    Deflater gzip(Deflater::Wrapping::gzip, to_file);
    losses = writer->write(volume, [&](std::span<const std::byte> bytes) { gzip.put(bytes); });
    gzip.finish();
  } else {
    losses = writer->write(volume, to_file);
  }
  stream.close();
  if (!stream) throw Error(path.string() + ": cannot write: is the disk full?");
  file.commit();
  return losses;
}

void put_text(const std::string& text, const Sink& sink) {
  sink(std::as_bytes(std::span(text)));
}

void put_interleaved(const WrittenVolume& volume, const Sink& sink) {
  if (volume.count() == 1) {
    put_one_by_one(volume, sink);
    return;
  }
  std::visit(
      [&](const auto& first) {
        using Value = typename std::decay_t<decltype(first)>::value_type;
        const std::size_t components = volume.components.size();
        constexpr std::size_t values_at_once = std::size_t{1} << 16;
        const std::size_t points_at_once = std::max<std::size_t>(values_at_once / components, 1);
        std::vector<Value> part;
        for (std::size_t begin = 0; begin < first.size(); begin += points_at_once) {
          const std::size_t end = std::min(first.size(), begin + points_at_once);
          part.resize((end - begin) * components);
          for (std::size_t c = 0; c < components; ++c) {
            const auto& values = std::get<DataArray<Value>>(volume.components[c].data());
            for (std::size_t i = begin; i < end; ++i) {
              part[(i - begin) * components + c] = values[i];
            }
          }
          sink(std::as_bytes(std::span(part)));
        }
      },
      volume.data());
}

void put_one_by_one(const WrittenVolume& volume, const Sink& sink) {
  for (const Volume& component : volume.components) {
    std::visit(
        [&](const auto& values) { sink(std::as_bytes(std::span(values.data(), values.size()))); },
        component.data());
  }
}

std::string exact_text(double x) {
  std::array<char, 32> digits{};
  // The sum turns -0 into 0.
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), x + 0.0);
  return {digits.data(), end.ptr};
}

std::string exact_text(const Vec3<double>& v, const std::string& separator) {
  return exact_text(v.x) + separator + exact_text(v.y) + separator + exact_text(v.z);
}

}  // namespace pellucid

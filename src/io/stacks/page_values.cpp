// SPDX-License-Identifier: Apache-2.0
#include "page_values.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <tuple>

#include "files/memory_limit.h"
#include "pellucid/scene/error.h"
#include "volumes/stored_numbers.h"

namespace pellucid {

namespace {

/// Returns the lowest and highest number of a type of whole numbers.
std::array<double, 2> range_of(const std::string& type) {
  const double values = std::exp2(std::stod(type.substr(1)));
  return type.starts_with('i') ? std::array{-values / 2, values / 2 - 1}
                               : std::array{0.0, values - 1};
}

/// Returns the type that holds the calibrated values of a stored one: a whole type where the slope
/// is 1 and the offset whole, as for DICOM; else f32, of 32 bits and more f64.
std::string calibrated_type(const std::string& type, const ValueCalibration& by,
                            const std::string& name) {
  if (type.starts_with('f')) return type;
  const std::size_t size = value_size(type, name);
  if (by.slope == 1 && by.offset == std::floor(by.offset)) {
    const auto [lowest, highest] = range_of(type);
    const auto whole = whole_type_for(lowest + by.offset, highest + by.offset, size);
    if (whole) return *whole;
  }
  return size <= 2 ? "f32" : "f64";
}

/// A plane to be read: in the order of files and pages.
struct Job {
  PlanePage from;
  std::size_t plane_component = 0, slice = 0;
};

std::vector<Job> jobs_of(const PageLayout& layout, std::size_t first, std::size_t last) {
  const auto slices = static_cast<std::size_t>(layout.slices);
  std::vector<Job> jobs;
  jobs.reserve((last - first + 1) * slices);
  for (std::size_t c = first; c <= last; ++c) {
    for (std::size_t z = 0; z < slices; ++z) jobs.push_back({layout.planes[c * slices + z], c, z});
  }
  std::ranges::sort(jobs, {},
                    [](const Job& job) { return std::pair(job.from.file, job.from.page); });
  return jobs;
}

/// Stands at one page after the other.
class Pages {
 public:
  Pages(const PageVolume& volume) : volume_(volume) {}

  PageReader& at(const PlanePage& page) {
    if (!reader_ || file_ != page.file || page_ > page.page) {
      reader_ = open_planes(volume_, page.file);
      file_ = page.file;
      page_ = 0;
    }
    for (; page_ < page.page; ++page_) {
      if (!reader_->next()) fail();
    }
    if (reader_->format() != volume_.format) fail();
    return *reader_;
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(volume_.files[file_].file.string() +
                ": has changed while it was read; is it being written?");
  }

  const PageVolume& volume_;
  std::unique_ptr<PageReader> reader_;
  std::size_t file_ = 0;
  std::uint32_t page_ = 0;
};

/// Takes one sample of a page of several.
void take_sample(std::span<const std::byte> page, std::size_t samples, std::size_t sample,
                 std::size_t size, std::span<std::byte> to) {
  const std::size_t count = to.size() / size;
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(&to[i * size], &page[(i * samples + sample) * size], size);
  }
}

/// Calibrates one sample of a page.
void calibrate(std::span<const std::byte> page, const PageFormat& format, std::size_t sample,
               const ValueCalibration& by, VolumeData& to, std::size_t begin, std::size_t count) {
  const auto samples = static_cast<std::size_t>(format.samples);
  std::visit(
      [&](const auto& of_stored, auto& values) {
        using Stored = typename std::decay_t<decltype(of_stored)>::value_type;
        using Value = typename std::decay_t<decltype(values)>::value_type;
        const auto out = values.writable().subspan(begin, count);
        for (std::size_t i = 0; i < count; ++i) {
          Stored stored;
          std::memcpy(&stored, &page[(i * samples + sample) * sizeof(Stored)], sizeof(Stored));
          out[i] = static_cast<Value>(by.offset + by.slope * static_cast<double>(stored));
        }
      },
      make_volume_data(format.type, 0), to);
}

}  // namespace

std::unique_ptr<PageReader> open_planes(const PageVolume& volume, std::size_t file) {
  std::unique_ptr<PageReader> reader = open_pages(volume.files[file].file);
  if (volume.shared_planes > 0) reader->share_first_page(volume.shared_planes);
  return reader;
}

std::vector<VolumeData> read_page_values(const PageVolume& volume, ComponentRange range,
                                         const std::string& name) {
  const PageFormat& format = volume.format;
  const std::size_t per_page =
      static_cast<std::size_t>(format.columns) * static_cast<std::size_t>(format.rows);
  const std::size_t points = per_page * static_cast<std::size_t>(volume.layout.slices);
  const std::size_t size = value_size(format.type, name);
  const auto samples = static_cast<std::size_t>(format.samples);
  const auto first = static_cast<std::size_t>(range.first);
  const auto number = static_cast<std::size_t>(range.number);
  const auto& calibration = volume.calibration;
  const std::string type =
      calibration ? calibrated_type(format.type, *calibration, name) : format.type;
  check_memory(std::uintmax_t{points} * number * value_size(type, name) + per_page * samples * size,
               name + ": its values");
  std::vector<VolumeData> list;
  list.reserve(number);
  for (std::size_t c = 0; c < number; ++c) list.push_back(make_values(type, points, name));
  const bool in_place = samples == 1 && !calibration;
  std::vector<std::byte> page(in_place ? 0 : per_page * samples * size);
  Pages pages(volume);
  for (const Job& job : jobs_of(volume.layout, first / samples, (first + number - 1) / samples)) {
    const std::size_t begin = job.slice * per_page;
    const auto part = [&](VolumeData& data) {
      return std::visit(
          [&](auto& values) {
            return std::as_writable_bytes(values.writable()).subspan(begin * size, per_page * size);
          },
          data);
    };
    PageReader& reader = pages.at(job.from);
    if (in_place) {
      reader.read(part(list[job.plane_component - first]));
      continue;
    }
    reader.read(page);
    for (std::size_t sample = 0; sample < samples; ++sample) {
      const std::size_t component = job.plane_component * samples + sample;
      if (component < first || component >= first + number) continue;
      VolumeData& to = list[component - first];
      if (calibration) {
        calibrate(page, format, sample, *calibration, to, begin, per_page);
      } else {
        take_sample(page, samples, sample, size, part(to));
      }
    }
  }
  return list;
}

}  // namespace pellucid

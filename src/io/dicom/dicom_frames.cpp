// SPDX-License-Identifier: Apache-2.0
#include "dicom_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "text/readable_number.h"

namespace pellucid {

namespace {

// PS3.6.
namespace frame_tag {
constexpr DicomTag modality = 0x00080060, thickness = 0x00180050,
                   spacing_between_slices = 0x00180088, frame_time = 0x00181063,
                   frame_time_vector = 0x00181065, slice_locations = 0x00182005,
                   frame_increment = 0x00280009, slice_vector = 0x00540080,
                   grid_frame_offsets = 0x3004000c;
}  // namespace frame_tag

// What else may differ between the frames of nuclear medicine.
constexpr std::array<std::pair<DicomTag, const char*>, 8> other_vectors{
    {{0x00540010, "energy windows"},
     {0x00540020, "detectors"},
     {0x00540030, "phases"},
     {0x00540050, "rotations"},
     {0x00540060, "R-R intervals"},
     {0x00540070, "time slots"},
     {0x00540090, "angular views"},
     {0x00540100, "time slices"}}};

bool has(const DicomDataSet& data, DicomTag tag) {
  return data.values.contains(tag) && !data.values.at(tag).empty();
}

DicomFrameOffsets refuse(std::string why) {
  DicomFrameOffsets offsets;
  offsets.refused = std::move(why);
  return offsets;
}

/// Returns the offsets of a vector of decimals from its first number.
DicomFrameOffsets of_decimals(const DicomDataSet& data, DicomTag tag, const std::string& name,
                              int frames) {
  const std::vector<double> numbers = data.decimals(tag);
  if (numbers.empty()) return refuse("its " + name + " holds something that is no number");
  if (numbers.size() != static_cast<std::size_t>(frames)) {
    return refuse("its " + name + " has " + std::to_string(numbers.size()) +
                  (numbers.size() == 1 ? " number" : " numbers") + ", but there are " +
                  std::to_string(frames) + " frames");
  }
  DicomFrameOffsets offsets;
  for (const double number : numbers) offsets.offset.push_back(number - numbers.front());
  return offsets;
}

DicomFrameOffsets of_dose(const DicomDataSet& data, int frames, const Vec3<double>& normal,
                          const std::optional<Vec3<double>>& position) {
  const std::string name = "GridFrameOffsetVector (3004,000C)";
  DicomFrameOffsets offsets = of_decimals(data, frame_tag::grid_frame_offsets, name, frames);
  if (!offsets.refused.empty()) return offsets;
  // The vector begins with 0 and is relative to the first plane, along the normal; or it begins
  // with the z of the first plane, of axial planes alone, and is along z.
  const double first = data.decimals(frame_tag::grid_frame_offsets).front();
  if (first == 0) return offsets;
  constexpr double axial = 1e-3, rounding = 0.01;
  const bool is_axial = std::abs(std::abs(normal.z) - 1) < axial;
  const bool is_absolute = position && std::abs(position->z - first) <= rounding;
  offsets.along_z = is_axial;
  if (is_axial && (is_absolute || !position)) return offsets;
  offsets.note = name + " begins with " + readable_number(first) +
                 ", neither with 0 nor with the z of axial planes; the first plane is taken to "
                 "stand at ImagePositionPatient";
  return offsets;
}

DicomFrameOffsets of_slice_numbers(const DicomDataSet& data, int frames) {
  const std::vector<int> numbers = data.whole_numbers(frame_tag::slice_vector);
  if (numbers.size() != static_cast<std::size_t>(frames)) {
    return refuse("its SliceVector (0054,0080) has " + std::to_string(numbers.size()) +
                  " numbers, but there are " + std::to_string(frames) + " frames");
  }
  for (const auto& [vector, name] : other_vectors) {
    const std::vector<int> of_frames = data.whole_numbers(vector);
    const std::set<int> different(of_frames.begin(), of_frames.end());
    if (different.size() < 2) continue;
    return refuse("its " + std::to_string(frames) + " frames are of " +
                  std::to_string(different.size()) + " " + name +
                  ", several volumes in one file; save one of them as a file");
  }
  DicomFrameOffsets offsets;
  const auto first = [&](DicomTag tag) {
    const std::vector<double> found = data.decimals(tag);
    return found.empty() ? 0 : found.front();
  };
  double step = first(frame_tag::spacing_between_slices);
  if (step == 0) {
    step = first(frame_tag::thickness);
    if (!(step > 0)) return refuse("nothing says how far apart its frames stand");
    offsets.note =
        "the distance of slices is taken to be their thickness, " + readable_number(step) + " mm";
  }
  for (const int number : numbers) offsets.offset.push_back((number - numbers.front()) * step);
  return offsets;
}

}  // namespace

DicomFrameOffsets dicom_frame_offsets(const DicomDataSet& data, int frames,
                                      const Vec3<double>& normal,
                                      const std::optional<Vec3<double>>& position) {
  const std::vector<DicomTag> pointers = data.tags(frame_tag::frame_increment);
  const auto points_to = [&](DicomTag tag) {
    return std::ranges::find(pointers, tag) != pointers.end();
  };
  const bool is_dose = data.text(frame_tag::modality) == "RTDOSE";
  const auto counts = [&](DicomTag tag) {
    return has(data, tag) && (is_dose || pointers.empty() || points_to(tag));
  };
  if (counts(frame_tag::grid_frame_offsets)) return of_dose(data, frames, normal, position);
  if (counts(frame_tag::slice_locations)) {
    return of_decimals(data, frame_tag::slice_locations, "SliceLocationVector (0018,2005)", frames);
  }
  if (counts(frame_tag::slice_vector)) return of_slice_numbers(data, frames);
  const std::vector<double> step = data.decimals(frame_tag::spacing_between_slices);
  const bool is_film = has(data, frame_tag::frame_time) || has(data, frame_tag::frame_time_vector);
  const bool points_elsewhere = !pointers.empty() && !points_to(frame_tag::spacing_between_slices);
  if (!step.empty() && step.front() != 0 && !is_film && (is_dose || !points_elsewhere)) {
    DicomFrameOffsets offsets;
    for (int k = 0; k < frames; ++k) offsets.offset.push_back(k * step.front());
    offsets.note = "the frames are taken to stand SpacingBetweenSlices apart, " +
                   readable_number(step.front()) + " mm, in their order";
    return offsets;
  }
  if (is_dose) {
    return refuse(
        "its " + std::to_string(frames) +
        " planes of dose have no GridFrameOffsetVector (3004,000C), which says where they "
        "stand");
  }
  return refuse("its " + std::to_string(frames) +
                " frames have no positions of their own: a film, or a kind that is not read; save "
                "its frames as files with positions");
}

}  // namespace pellucid

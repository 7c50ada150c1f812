// SPDX-License-Identifier: Apache-2.0
#include "dicom_slices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "dicom_elements.h"
#include "dicom_frames.h"
#include "dicom_marks.h"
#include "pellucid/scene/error.h"
#include "text/readable_number.h"

namespace pellucid {

namespace {

// PS3.6.
namespace tag {
constexpr DicomTag image_type = 0x00080008, modality = 0x00080060, series_description = 0x0008103e,
                   slice_thickness = 0x00180050, spacing_between_slices = 0x00180088,
                   study = 0x0020000d, series = 0x0020000e, series_number = 0x00200011,
                   instance_number = 0x00200013, position = 0x00200032, orientation = 0x00200037,
                   samples = 0x00280002, photometric = 0x00280004, planar = 0x00280006,
                   frames = 0x00280008, rows = 0x00280010, columns = 0x00280011,
                   pixel_spacing = 0x00280030, bits_allocated = 0x00280100,
                   bits_stored = 0x00280101, high_bit = 0x00280102, representation = 0x00280103,
                   intercept = 0x00281052, slope = 0x00281053, lookup_table = 0x00283000,
                   shared_groups = 0x52009229, frame_groups = 0x52009230, dose_scaling = 0x3004000e,
                   dose_units = 0x30040002, dose_summation = 0x3004000a, rescale_type = 0x00281054,
                   pet_units = 0x00541001, detectors = 0x00540022, plane_position = 0x00209113,
                   plane_orientation = 0x00209116, pixel_measures = 0x00289110,
                   value_transformation = 0x00289145, location = 0x00201041;
}  // namespace tag

std::optional<double> first_of(const std::vector<double>& numbers) {
  return numbers.empty() ? std::nullopt : std::optional(numbers.front());
}

DicomFormat format_of(const DicomFile& file) {
  const DicomDataSet& data = file.data;
  DicomFormat format;
  format.columns = data.number(tag::columns).value_or(0);
  format.rows = data.number(tag::rows).value_or(0);
  format.samples = data.number(tag::samples).value_or(1);
  format.floating = file.pixel_tag != 0x7fe00010;
  format.bits_allocated = data.number(tag::bits_allocated)
                              .value_or(file.pixel_tag == 0x7fe00008   ? 32
                                        : file.pixel_tag == 0x7fe00009 ? 64
                                                                       : 0);
  format.bits_stored = data.number(tag::bits_stored).value_or(format.bits_allocated);
  format.high_bit = data.number(tag::high_bit).value_or(format.bits_stored - 1);
  format.is_signed = data.number(tag::representation).value_or(0) == 1;
  format.plane_by_plane = format.samples > 1 && data.number(tag::planar).value_or(0) == 1;
  return format;
}

// Why the values of such an image are not read; empty where they are.
std::string refusal(const DicomImage& image, const DicomFile& file) {
  const DicomFormat& f = image.format;
  const bool several = f.samples > 1;
  if (image.photometric == "PALETTE COLOR") return "its values are indices into a palette";
  if (several && image.photometric != "RGB" && image.photometric != "YBR_RCT" &&
      image.photometric != "YBR_ICT") {
    return "its colors are " + image.photometric + "; convert it to RGB";
  }
  if (file.data.sequences.contains(tag::lookup_table)) {
    return "its values go through a lookup table (ModalityLUTSequence); convert it to a slope and "
           "an intercept";
  }
  // Siemens: the slices of a volume side by side in one image, placed by a header of its own.
  if (file.data.text(tag::image_type).find("MOSAIC") != std::string::npos) {
    return "it is a mosaic of slices; convert it to one image per slice, or to NIfTI with dcm2niix";
  }
  if (f.columns < 1 || f.rows < 1 || f.samples < 1) {
    return "its header says " + std::to_string(f.columns) + " x " + std::to_string(f.rows) +
           " pixels of " + std::to_string(f.samples) + " values";
  }
  const int bits = f.bits_allocated;
  const bool known = f.floating ? bits == 32 || bits == 64 : bits == 8 || bits == 16 || bits == 32;
  if (!known) return "values of " + std::to_string(bits) + " bits are not read";
  if (!f.floating && (f.bits_stored < 1 || f.high_bit >= bits || f.high_bit + 1 < f.bits_stored)) {
    return "its header says that " + std::to_string(f.bits_stored) + " bits end at bit " +
           std::to_string(f.high_bit) + " of " + std::to_string(bits);
  }
  if (image.big_endian && bits == 8) return "big-endian values of 8 bits are not read";
  return {};
}

// What is said of one frame: in its own functional group, in the shared one, else in the file, or
// of the detector that took it.
class FrameFacts {
 public:
  FrameFacts(const DicomDataSet& file, const DicomDataSet* frame)
      : file_(file),
        shared_(file.item(tag::shared_groups)),
        frame_(frame),
        detector_(file.item(tag::detectors)) {}

  std::vector<double> decimals(DicomTag group, DicomTag element) const {
    for (const DicomDataSet* groups : {frame_, shared_}) {
      const DicomDataSet* item = groups == nullptr ? nullptr : groups->item(group);
      if (item == nullptr) continue;
      std::vector<double> numbers = item->decimals(element);
      if (!numbers.empty()) return numbers;
    }
    std::vector<double> numbers = file_.decimals(element);
    return numbers.empty() && detector_ != nullptr ? detector_->decimals(element) : numbers;
  }

  /// Returns the text of the element of the frame, whatever it is.
  std::string text(DicomTag group, DicomTag element) const {
    for (const DicomDataSet* groups : {frame_, shared_}) {
      const DicomDataSet* item = groups == nullptr ? nullptr : groups->item(group);
      if (item != nullptr && !item->text(element).empty()) return item->text(element);
    }
    return file_.text(element);
  }
  std::vector<std::string> marks() const { return dicom_mark_values(file_, {frame_, shared_}); }

  bool is_dose() const { return file_.text(tag::modality) == "RTDOSE"; }

  /// Returns the text that stands there and is no number; empty if there is none.
  std::string no_number(DicomTag group, DicomTag element) const {
    for (const DicomDataSet* groups : {frame_, shared_}) {
      const DicomDataSet* item = groups == nullptr ? nullptr : groups->item(group);
      if (item != nullptr && !item->text(element).empty()) return no_number(*item, element);
    }
    return no_number(file_, element);
  }

 private:
  static std::string no_number(const DicomDataSet& data, DicomTag element) {
    return data.decimals(element).empty() ? data.text(element) : std::string();
  }

  const DicomDataSet& file_;
  const DicomDataSet *shared_, *frame_, *detector_;
};

std::optional<std::array<Vec3<double>, 2>> directions(const std::vector<double>& cosines) {
  if (cosines.size() != 6) return std::nullopt;
  const Vec3<double> row{cosines[0], cosines[1], cosines[2]};
  const Vec3<double> column{cosines[3], cosines[4], cosines[5]};
  // Cosines come with three digits and more.
  constexpr double tolerance = 0.01;
  if (std::abs(length(row) - 1) > tolerance || std::abs(length(column) - 1) > tolerance ||
      std::abs(dot(row, column)) > tolerance) {
    return std::nullopt;
  }
  return std::array{row * (1 / length(row)), column * (1 / length(column))};
}

/// Says why the scale of the values is not known; empty where it is.
std::string refusal(const FrameFacts& facts) {
  const std::pair<DicomTag, const char*> scales[] = {
      {tag::slope, "RescaleSlope (0028,1053)"},
      {tag::intercept, "RescaleIntercept (0028,1052)"},
      {tag::dose_scaling, "DoseGridScaling (3004,000E)"}};
  for (const auto& [element, name] : scales) {
    if ((element == tag::dose_scaling) != facts.is_dose()) continue;
    const std::string text = facts.no_number(tag::value_transformation, element);
    if (!text.empty()) return std::string(name) + " is \"" + text + "\", no number";
  }
  return {};
}

/// Returns the digits behind the point of a number written as text, without zeros at their end.
int dicom_decimals(std::string_view number) {
  if (number.find_first_of("eE") != std::string_view::npos) {
    return std::numeric_limits<double>::digits10;
  }
  const std::size_t point = number.find('.');
  if (point == std::string_view::npos) return 0;
  const std::size_t last = number.find_last_of("123456789");
  return last == std::string_view::npos || last < point ? 0 : static_cast<int>(last - point);
}

/// Returns the decimals of three coordinates.
std::array<int, 3> decimals_of_each(std::string_view numbers) {
  std::array<int, 3> decimals{};
  for (int& digits : decimals) {
    const std::size_t end = std::min(numbers.find('\\'), numbers.size());
    digits = dicom_decimals(numbers.substr(0, end));
    numbers.remove_prefix(std::min(end + 1, numbers.size()));
  }
  return decimals;
}

DicomSlice slice_of(const FrameFacts& facts) {
  DicomSlice slice;
  const std::vector<double> position = facts.decimals(tag::plane_position, tag::position);
  if (position.size() == 3) {
    slice.position = {position[0], position[1], position[2]};
    slice.decimals = decimals_of_each(facts.text(tag::plane_position, tag::position));
  }
  slice.location = first_of(facts.decimals(tag::plane_position, tag::location));
  if (!slice.position) {
    slice.decimals.fill(dicom_decimals(facts.text(tag::plane_position, tag::location)));
  }
  slice.marks = facts.marks();
  slice.orientation = directions(facts.decimals(tag::plane_orientation, tag::orientation));
  const std::vector<double> spacing = facts.decimals(tag::pixel_measures, tag::pixel_spacing);
  // PS3.3, 10.7.1.3: first the distance of rows.
  if (spacing.size() == 2 && spacing[0] > 0 && spacing[1] > 0) {
    slice.spacing = std::array{spacing[1], spacing[0]};
  }
  slice.distance = first_of(facts.decimals(tag::pixel_measures, tag::spacing_between_slices));
  slice.thickness = first_of(facts.decimals(tag::pixel_measures, tag::slice_thickness));
  if (facts.is_dose()) {
    // PS3.3, C.8.8.3: the dose grid has a scaling of its own, and no intercept.
    slice.slope =
        first_of(facts.decimals(tag::value_transformation, tag::dose_scaling)).value_or(1);
    return slice;
  }
  slice.slope = first_of(facts.decimals(tag::value_transformation, tag::slope)).value_or(1);
  slice.intercept = first_of(facts.decimals(tag::value_transformation, tag::intercept)).value_or(0);
  return slice;
}

/// Sets the unit of the values behind their scaling, and what is told of it.
void set_unit(const DicomDataSet& data, DicomImage& image) {
  const std::string type = data.text(tag::rescale_type);
  if (type == "HU") image.unit = type;
  if (image.modality == "PT") {
    const std::string unit = data.text(tag::pet_units);
    image.unit = unit == "BQML" ? "Bq/ml" : unit == "GML" ? "g/ml" : std::string();
  }
  if (image.modality != "RTDOSE") return;
  const std::string units = data.text(tag::dose_units);
  std::string note = "radiation dose";
  if (data.decimals(tag::dose_scaling).empty()) {
    note += " without DoseGridScaling (3004,000E): the values are the stored numbers, in no unit";
  } else if (units == "GY") {
    image.unit = "Gy";
    note += " in Gy";
  } else if (units == "RELATIVE") {
    image.unit = "relative";
    note += " relative to a reference that the file does not name (DoseUnits RELATIVE)";
  } else {
    note += " in a unit that is not known (DoseUnits \"" + units + "\")";
  }
  const std::string summation = data.text(tag::dose_summation);
  if (!summation.empty()) note += ", DoseSummationType " + summation;
  image.notes.push_back(note);
}

/// Positions of the frames of a file without functional groups, by a vector of the file.
class FramePlaces {
 public:
  FramePlaces(const DicomDataSet& data, int frames) {
    const DicomSlice first = slice_of(FrameFacts(data, nullptr));
    const auto [row, column] =
        first.orientation.value_or(std::array{Vec3<double>{1, 0, 0}, Vec3<double>{0, 1, 0}});
    const Vec3<double> normal = normalized(cross(row, column));
    offsets_ = dicom_frame_offsets(data, frames, normal, first.position);
    direction_ = offsets_.along_z ? Vec3<double>{0, 0, 1} : normal;
    origin_ = first.position.value_or(Vec3<double>{});
    if (!offsets_.note.empty()) notes_.push_back(offsets_.note);
    if (!first.position) {
      notes_.emplace_back(
          "no position (ImagePositionPatient); the first frame stands at the origin");
    }
  }

  const std::string& refused() const { return offsets_.refused; }
  const std::vector<std::string>& notes() const { return notes_; }
  Vec3<double> operator[](int frame) const {
    return origin_ + direction_ * offsets_.offset[static_cast<std::size_t>(frame)];
  }

 private:
  DicomFrameOffsets offsets_;
  Vec3<double> direction_, origin_;
  std::vector<std::string> notes_;
};

}  // namespace

std::string DicomSlice::name() const {
  const std::string file = image->file.filename().string();
  return image->frames == 1 ? file : "frame " + std::to_string(frame + 1) + " of " + file;
}

std::uintmax_t dicom_frame_bytes(const DicomFormat& format) {
  return static_cast<std::uintmax_t>(format.columns) * static_cast<std::uintmax_t>(format.rows) *
         static_cast<std::uintmax_t>(format.samples) *
         static_cast<std::uintmax_t>(format.bits_allocated / 8);
}

void check_dicom_pixels(const DicomImage& image, int frames) {
  const std::uintmax_t needed =
      dicom_frame_bytes(image.format) * static_cast<std::uintmax_t>(frames);
  if (image.encapsulated || image.pixel_bytes >= needed) return;
  throw Error(image.file.string() + ": has " + std::to_string(image.pixel_bytes) +
              " bytes of pixels, but its header needs " + std::to_string(needed) +
              "; it is cut off or its header is wrong");
}

std::vector<DicomSlice> read_dicom_slices(const std::filesystem::path& path) {
  const ByteSource source = file_source(path);
  if (!is_dicom(source)) return {};
  const DicomFile file = parse_dicom(source);
  if (!file.has_pixels) return {};
  const DicomDataSet& data = file.data;

  auto image = std::make_shared<DicomImage>();
  image->file = path;
  image->study = data.text(tag::study);
  image->series = data.text(tag::series);
  image->description = data.text(tag::series_description);
  image->modality = data.text(tag::modality);
  image->photometric = data.text(tag::photometric);
  const double series_number = first_of(data.decimals(tag::series_number)).value_or(0);
  if (std::abs(series_number) < 1e9) {
    image->series_number = static_cast<std::int64_t>(series_number);
  }
  image->transfer_syntax = file.transfer_syntax;
  image->format = format_of(file);
  image->big_endian = data.big_endian;
  image->encapsulated = file.encapsulated;
  image->pixel_offset = file.pixel_offset;
  image->pixel_bytes = file.pixel_bytes;
  image->refused = refusal(*image, file);

  set_unit(data, *image);
  for (std::string& text : dicom_value_notes(data)) image->notes.push_back(std::move(text));

  const double frames = first_of(data.decimals(tag::frames)).value_or(1);
  const auto groups = data.sequences.find(tag::frame_groups);
  const bool has_groups = groups != data.sequences.end();
  if (!(frames >= 1) || frames > std::numeric_limits<std::uint16_t>::max() * 16.0) {
    image->refused = "its header says " + readable_number(frames) + " frames";
  } else if (has_groups && groups->second.size() != static_cast<std::size_t>(frames)) {
    image->refused = "it has " + std::to_string(static_cast<int>(frames)) + " frames, but places " +
                     "for " + std::to_string(groups->second.size());
  } else {
    image->frames = static_cast<int>(frames);
  }
  std::optional<FramePlaces> places;
  if (image->frames > 1 && !has_groups && image->refused.empty()) {
    places.emplace(data, image->frames);
    image->refused = places->refused();
    if (image->refused.empty()) {
      image->notes.insert(image->notes.end(), places->notes().begin(), places->notes().end());
    } else {
      image->frames = 1;
      places.reset();
    }
  }
  if (image->refused.empty()) check_dicom_pixels(*image, image->frames);

  std::vector<DicomSlice> slices;
  for (int frame = 0; frame < image->frames; ++frame) {
    const DicomDataSet* group = has_groups && image->refused.empty()
                                    ? &groups->second[static_cast<std::size_t>(frame)]
                                    : nullptr;
    const FrameFacts facts(data, group);
    if (image->refused.empty()) image->refused = refusal(facts);
    DicomSlice slice = slice_of(facts);
    if (places) slice.position = (*places)[frame];
    slice.image = image;
    slice.frame = frame;
    slice.number = first_of(data.decimals(tag::instance_number));
    slices.push_back(std::move(slice));
  }
  return slices;
}

}  // namespace pellucid

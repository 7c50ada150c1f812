// SPDX-License-Identifier: Apache-2.0
#include "dicom_marks.h"

#include <cmath>
#include <optional>

#include "text/readable_number.h"

namespace pellucid {

namespace {

enum class Kind { text, reals, whole, long_whole };

/// An element that may say a mark: of the file, or in this sequence of a functional group.
struct Place {
  std::size_t mark;
  DicomTag sequence, element;
  Kind kind;
};

// PS3.3 and PS3.6, in the order of `dicom_marks`. The element in a functional group comes first.
constexpr std::array places = std::to_array<Place>({{0, 0x00189226, 0x00089007, Kind::text},
                                                    {0, 0, 0x00080008, Kind::text},
                                                    {1, 0x00189226, 0x00089208, Kind::text},
                                                    {1, 0, 0x00089208, Kind::text},
                                                    {2, 0x00209111, 0x00209056, Kind::text},
                                                    {3, 0, 0x00180086, Kind::text},
                                                    {4, 0x00189114, 0x00189082, Kind::reals},
                                                    {4, 0, 0x00180081, Kind::text},
                                                    {5, 0, 0x00180082, Kind::text},
                                                    {6, 0x00189117, 0x00189087, Kind::reals},
                                                    {6, 0, 0x00189087, Kind::reals},
                                                    {7, 0, 0x00189089, Kind::reals},
                                                    {8, 0x00209111, 0x00209128, Kind::long_whole},
                                                    {8, 0, 0x00200100, Kind::text},
                                                    {9, 0, 0x00181210, Kind::text},
                                                    {10, 0, 0x00541300, Kind::text},
                                                    {11, 0x00209111, 0x00209156, Kind::whole},
                                                    {11, 0, 0x00200012, Kind::text},
                                                    {12, 0, 0x00181060, Kind::text},
                                                    {13, 0, 0x00080032, Kind::text}});

std::string value_of(const DicomDataSet& data, const Place& place) {
  std::string text;
  switch (place.kind) {
    case Kind::text:
      return data.text(place.element);
    case Kind::reals:
      for (const double number : data.reals(place.element)) {
        text += (text.empty() ? "" : "\\") + readable_number(number);
      }
      return text;
    case Kind::whole:
      if (const auto number = data.number(place.element)) text = std::to_string(*number);
      return text;
    case Kind::long_whole:
      for (const DicomTag number : data.tags(place.element)) {
        // Halves as in tags; those of a number of four bytes come the other way round.
        text = std::to_string(data.big_endian ? number : number >> 16 | number << 16);
      }
      return text;
  }
  return text;
}

std::string padding_note(const DicomDataSet& file) {
  constexpr DicomTag value = 0x00280120, limit = 0x00280121, representation = 0x00280103;
  const bool is_signed = file.number(representation).value_or(0) == 1;
  const auto number = [&](DicomTag tag) -> std::optional<int> {
    const std::optional<int> stored = file.number(tag);
    constexpr int half = 1 << 15;
    if (!stored || !is_signed || *stored < half) return stored;
    return *stored - 2 * half;
  };
  const std::optional<int> first = number(value), last = number(limit);
  if (!first) return {};
  return "stored values " + std::to_string(*first) +
         (last ? " to " + std::to_string(*last) + " (PixelPaddingValue, PixelPaddingRangeLimit)"
               : " (PixelPaddingValue)") +
         " stand for pixels without data; they are read as values";
}

/// Returns a note if the mapping to real values says another scale than the rescale slope and
/// intercept.
std::string mapping_note(const DicomDataSet& file) {
  constexpr DicomTag mappings = 0x00409096, slope = 0x00409225, intercept = 0x00409224;
  const DicomDataSet* item = file.item(mappings);
  for (const DicomTag groups : {DicomTag{0x52009229}, DicomTag{0x52009230}}) {
    if (item == nullptr && file.item(groups) != nullptr) item = file.item(groups)->item(mappings);
  }
  if (item == nullptr) return {};
  const auto rescale = [&](DicomTag tag, double otherwise) {
    std::vector<double> numbers = file.decimals(tag);
    for (const DicomTag groups : {DicomTag{0x52009229}, DicomTag{0x52009230}}) {
      const DicomDataSet* group = file.item(groups);
      const DicomDataSet* transformation = group == nullptr ? nullptr : group->item(0x00289145);
      if (numbers.empty() && transformation != nullptr) numbers = transformation->decimals(tag);
    }
    return numbers.empty() ? otherwise : numbers.front();
  };
  const std::vector<double> a = item->reals(slope), b = item->reals(intercept);
  if (!a.empty() && !b.empty() && a.front() == rescale(0x00281053, 1) &&
      b.front() == rescale(0x00281052, 0)) {
    return {};
  }
  return "RealWorldValueMappingSequence says what the values mean" +
         (a.empty() || b.empty() ? std::string(" by a table")
                                 : " (slope " + readable_number(a.front()) + ", intercept " +
                                       readable_number(b.front()) + ")") +
         ", which is not taken into account; the values are those of RescaleSlope and "
         "RescaleIntercept";
}

}  // namespace

std::vector<std::string> dicom_mark_values(const DicomDataSet& file,
                                           const std::array<const DicomDataSet*, 2>& groups) {
  std::vector<std::string> values(dicom_marks.size());
  for (const Place& place : places) {
    std::string& value = values[place.mark];
    if (!value.empty()) continue;
    if (place.sequence == 0) {
      value = value_of(file, place);
      continue;
    }
    for (const DicomDataSet* group : groups) {
      const DicomDataSet* item = group == nullptr ? nullptr : group->item(place.sequence);
      if (item != nullptr && value.empty()) value = value_of(*item, place);
    }
  }
  return values;
}

std::vector<std::string> dicom_value_notes(const DicomDataSet& file) {
  std::vector<std::string> notes;
  const auto add = [&](std::string note) {
    if (!note.empty()) notes.push_back(std::move(note));
  };
  add(padding_note(file));
  add(mapping_note(file));
  constexpr DicomTag shape = 0x20500020, palette = 0x00281101, overlay = 0x60000010,
                     relationship = 0x00281040, aspect = 0x00280034, spacing = 0x00280030;
  if (file.text(shape) == "INVERSE") {
    add("large values are meant to be dark (PresentationLUTShape INVERSE); they are read as they "
        "are");
  }
  if (!file.whole_numbers(palette).empty()) {
    add("a supplemental palette (RedPaletteColorLookupTableDescriptor) gives colors to some "
        "values, "
        "which is not taken into account");
  }
  if (file.number(overlay)) add("an overlay (OverlayData) is not shown");
  if (file.text(relationship) == "LOG") {
    add("the values are logarithms (PixelIntensityRelationship LOG); they are read as they are");
  }
  const std::vector<double> ratio = file.decimals(aspect);
  if (file.decimals(spacing).size() != 2 && ratio.size() == 2 && ratio[0] != ratio[1]) {
    add("PixelAspectRatio is not taken into account; give the spacing");
  }
  return notes;
}

}  // namespace pellucid

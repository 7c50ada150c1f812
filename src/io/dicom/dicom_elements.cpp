// SPDX-License-Identifier: Apache-2.0
//
// DICOM PS3.5, section 7: a data set is a list of elements, each a tag, with explicit types two
// letters (VR), a length and a value. A sequence (SQ) holds items, each a data set again; a length
// of 0xffffffff means that a delimiter ends it. PS3.10: 128 bytes, "DICM", and group 2, which is
// explicit and little-endian, stand before the data set and say how it is written.

#include "dicom_elements.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

constexpr std::uint32_t undefined = 0xffffffff;
constexpr DicomTag item_tag = 0xfffee000, item_end = 0xfffee00d, sequence_end = 0xfffee0dd;
constexpr DicomTag transfer_syntax_tag = 0x00020010;
// Of float, of double, of whole numbers.
constexpr std::array<DicomTag, 3> pixel_tags{0x7fe00008, 0x7fe00009, 0x7fe00010};

constexpr std::array wanted_values = std::to_array<DicomTag>(
    {0x00080008, 0x00020010, 0x00080016, 0x00080060, 0x0008103e, 0x00180050, 0x00180088, 0x0020000e,
     0x00200011, 0x00200013, 0x00200032, 0x00200037, 0x00280002, 0x00280004, 0x00280006, 0x00280008,
     0x00280009, 0x00280010, 0x00280011, 0x00280030, 0x00280100, 0x00280101, 0x00280102, 0x00280103,
     0x00281052, 0x00281053, 0x00281054, 0x0020000d, 0x00180081, 0x00200012, 0x00181063, 0x00181065,
     0x00182005, 0x00540010, 0x00540020, 0x00540030, 0x00540050, 0x00540060, 0x00540070, 0x00540080,
     0x00540090, 0x00540100, 0x00541001, 0x30040002, 0x3004000a, 0x3004000c, 0x3004000e,
     // What tells volumes of one series apart (dicom_marks.cpp).
     0x00089007, 0x00080032, 0x00089208, 0x00209056, 0x00180086, 0x00189082, 0x00180082, 0x00189087,
     0x00189089, 0x00209128, 0x00200100, 0x00181210, 0x00541300, 0x00209156, 0x00181060,
     // What the values mean, and where slices stand without positions.
     0x00201041, 0x00280120, 0x00280121, 0x00409224, 0x00409225, 0x20500020, 0x00281101, 0x60000010,
     0x00281040, 0x00280034});
// One number for each frame of a file.
constexpr std::array wanted_vectors = std::to_array<DicomTag>(
    {0x00181065, 0x00182005, 0x00540010, 0x00540020, 0x00540030, 0x00540050, 0x00540060, 0x00540070,
     0x00540080, 0x00540090, 0x00540100, 0x3004000c});
// Functional groups, shared and of each frame; what stands in them of place and value; the modality
// lookup table; the detectors of nuclear medicine; the mapping to real values.
constexpr std::array wanted_sequences = std::to_array<DicomTag>(
    {0x52009229, 0x52009230, 0x00209113, 0x00209116, 0x00289110, 0x00289145, 0x00283000, 0x00540022,
     0x00189226, 0x00209111, 0x00189114, 0x00189117, 0x00409096});

constexpr std::string_view short_types =
    "AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US";
constexpr std::string_view long_types = "OB OD OF OL OV OW SQ SV UC UN UR UT UV";

template <class List>
bool contains(const List& list, DicomTag tag) {
  return std::ranges::find(list, tag) != list.end();
}

struct Encoding {
  bool explicit_types = true, big_endian = false;
};

struct Element {
  DicomTag tag = 0;
  std::string type;  // empty where types are implicit
  std::uint32_t length = 0;
  std::uintmax_t value = 0;  // where it begins
};

std::string in_hexadecimal(DicomTag tag) {
  std::string text = "(gggg,eeee)";
  for (std::size_t digit = 0; digit < 8; ++digit) {
    text[digit < 4 ? 1 + digit : 2 + digit] = "0123456789ABCDEF"[(tag >> (28 - 4 * digit)) & 15];
  }
  return text;
}

class Parser {
 public:
  explicit Parser(const ByteSource& source) : source_(source) {}

  DicomFile parse() {
    std::uintmax_t at = begin().value_or(0);
    DicomDataSet meta;
    at = meta_group(at, meta);
    file_.transfer_syntax = meta.text(transfer_syntax_tag);
    encoding_ = encoding_at(at);
    file_.data.big_endian = encoding_.big_endian;
    data_set(at, source_.size, false, encoding_, 0, &file_.data);
    return std::move(file_);
  }

  /// Returns the position of the first element; nothing if the file is no DICOM file.
  std::optional<std::uintmax_t> begin() {
    constexpr std::uintmax_t preamble = 128, magic = 4;
    if (has_magic(preamble)) return preamble + magic;
    for (const std::uintmax_t at : {std::uintmax_t{0}, preamble, preamble + magic}) {
      if (begins_elements(at)) return at;
    }
    if (has_magic(0) && begins_elements(magic)) return magic;
    return std::nullopt;
  }

 private:
  bool has_magic(std::uintmax_t at) {
    if (at + 4 > source_.size) return false;
    return std::ranges::equal(bytes(at, 4), std::string_view("DICM"), {},
                              [](std::byte b) { return std::to_integer<char>(b); });
  }

  // The type of the element, as explicit files have it; empty where it is none of PS3.5, 6.2.
  std::string type_at(std::uintmax_t at) {
    if (at + 6 > source_.size) return {};
    std::string type;
    for (const std::byte b : bytes(at + 4, 2)) type += std::to_integer<char>(b);
    const bool is_one = std::ranges::all_of(type, [](char c) { return c >= 'A' && c <= 'Z'; }) &&
                        (short_types.find(type) != std::string_view::npos ||
                         long_types.find(type) != std::string_view::npos);
    return is_one ? type : std::string();
  }

  // The groups at the start are below 9.
  bool is_big_endian(std::uintmax_t at) { return tag_at(at, true) >> 16 <= 8; }

  // Without a magic number: elements in ascending order, the first of group 2 or 8, with types, or
  // all of group 8 with the short values that stand there.
  bool begins_elements(std::uintmax_t at) {
    if (at + 8 > source_.size) return false;
    const Encoding encoding{!type_at(at).empty(), is_big_endian(at)};
    const DicomTag first = tag_at(at, encoding.big_endian);
    const bool is_meta = first >> 16 == 2 && encoding.explicit_types && !encoding.big_endian;
    if (!is_meta && first >> 16 != 8) return false;
    if ((first & 0xffff) > 0xff) return false;
    constexpr std::uint32_t longest = 1024;
    const int enough = encoding.explicit_types ? 2 : 3;
    DicomTag before = 0;
    for (int elements = 0; elements < enough; ++elements) {
      if (at + (encoding.explicit_types ? 12 : 8) > source_.size) return elements > 0;
      if (encoding.explicit_types && type_at(at).empty()) return false;
      const Element element = element_at(at, encoding);
      if (elements > 0 && element.tag <= before) return false;
      if (!encoding.explicit_types && elements < 2 &&
          (element.tag >> 16 != 8 || element.length > longest || element.length % 2 != 0)) {
        return false;
      }
      if (element.value > source_.size || element.length > source_.size - element.value) {
        return elements > 0;
      }
      before = element.tag;
      at = element.value + element.length;
    }
    return true;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(source_.name + ": the DICOM header " + what + "; the file is cut off or damaged");
  }

  // Some elements are read at once: they are short, and there are a hundred in a file.
  std::span<const std::byte> bytes(std::uintmax_t from, std::size_t count) {
    if (from > source_.size || source_.size - from < count) fail("ends too early");
    if (from < window_begin_ || from + count > window_begin_ + window_.size()) {
      constexpr std::uintmax_t at_once = 1 << 14;
      const std::uintmax_t size =
          std::min(source_.size - from, std::max<std::uintmax_t>(at_once, count));
      window_.resize(size);
      source_.read(from, window_);
      window_begin_ = from;
    }
    return std::span(window_).subspan(from - window_begin_, count);
  }

  std::uint32_t number(std::uintmax_t from, std::size_t size, bool big_endian) {
    const std::span<const std::byte> raw = bytes(from, size);
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      value = value << 8 | std::to_integer<std::uint32_t>(raw[big_endian ? i : size - 1 - i]);
    }
    return value;
  }

  DicomTag tag_at(std::uintmax_t at, bool big_endian) {
    return number(at, 2, big_endian) << 16 | number(at + 2, 2, big_endian);
  }

  Element element_at(std::uintmax_t at, const Encoding& encoding) {
    Element element;
    element.tag = tag_at(at, encoding.big_endian);
    if (!encoding.explicit_types || element.tag >> 16 == 0xfffe) {
      element.length = number(at + 4, 4, encoding.big_endian);
      element.value = at + 8;
      return element;
    }
    for (const std::byte b : bytes(at + 4, 2)) element.type += std::to_integer<char>(b);
    if (!std::ranges::all_of(element.type, [](char c) { return c >= 'A' && c <= 'Z'; })) {
      fail("has no type at element " + in_hexadecimal(element.tag));
    }
    if (long_types.find(element.type) == std::string_view::npos) {
      element.length = number(at + 6, 2, encoding.big_endian);
      element.value = at + 8;
    } else {
      element.length = number(at + 8, 4, encoding.big_endian);
      element.value = at + 12;
    }
    return element;
  }

  std::uintmax_t meta_group(std::uintmax_t at, DicomDataSet& meta) {
    const Encoding encoding;
    while (at + 8 <= source_.size && tag_at(at, false) >> 16 == 2) {
      const Element element = element_at(at, encoding);
      check_length(element, source_.size);
      keep(element, meta);
      at = element.value + element.length;
    }
    return at;
  }

  // PS3.5, annex A. A file without group 2 shows it by its first element. So does one that is not
  // written as group 2 says.
  Encoding encoding_at(std::uintmax_t at) {
    const std::string& syntax = file_.transfer_syntax;
    if (syntax == "1.2.840.10008.1.2.2") return {true, true};
    if (syntax == "1.2.840.10008.1.2.1.99") {
      throw Error(source_.name +
                  ": deflated DICOM is not read; convert it to explicit little endian");
    }
    const bool says_explicit = syntax != "1.2.840.10008.1.2";
    if (at + 8 > source_.size) return {says_explicit, false};
    if (!type_at(at).empty()) return {true, syntax.empty() && is_big_endian(at)};
    if (syntax.empty()) return {false, is_big_endian(at)};
    const bool fits_implicit = number(at + 4, 4, false) <= source_.size - at - 8;
    return {says_explicit && !fits_implicit, false};
  }

  void check_length(const Element& element, std::uintmax_t end) const {
    if (element.value <= end && element.length <= end - element.value) return;
    fail("says that element " + in_hexadecimal(element.tag) + " has " +
         std::to_string(element.length) + " bytes, more than there are");
  }

  void keep(const Element& element, DicomDataSet& set) {
    // Text of more is none of ours.
    constexpr std::uint32_t longest = 4096, longest_vector = 1 << 24;
    if (!contains(wanted_values, element.tag)) return;
    if (element.length > (contains(wanted_vectors, element.tag) ? longest_vector : longest)) return;
    std::string& value = set.values[element.tag];
    value.clear();
    for (const std::byte b : bytes(element.value, element.length)) {
      value += std::to_integer<char>(b);
    }
  }

  // Where the set ends. `set` is null where nothing of it is wanted.
  std::uintmax_t data_set(std::uintmax_t at, std::uintmax_t end, bool delimited,
                          const Encoding& encoding, int depth, DicomDataSet* set) {
    // Standard objects nest some five deep.
    constexpr int deepest = 32;
    if (depth > deepest) fail("nests its sequences too deep");
    // A byte or some of padding may stand at the end of a file.
    while (delimited || (depth > 0 ? at < end : at + 8 <= end)) {
      const Element element = element_at(at, encoding);
      if (delimited && element.tag == item_end) return element.value;
      if (depth == 0 && contains(pixel_tags, element.tag)) {
        file_.has_pixels = true;
        file_.pixel_tag = element.tag;
        file_.pixel_offset = element.value;
        file_.encapsulated = element.length == undefined;
        // How much there is of it is asked for together with how much is needed.
        file_.pixel_bytes = std::min<std::uintmax_t>(
            file_.encapsulated ? undefined : element.length, source_.size - element.value);
        if (file_.encapsulated) check_fragments(element.value, encoding);
        return source_.size;
      }
      if (element.length == undefined && (element.type == "OB" || element.type == "OW")) {
        at = fragments(element.value, end, encoding);
      } else if (element.length == undefined || element.type == "SQ" ||
                 (element.type.empty() && is_wanted_sequence(element.tag))) {
        at = sequence(element, end, encoding, depth, set);
      } else {
        check_length(element, end);
        if (set != nullptr) keep(element, *set);
        at = element.value + element.length;
      }
    }
    return at;
  }

  static bool is_wanted_sequence(DicomTag tag) { return contains(wanted_sequences, tag); }

  std::uintmax_t sequence(const Element& element, std::uintmax_t end, Encoding encoding, int depth,
                          DicomDataSet* set) {
    const bool delimited = element.length == undefined;
    if (!delimited) {
      check_length(element, end);
      end = element.value + element.length;
    }
    const bool wanted = set != nullptr && is_wanted_sequence(element.tag);
    if (!wanted && !delimited) return end;
    // PS3.5, 6.2.2: a sequence of unknown type is written implicitly.
    if (element.type == "UN") encoding = {false, false};
    std::vector<DicomDataSet> items;
    std::uintmax_t at = element.value;
    while (delimited || at < end) {
      const Element item = element_at(at, encoding);
      if (delimited && item.tag == sequence_end) {
        at = item.value;
        break;
      }
      if (item.tag != item_tag) fail("has " + in_hexadecimal(item.tag) + " instead of an item");
      DicomDataSet* into = nullptr;
      if (wanted) {
        // One for each frame of a film of hours.
        constexpr std::size_t most = std::size_t{1} << 20;
        if (items.size() == most) fail("has too many items in a sequence");
        into = &items.emplace_back();
        into->big_endian = encoding.big_endian;
      }
      if (item.length == undefined) {
        at = data_set(item.value, end, true, encoding, depth + 1, into);
        continue;
      }
      check_length(item, end);
      at = item.value + item.length;
      if (wanted) data_set(item.value, at, false, encoding, depth + 1, into);
    }
    if (wanted) set->sequences[element.tag] = std::move(items);
    return at;
  }

  std::uintmax_t fragments(std::uintmax_t at, std::uintmax_t end, const Encoding& encoding) {
    for (;;) {
      const Element item = element_at(at, encoding);
      check_length(item, end);
      at = item.value + item.length;
      if (item.tag == sequence_end) return at;
      if (item.tag != item_tag) fail("has " + in_hexadecimal(item.tag) + " instead of a fragment");
    }
  }

  // That none of the compressed pixels are cut off. Some writers leave out the last delimiter.
  void check_fragments(std::uintmax_t at, const Encoding& encoding) {
    while (at + 8 <= source_.size) {
      const Element item = element_at(at, encoding);
      if (item.tag != item_tag) return;
      check_length(item, source_.size);
      at = item.value + item.length;
    }
  }

  const ByteSource& source_;
  DicomFile file_;
  Encoding encoding_;
  std::vector<std::byte> window_;
  std::uintmax_t window_begin_ = 0;
};

}  // namespace

bool is_dicom(const ByteSource& source) {
  return Parser(source).begin().has_value();
}

DicomFile parse_dicom(const ByteSource& source) {
  return Parser(source).parse();
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
//
// The format: "VTK File Formats", XML. Arrays stand as text or in base64 between the tags, or at an
// offset behind the "_" of AppendedData, raw or in base64. Bytes begin with their number; those of
// compressed blocks with the number of blocks, the size of a block, that of the last one if it is
// smaller, and what each takes.
#include "vtk_xml_arrays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <type_traits>
#include <utility>

#include "files/input_file.h"
#include "files/mapped_file.h"
#include "pellucid/scene/error.h"
#include "text/text.h"
#include "text/xml_scanner.h"
#include "vtk_xml_bytes.h"
#include "vtk_xml_numbers.h"

namespace pellucid {

namespace {

std::string_view attribute(const XmlTag& tag, const char* name) {
  const auto found = tag.attributes.find(name);
  return found == tag.attributes.end() ? std::string_view{} : found->second;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 100;
  return "\"" + one_line(std::string(text.substr(0, longest))) + "\"";
}

bool is_sound(double number) {
  return std::isfinite(number);
}

/// Returns whether a number of points is far from what differences and products hold.
bool is_sound(std::int64_t number) {
  constexpr std::int64_t most = std::int64_t{1} << 30;
  return number > -most && number < most;
}

/// Returns the numbers of an attribute; nothing where it is not there. Throws Error unless they are
/// `count` sound ones: VTK takes its default for others.
template <class Number, std::size_t count>
std::optional<std::array<Number, count>> numbers_of(const XmlTag& tag, const char* name) {
  const std::string_view given = attribute(tag, name);
  if (given.empty()) return std::nullopt;
  const std::optional<std::vector<Number>> found = numbers_in<Number>(given);
  const auto are_sound = [](Number number) { return is_sound(number); };
  if (!found || found->size() != count || !std::ranges::all_of(*found, are_sound)) {
    throw Error(std::string("its ") + name + " is " + in_quotes(given) + ", but must be " +
                std::to_string(count) +
                (std::is_integral_v<Number> ? " whole numbers" : " finite numbers") +
                "; mend the file");
  }
  std::array<Number, count> numbers{};
  std::ranges::copy(*found, numbers.begin());
  return numbers;
}

/// Returns a piece's number of points or cells; 0: it is not there. Throws Error where it is none.
std::uint64_t count_of(const XmlTag& tag, const char* name) {
  const std::string_view given = without_blanks(attribute(tag, name));
  if (given.empty()) return 0;
  if (const auto number = number_of_word<std::uint64_t>(given)) return *number;
  throw Error(std::string("a piece has the ") + name + " " + in_quotes(given) +
              ", which is no whole number from 0 on; mend the file");
}

/// Walks through the tags of a file.
class FileReader {
 public:
  explicit FileReader(std::string_view text)
      : text_(text), scanner_(text, name_), appended_(find_appended()) {}

  VtkXmlFile read() {
    while (const std::optional<XmlTag> tag = scanner_.next()) {
      if (tag->name == "AppendedData") break;
      if (tag->closes) {
        leave(tag->name);
      } else {
        enter(*tag);
      }
    }
    measure();
    return std::move(file_);
  }

 private:
  struct Appended {
    std::string_view bytes;
    bool base64 = false;
  };

  /// An array in binary, by its index among those of a piece.
  struct InBinary {
    std::size_t piece, array;
    std::string_view text;                ///< between the tags, in base64
    std::optional<std::uint64_t> offset;  ///< else from there in what is appended
  };

  std::optional<Appended> find_appended() const {
    const std::size_t at = text_.find("<AppendedData");
    if (at == std::string_view::npos) return std::nullopt;
    const std::size_t end = text_.find('>', at), begin = text_.find('_', end);
    if (begin == std::string_view::npos) return std::nullopt;
    const std::string_view tag = text_.substr(at, end - at);
    const std::size_t close = text_.rfind("</AppendedData");
    const std::size_t size = close == text_.npos || close <= begin ? text_.npos : close - begin - 1;
    return Appended{text_.substr(begin + 1, size), tag.find("\"raw\"") == text_.npos};
  }

  void enter(const XmlTag& tag) {
    static const std::map<std::string_view, VtkSection> sections{
        {"PointData", VtkSection::point_data},
        {"CellData", VtkSection::cell_data},
        {"Points", VtkSection::points},
        {"Cells", VtkSection::cells},
        {"Coordinates", VtkSection::coordinates},
        {"PPointData", VtkSection::point_data},
        {"PCellData", VtkSection::cell_data},
        {"PPoints", VtkSection::points},
        {"PCells", VtkSection::cells},
        {"PCoordinates", VtkSection::coordinates}};
    if (const auto offset =
            number_of_word<std::uint64_t>(without_blanks(attribute(tag, "offset")))) {
      begins_.insert(*offset);
    }
    if (tag.name == "VTKFile") {
      file_.kind = attribute(tag, "type");
      coding_.big_endian = attribute(tag, "byte_order") == "BigEndian";
      coding_.header_size = attribute(tag, "header_type") == "UInt64" ? 8 : 4;
      coding_.compressed = !attribute(tag, "compressor").empty();
    } else if (tag.name == file_.kind) {
      enter_grid(tag);
    } else if (tag.name == "Piece") {
      enter_piece(tag);
    } else if (tag.name == "DataSet") {
      if (const std::string_view name = attribute(tag, "file"); !name.empty()) {
        file_.files.push_back(xml_text(name));
      }
    } else if (const auto section = sections.find(tag.name); section != sections.end()) {
      if (!tag.closed) section_ = section->second;
    } else if ((tag.name == "DataArray" || tag.name == "PDataArray") && section_) {
      enter_array(tag);
    }
  }

  void leave(std::string_view name) {
    for (const std::string_view section :
         {"PointData", "CellData", "Points", "Cells", "Coordinates"}) {
      if (name == section || (name.starts_with('P') && name.substr(1) == section)) {
        section_.reset();
      }
    }
  }

  void enter_grid(const XmlTag& tag) {
    file_.place.origin = numbers_of<double, 3>(tag, "Origin");
    file_.place.spacing = numbers_of<double, 3>(tag, "Spacing");
    file_.place.direction = numbers_of<double, 9>(tag, "Direction");
    file_.whole = numbers_of<std::int64_t, 6>(tag, "WholeExtent");
    const std::string times = xml_text(attribute(tag, "TimeValues"));
    const auto found = numbers_in<double>(times);
    if (!found || !std::ranges::all_of(*found, [](double time) { return std::isfinite(time); })) {
      throw Error("its TimeValues are " + in_quotes(times) +
                  ", which are no finite numbers; mend the "
                  "file");
    }
    file_.times = *found;
  }

  void enter_piece(const XmlTag& tag) {
    VtkXmlPiece piece;
    piece.source = xml_text(attribute(tag, "Source"));
    piece.points = count_of(tag, "NumberOfPoints");
    piece.cells = count_of(tag, "NumberOfCells");
    if (const auto extent = numbers_of<std::int64_t, 6>(tag, "Extent")) {
      piece.extent = *extent;
      piece.points = piece.cells = 1;
      for (std::size_t a = 0; a < 6; a += 2) {
        const std::int64_t side = piece.extent[a + 1] - piece.extent[a] + 1;
        if (side < 1) piece.points = piece.cells = 0;
        piece.points *= static_cast<std::uint64_t>(std::max(side, std::int64_t{0}));
        piece.cells *= static_cast<std::uint64_t>(std::max(side - 1, std::int64_t{1}));
        constexpr std::uint64_t most = std::uint64_t{1} << 33;
        if (piece.points > most) throw Error("a piece of that many points is too large");
      }
    }
    file_.pieces.push_back(std::move(piece));
  }

  void enter_array(const XmlTag& tag) {
    const bool is_listed = tag.name == "PDataArray" || file_.pieces.empty();
    std::vector<VtkXmlArray>& arrays = is_listed ? file_.listed : file_.pieces.back().arrays;
    arrays.push_back(head_of(tag));
    VtkXmlArray& array = arrays.back();
    if (tag.name == "PDataArray" || size_of_vtk_type(array.type) == 0) return;
    const std::string_view format = attribute(tag, "format"), offset = attribute(tag, "offset");
    InBinary binary{file_.pieces.size() - 1, arrays.size() - 1, tag.text, std::nullopt};
    // VTK goes by the offset, and takes each format that it does not know for text.
    if (!offset.empty()) {
      binary.offset = number_of_word<std::uint64_t>(without_blanks(offset));
      if (!without_blanks(tag.text).empty()) {
        array.fault = "has an offset, and values of its own";
      } else if (!appended_) {
        array.fault = "is appended, but the file has no AppendedData";
      } else if (!binary.offset || *binary.offset >= appended_->bytes.size()) {
        array.fault = "has the offset " + in_quotes(offset) +
                      ", but AppendedData has the bytes 0 to " +
                      std::to_string(appended_->bytes.size());
      }
    } else if (format == "ascii" || format.empty()) {
      CountedNumbers counted = count_numbers(tag.text, array.type);
      array.values = counted.count;
      array.stop = std::move(counted.stop);
      return;
    } else if (format != "binary") {
      array.fault = format == "appended" ? "is appended, but has no offset"
                                         : "has the format " + in_quotes(format) +
                                               ", which is not ascii, binary or appended";
    }
    if (array.fault.empty() && !is_listed) in_binary_.push_back(binary);
  }

  /// Returns what an array is, without its values.
  VtkXmlArray head_of(const XmlTag& tag) const {
    VtkXmlArray array;
    array.section = *section_;
    array.name = xml_text(attribute(tag, "Name"));
    array.type = attribute(tag, "type");
    array.is_bits = array.type == "Bit";
    const bool is_of_points = array.section == VtkSection::point_data;
    if (array.name.empty() && (is_of_points || array.section == VtkSection::cell_data)) {
      throw Error(std::string("an array of ") + (is_of_points ? "points" : "cells") +
                  " has no name; write it into the element as Name");
    }
    const auto refuse = [&](const char* name, const std::string& must_be) {
      throw Error("the array " + in_quotes(array.name) + " has the " + name + " " +
                  in_quotes(attribute(tag, name)) + ", but must have " + must_be +
                  "; mend the file");
    };
    if (const auto steps = numbers_in<int>(attribute(tag, "TimeStep"))) {
      array.steps = *steps;
    } else {
      refuse("TimeStep", "numbers of steps");
    }
    const std::string_view components = without_blanks(attribute(tag, "NumberOfComponents"));
    constexpr std::int64_t most = std::int64_t{1} << 20;
    array.components =
        components.empty() ? 1 : number_of_word<std::int64_t>(components).value_or(-1);
    if (array.components < 0 || array.components > most) {
      refuse("NumberOfComponents", "a whole number from 1 to " + std::to_string(most));
    }
    array.components = std::max(array.components, std::int64_t{1});
    return array;
  }

  /// Returns the bytes of an array, up to the next one that is appended.
  VtkXmlBytes bytes_of(const InBinary& binary) const {
    if (!binary.offset) return {binary.text, true};
    const auto next = begins_.upper_bound(*binary.offset);
    const std::uint64_t size = next == begins_.end() ? text_.npos : *next - *binary.offset;
    return {appended_->bytes.substr(*binary.offset, size), appended_->base64};
  }

  /// Counts the values of arrays in binary. Throws Error where all that can be told of their
  /// headers says that header_type is wrong: VTK would show values shifted by one.
  void measure() {
    VtkXmlCoding other = coding_;
    other.header_size = 4 + 8 - coding_.header_size;
    bool is_right = false, is_other = false;
    for (const InBinary& binary : in_binary_) {
      VtkXmlArray& array = file_.pieces[binary.piece].arrays[binary.array];
      const VtkXmlBytes bytes = bytes_of(binary);
      is_right = is_right || bytes.is_filled(coding_);
      is_other = is_other || bytes.is_filled(other);
      std::uint64_t count = bytes.said(coding_).value_or(0);
      if (const std::uint64_t most = bytes.available(coding_);
          !coding_.compressed && count > most) {
        array.is_cut = true;
        count = most;
      }
      array.values = count / size_of_vtk_type(array.type) * (array.is_bits ? 8 : 1);
    }
    if (is_right || !is_other) return;
    throw Error("the headers of its binary arrays have " + std::to_string(8 * other.header_size) +
                " bits, but its header_type, UInt32 where none is given, says " +
                std::to_string(8 * coding_.header_size) + "; write header_type=\"UInt" +
                std::to_string(8 * other.header_size) + "\" into its element VTKFile");
  }

  const std::string name_ = "its XML";
  std::string_view text_;
  XmlScanner scanner_;
  std::optional<Appended> appended_;
  VtkXmlFile file_;
  std::optional<VtkSection> section_;
  VtkXmlCoding coding_;
  std::vector<InBinary> in_binary_;
  std::set<std::uint64_t> begins_;  ///< where arrays begin in what is appended
};

}  // namespace

VtkXmlFile read_vtk_xml(const std::filesystem::path& path) {
  const std::size_t size = check_input_file(path);
  if (size == 0) return {};
  const std::shared_ptr<const std::byte> bytes = map_file(path, size);
  if (!bytes) throw Error("cannot be mapped into memory; copy it to a local disk");
  return parse_vtk_xml({reinterpret_cast<const char*>(bytes.get()), size});
}

VtkXmlFile parse_vtk_xml(std::string_view text) {
  return FileReader(text).read();
}

}  // namespace pellucid

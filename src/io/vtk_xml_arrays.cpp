// SPDX-License-Identifier: Apache-2.0
//
// The format: "VTK File Formats", XML. Arrays stand as text or in base64 between the tags, or at an
// offset behind the "_" of AppendedData, raw or in base64. Bytes begin with their number; those of
// compressed blocks with the number of blocks, the size of a block, that of the last one if it is
// smaller, and what each takes.
#include "vtk_xml_arrays.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <system_error>

#include "input_file.h"
#include "mapped_file.h"
#include "pellucid/scene/error.h"
#include "text.h"
#include "xml_scanner.h"

namespace pellucid {

namespace {

bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

std::string_view without_spaces_in_front(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  return text;
}

std::string_view attribute(const XmlTag& tag, const char* name) {
  const auto found = tag.attributes.find(name);
  return found == tag.attributes.end() ? std::string_view{} : found->second;
}

/// Returns a name without XML's entities.
std::string plain_text(std::string_view text) {
  static const std::map<std::string_view, char> entities{
      {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
  std::string plain;
  while (!text.empty()) {
    const std::size_t end = text.front() == '&' ? text.find(';') : std::string_view::npos;
    const auto entity =
        end == std::string_view::npos ? entities.end() : entities.find(text.substr(1, end - 1));
    plain += entity == entities.end() ? text.front() : entity->second;
    text.remove_prefix(entity == entities.end() ? 1 : end + 1);
  }
  return plain;
}

template <class Number>
std::optional<Number> number_in(std::string_view text) {
  text = without_spaces_in_front(text);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  return number;
}

std::optional<VtkExtent> extent_in(std::string_view text) {
  VtkExtent extent{};
  for (std::int64_t& n : extent) {
    text = without_spaces_in_front(text);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    // Far from what differences and products hold.
    constexpr std::int64_t most = std::int64_t{1} << 30;
    if (error != std::errc() || n <= -most || n >= most) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  return extent;
}

/// Throws Error unless an attribute, where it is there, has that many finite numbers: VTK takes its
/// default for others.
void check_numbers(const XmlTag& tag, const char* name, int count) {
  const std::string_view given = attribute(tag, name);
  if (given.empty()) return;
  std::string_view text = given;
  int found = 0;
  for (text = without_spaces_in_front(text); !text.empty(); text = without_spaces_in_front(text)) {
    if (text.front() == '+') text.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const auto taken = static_cast<std::size_t>(end - text.data());
    const bool ends = taken == text.size() ||
                      without_spaces_in_front(text.substr(taken)).data() != text.data() + taken;
    if (error != std::errc() || !std::isfinite(number) || !ends) break;
    text.remove_prefix(taken);
    ++found;
  }
  if (found == count && text.empty()) return;
  constexpr std::size_t longest = 100;
  throw Error(std::string("its ") + name + " is \"" +
              one_line(std::string(given.substr(0, longest))) + "\", but must be " +
              std::to_string(count) + " finite numbers; mend the file");
}

/// Returns the bytes of a type's number; 0 where the type is not known.
std::uint64_t size_of(std::string_view type) {
  static const std::map<std::string_view, std::uint64_t> sizes{
      {"Int8", 1},  {"UInt8", 1},  {"Int16", 2}, {"UInt16", 2},  {"Int32", 4},   {"UInt32", 4},
      {"Int64", 8}, {"UInt64", 8}, {"Bit", 1},   {"Float32", 4}, {"Float64", 8}, {"vtkIdType", 8}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

/// Returns whether a whole number is one of its type's; VTK cuts others to its bits.
template <class Integer>
bool is_integer(std::string_view word) {
  Integer number{};
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  return error == std::errc() && stop == end;
}

/// Returns whether a word begins like a number of reals: with a digit, a point, "nan" or "inf".
bool is_real(std::string_view word) {
  if (word.starts_with('-')) word.remove_prefix(1);
  const auto letter = [&](std::size_t i) {
    const char c = i < word.size() ? word[i] : ' ';
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  };
  const bool is_name = (letter(0) == 'n' && letter(1) == 'a' && letter(2) == 'n') ||
                       (letter(0) == 'i' && letter(1) == 'n' && letter(2) == 'f');
  return is_name || letter(0) == '.' || (letter(0) >= '0' && letter(0) <= '9');
}

/// Returns what says whether a word is a number of the type.
bool (*number_test(std::string_view type))(std::string_view word) {
  static const std::map<std::string_view, bool (*)(std::string_view)> tests{
      {"Int8", is_integer<std::int8_t>},   {"UInt8", is_integer<std::uint8_t>},
      {"Int16", is_integer<std::int16_t>}, {"UInt16", is_integer<std::uint16_t>},
      {"Int32", is_integer<std::int32_t>}, {"UInt32", is_integer<std::uint32_t>},
      {"Int64", is_integer<std::int64_t>}, {"UInt64", is_integer<std::uint64_t>},
      {"Bit", is_integer<std::uint8_t>},   {"vtkIdType", is_integer<std::int64_t>}};
  const auto found = tests.find(type);
  return found == tests.end() ? is_real : found->second;
}

/// Counts the words of a text that are numbers of the type; sets `stop` to the first other one.
std::uint64_t count_numbers(std::string_view text, std::string_view type, std::string& stop) {
  const auto is_number = number_test(type);
  std::uint64_t count = 0;
  for (;;) {
    text = without_spaces_in_front(text);
    if (text.empty()) return count;
    const auto end = static_cast<std::size_t>(std::ranges::find_if(text, is_space) - text.begin());
    std::string_view word = text.substr(0, end);
    if (word.starts_with('+')) word.remove_prefix(1);
    if (!is_number(word)) {
      constexpr std::size_t longest = 20;
      stop = text.substr(0, std::min(end, longest));
      return count;
    }
    ++count;
    text.remove_prefix(end);
  }
}

int sextet(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// The bytes behind some place of the file, as they lie or in base64.
class Bytes {
 public:
  Bytes(std::string_view text, bool base64) : text_(text), base64_(base64) {}

  /// Returns how many there can be.
  std::uint64_t size() const {
    if (!base64_) return text_.size();
    std::uint64_t characters = 0;
    for (const char c : text_) {
      if (sextet(c) < 0 && c != '=') break;
      ++characters;
    }
    return characters / 4 * 3;
  }

  std::optional<std::uint64_t> number(std::uint64_t at, std::uint64_t bytes, bool big) const {
    std::uint64_t value = 0;
    for (std::uint64_t i = 0; i < bytes; ++i) {
      const auto byte = this->byte(at + (big ? i : bytes - 1 - i));
      if (!byte) return std::nullopt;
      value = value << 8 | *byte;
    }
    return value;
  }

 private:
  std::optional<std::uint64_t> byte(std::uint64_t at) const {
    if (!base64_) {
      if (at >= text_.size()) return std::nullopt;
      return static_cast<unsigned char>(text_[at]);
    }
    const std::uint64_t first = at / 3 * 4;
    if (first + 4 > text_.size()) return std::nullopt;
    std::uint64_t bits = 0;
    for (std::uint64_t i = 0; i < 4; ++i) {
      const int six = text_[first + i] == '=' && i > at % 3 + 1 ? 0 : sextet(text_[first + i]);
      if (six < 0) return std::nullopt;
      bits = bits << 6 | static_cast<std::uint64_t>(six);
    }
    return bits >> 8 * (2 - at % 3) & 0xff;
  }

  std::string_view text_;
  bool base64_;
};

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
    return std::move(file_);
  }

 private:
  struct Appended {
    std::string_view bytes;
    bool base64 = false;
  };

  std::optional<Appended> find_appended() const {
    const std::size_t at = text_.find("<AppendedData");
    if (at == std::string_view::npos) return std::nullopt;
    const std::size_t end = text_.find('>', at), begin = text_.find('_', end);
    if (begin == std::string_view::npos) return std::nullopt;
    const std::string_view tag = text_.substr(at, end - at);
    return Appended{text_.substr(begin + 1), tag.find("base64") != std::string_view::npos};
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
    if (tag.name == "VTKFile") {
      file_.kind = attribute(tag, "type");
      big_ = attribute(tag, "byte_order") == "BigEndian";
      header_size_ = attribute(tag, "header_type") == "UInt64" ? 8 : 4;
      compressed_ = !attribute(tag, "compressor").empty();
    } else if (tag.name == file_.kind) {
      check_numbers(tag, "Origin", 3);
      check_numbers(tag, "Spacing", 3);
      check_numbers(tag, "Direction", 9);
      file_.whole = extent_in(attribute(tag, "WholeExtent"));
    } else if (tag.name == "Piece") {
      enter_piece(tag);
    } else if (tag.name == "DataSet") {
      if (const std::string_view name = attribute(tag, "file"); !name.empty()) {
        file_.files.push_back(plain_text(name));
      }
    } else if (const auto section = sections.find(tag.name); section != sections.end()) {
      if (!tag.closed) section_ = section->second;
    } else if ((tag.name == "DataArray" || tag.name == "PDataArray") && section_) {
      const bool is_listed = tag.name == "PDataArray" || file_.pieces.empty();
      (is_listed ? file_.listed : file_.pieces.back().arrays).push_back(array(tag));
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

  void enter_piece(const XmlTag& tag) {
    VtkXmlPiece piece;
    piece.source = plain_text(attribute(tag, "Source"));
    piece.points = number_in<std::uint64_t>(attribute(tag, "NumberOfPoints")).value_or(0);
    piece.cells = number_in<std::uint64_t>(attribute(tag, "NumberOfCells")).value_or(0);
    if (const auto extent = extent_in(attribute(tag, "Extent"))) {
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

  VtkXmlArray array(const XmlTag& tag) const {
    VtkXmlArray array;
    array.section = *section_;
    array.name = plain_text(attribute(tag, "Name"));
    array.type = attribute(tag, "type");
    array.is_step = !attribute(tag, "TimeStep").empty();
    const std::string_view components = attribute(tag, "NumberOfComponents");
    array.components = number_in<std::int64_t>(components).value_or(1);
    constexpr std::int64_t most = std::int64_t{1} << 20;
    if (array.components > most) {
      throw Error("the array \"" + one_line(array.name.substr(0, 100)) + "\" has " +
                  std::to_string(array.components) + " components; the file is damaged");
    }
    array.components = std::max(array.components, std::int64_t{1});
    const std::uint64_t size = size_of(array.type);
    if (tag.name == "PDataArray" || size == 0) return array;
    const std::string_view format = attribute(tag, "format");
    if (format == "ascii" || format.empty()) {
      array.values = count_numbers(tag.text, array.type, array.stop);
      return array;
    }
    std::optional<std::uint64_t> bytes;
    if (format == "binary") {
      bytes = byte_count({without_spaces_in_front(tag.text), true});
    } else if (format == "appended" && appended_) {
      const auto offset = number_in<std::uint64_t>(attribute(tag, "offset"));
      if (offset && *offset < appended_->bytes.size()) {
        bytes = byte_count({appended_->bytes.substr(*offset), appended_->base64});
      }
    }
    array.is_bits = array.type == "Bit";
    if (bytes) array.values = *bytes / size * (array.is_bits ? 8 : 1);
    return array;
  }

  /// Returns how many bytes an array has, as its header says.
  std::optional<std::uint64_t> byte_count(const Bytes& bytes) const {
    const auto number = [&](std::uint64_t i) {
      return bytes.number(i * header_size_, header_size_, big_);
    };
    if (!compressed_) {
      const auto said = number(0);
      const std::uint64_t there = bytes.size();
      if (!said || there < header_size_) return std::nullopt;
      return std::min(*said, there - header_size_);
    }
    const auto blocks = number(0), block = number(1), last = number(2);
    if (blocks == 0) return 0;
    constexpr std::uint64_t most = std::uint64_t{1} << 40;
    if (!blocks || !block || !last || *block > most || *last > most) return std::nullopt;
    if (*blocks > most / std::max(*block, std::uint64_t{1})) return std::nullopt;
    return *last == 0 ? *blocks * *block : (*blocks - 1) * *block + *last;
  }

  const std::string name_ = "its XML";
  std::string_view text_;
  XmlScanner scanner_;
  std::optional<Appended> appended_;
  VtkXmlFile file_;
  std::optional<VtkSection> section_;
  bool big_ = false, compressed_ = false;
  std::uint64_t header_size_ = 4;
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

// SPDX-License-Identifier: Apache-2.0
//
// MetaImage: lines "key = value" up to ElementDataFile, which says where the values are: LOCAL
// (behind that line), a file, a pattern ("slice%03d.raw 1 93 1") or LIST (a name per line).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "axes/time_steps.h"
#include "files/data_stream.h"
#include "files/input_file.h"
#include "itk_header.h"
#include "pellucid/scene/error.h"
#include "text/header_keys.h"
#include "text/latin_text.h"
#include "text/printable.h"
#include "text/text.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"
#include "volumes/volume_steps.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

// The stream just behind the line of ElementDataFile.
std::ifstream open_behind_header(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("ElementDataFile")) return file;
  }
  throw Error(path.string() + ": the MetaImage header does not say where its values are");
}

std::vector<std::string> listed_files(const fs::path& path) {
  std::ifstream file = open_behind_header(path);
  std::vector<std::string> names;
  std::string line;
  while (std::getline(file, line)) {
    if (line = std::string(trimmed(line)); !line.empty()) names.push_back(line);
  }
  return names;
}

// "name%03d.raw first last step", as printf has it; only one number, and only %d.
std::vector<std::string> files_of_pattern(const std::string& text, int slices,
                                          const std::string& name) {
  std::istringstream words(text);
  std::string pattern;
  long first = 1, last = slices, step = 1;
  words >> pattern >> first >> last >> step;
  const std::size_t percent = pattern.find('%');
  const std::size_t letter =
      percent == std::string::npos ? percent : pattern.find_first_not_of("0123456789", percent + 1);
  if (letter == std::string::npos || pattern[letter] != 'd' || letter - percent > 3 ||
      pattern.find('%', letter) != std::string::npos || step < 1 || first < 0 || last < first ||
      (last - first) / step >= slices) {
    throw Error(name + ": the pattern of files \"" + text + "\" is not understood");
  }
  const std::string width_text = pattern.substr(percent + 1, letter - percent - 1);
  const bool zeros = width_text.starts_with('0');
  const std::size_t width = width_text.empty() ? 0 : std::stoul(width_text);
  std::vector<std::string> names;
  for (long i = first; i <= last; i += step) {
    std::string number = std::to_string(i);
    if (number.size() < width) number.insert(0, width - number.size(), zeros ? '0' : ' ');
    names.push_back(pattern.substr(0, percent) + number + pattern.substr(letter + 1));
  }
  return names;
}

struct DataFile {
  fs::path path;
  std::uintmax_t offset = 0;
};

// The files that hold the values, in order, each the same share of them.
std::vector<DataFile> find_files(const fs::path& path, const MetaImageHeader& header,
                                 std::uintmax_t bytes) {
  const std::string name = path.string();
  const std::string where(trimmed(header.data_file));
  std::vector<DataFile> files;
  if (where == "LOCAL" || where == "Local" || where == "local") {
    const std::streamoff at = open_behind_header(path).tellg();
    files.push_back({path, static_cast<std::uintmax_t>(at)});
    return files;
  }
  if (header.header_size < -1) {
    throw Error(name + ": the header says \"HeaderSize = " + std::to_string(header.header_size) +
                "\", where a whole number from 0 is meant, or -1 for the last bytes");
  }
  std::vector<std::string> names{where};
  if (where == "LIST" || where.starts_with("LIST ")) {
    names = listed_files(path);
  } else if (where.find('%') != std::string::npos) {
    names = files_of_pattern(where, static_cast<int>(header.sides[2]), name);
  }
  const std::size_t slices = static_cast<std::size_t>(header.sides[2]) *
                             static_cast<std::size_t>(header.interleaved ? 1 : header.components);
  if (names.empty() || slices % names.size() != 0) {
    throw Error(name + ": " + std::to_string(names.size()) + " files do not make " +
                std::to_string(slices) + " slices");
  }
  if (header.compressed && names.size() > 1) {
    throw Error(name + ": several compressed files are not read; save them as one");
  }
  for (const std::string& file : names) {
    DataFile part{path.parent_path() / file, 0};
    const std::uintmax_t size = check_input_file(part.path);
    const std::uintmax_t share = bytes / names.size();
    if (header.header_size > 0) part.offset = static_cast<std::uintmax_t>(header.header_size);
    // MetaIO: -1 means that the values are the file's last bytes.
    if (header.header_size == -1 && size > share) part.offset = size - share;
    files.push_back(part);
  }
  return files;
}

/// Joins several files of the same share one behind the other; one of them in place where that can
/// be.
ByteSource joined_source(const std::vector<DataFile>& files, std::uintmax_t share,
                         const std::string& name) {
  std::vector<ByteSource> parts;
  parts.reserve(files.size());
  for (const DataFile& file : files) parts.push_back(file_source(file.path));
  ByteSource joined{name, share * files.size(), {}, {}};
  joined.read = [parts, files, share](std::uintmax_t from, std::span<std::byte> to) {
    while (!to.empty()) {
      const std::size_t part = from / share;
      const std::uintmax_t within = from % share;
      const std::size_t bytes = std::min<std::uintmax_t>(share - within, to.size());
      parts[part].read(files[part].offset + within, to.first(bytes));
      to = to.subspan(bytes);
      from += bytes;
    }
  };
  return joined;
}

std::vector<VolumeData> read_files(const std::vector<DataFile>& files,
                                   const MetaImageHeader& header, std::size_t points,
                                   ComponentRange range, const Note& note,
                                   const std::string& name) {
  ValueLayout layout{header.type,       header.big_endian,  files[0].offset,
                     header.components, header.interleaved, note};
  if (header.compressed) {
    // CompressedDataSize is often out of date; the compressed data knows where it ends.
    DataStream stream(files[0].path, layout.offset, DataStream::Compression::deflate);
    std::vector<VolumeData> list = read_components(stream, layout, points, range);
    stream.finish();
    return list;
  }
  const std::size_t share = value_count(points, layout.components, name) / files.size();
  for (const DataFile& file : files) {
    const ByteSource source = file_source(file.path);
    const std::uintmax_t needed = std::uintmax_t{share} * value_size(layout.type, name);
    if (header.header_size > 0 && source.size < file.offset + needed) {
      throw Error(name + ": the header says \"HeaderSize = " + std::to_string(header.header_size) +
                  "\", but " + file.path.filename().string() + " has " +
                  std::to_string(source.size) + " bytes, and its values need " +
                  std::to_string(needed) +
                  " behind those; mend the header, or the file is cut off");
    }
    check_size(source, {layout.type, layout.big_endian, file.offset}, share);
    const bool own_file = file.path.string() != name;
    note_bytes_left_over(
        source, file.offset + share * value_size(layout.type, name), note,
        own_file ? "\"HeaderSize = -1\" in the MetaImage header takes the last bytes" : "");
  }
  if (files.size() == 1) return read_components(file_source(files[0].path), layout, points, range);
  layout.offset = 0;
  return read_components(joined_source(files, share * value_size(layout.type, name), name), layout,
                         points, range);
}

/// A line "key = value" of the header, both as written.
struct Field {
  std::string key, value;
};

/// Returns the lines up to ElementDataFile.
std::vector<Field> read_fields(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<Field> fields;
  std::string line;
  for (int lines = 0; lines < 10000 && std::getline(file, line); ++lines) {
    if (lines == 0) drop_mark(line);
    const std::size_t sign = line.find('=');
    if (sign == std::string::npos) continue;
    const std::string_view text = line;
    fields.push_back(
        {std::string(trimmed(text.substr(0, sign))), std::string(trimmed(text.substr(sign + 1)))});
    if (fields.back().key == "ElementDataFile") break;
  }
  return fields;
}

/// Returns the value of a key; empty where the header has none.
std::string value_of(const std::vector<Field>& fields, std::string_view key) {
  const auto found = std::ranges::find(fields, key, &Field::key);
  return found == fields.end() ? std::string() : found->value;
}

std::vector<double> numbers_of(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> numbers;
  for (double number = 0; words >> number;) numbers.push_back(number);
  return numbers;
}

/// Returns whether a text is finite numbers alone, whole ones if wanted.
bool are_numbers(const std::string& text, bool are_whole) {
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto number = number_of_word<double>(word);
    if (!number || !std::isfinite(*number)) return false;
    if (are_whole && *number != std::floor(*number)) return false;
  }
  return true;
}

/// Checks the numbers that MetaIO reads as far as they are some: "12,5" as 12, the first of too
/// many, and since ITK 5.4 "inf" and "nan" as 0.
void check_numbers(const std::vector<Field>& fields, const std::string& name) {
  const std::vector<double> axes = numbers_of(value_of(fields, "NDims"));
  const std::size_t n = axes.size() == 1 && axes[0] >= 1 && axes[0] < 10
                            ? static_cast<std::size_t>(axes[0])
                            : std::numeric_limits<std::uint16_t>::max();
  const struct {
    std::string_view key;
    std::size_t most;
    bool are_whole;
  } keys[] = {{"NDims", 1, true},           {"DimSize", n, true},
              {"HeaderSize", 1, true},      {"ElementNumberOfChannels", 1, true},
              {"ElementSpacing", n, false}, {"ElementSize", n, false},
              {"Offset", n, false},         {"Position", n, false},
              {"Origin", n, false},         {"TransformMatrix", n * n, false},
              {"Rotation", n * n, false},   {"Orientation", n * n, false}};
  for (const Field& field : fields) {
    const auto key = std::ranges::find(keys, std::string_view(field.key),
                                       [](const auto& known) { return known.key; });
    if (key == std::end(keys)) continue;
    const bool are_good = are_numbers(field.value, key->are_whole);
    if (are_good && numbers_of(field.value).size() <= key->most) continue;
    throw Error(name + ": the header says \"" + field.key + " = " + printable(field.value) +
                "\", where " +
                (are_good ? std::to_string(key->most) + " numbers are meant"
                          : std::string(key->are_whole ? "whole" : "finite") +
                                " numbers are meant, with a point before decimals") +
                "; mend the header");
  }
}

/// Checks the fields. MetaIO reads as many numbers as the header says that there are axes, 2^32 - 3
/// for -3.
void check_fields(const std::vector<Field>& fields, const std::string& name) {
  if (value_of(fields, "NDims").find('-') != std::string::npos) {
    throw Error(name + ": the header says \"NDims\" below 0; mend the header");
  }
  const std::string per_slice = value_of(fields, "HeaderSizePerSlice");
  if (!per_slice.empty() && numbers_of(per_slice) != std::vector<double>{0}) {
    throw Error(name +
                ": the header says \"HeaderSizePerSlice\", which is not read; save the values "
                "without headers between the slices");
  }
}

/// Returns whether a key leaves the picture as it is: it is read, is a name, or says what is so
/// without it.
bool is_taken_into_account(const Field& field, const std::vector<Field>& fields) {
  constexpr std::array known = std::to_array<std::string_view>(
      {"ObjectType", "ObjectSubType", "NDims", "DimSize", "BinaryData", "BinaryDataByteOrderMSB",
       "ElementByteOrderMSB", "CompressedData", "CompressedDataSize", "CompressionLevel",
       "TransformMatrix", "Rotation", "Orientation", "Offset", "Position", "Origin",
       "ElementSpacing", "ElementType", "ElementNumberOfChannels", "HeaderSize",
       "HeaderSizePerSlice", "ElementDataFile", "AnatomicalOrientation",
       // Names and the like; Kinds is that of a fourth axis.
       "Name", "ID", "ParentID", "Comment", "AcquisitionDate", "Color", "Modality", "SequenceID",
       "ElementMin", "ElementMax", "Kinds"});
  if (std::ranges::find(known, field.key) != known.end()) return true;
  if (field.key.starts_with("ITK_") || field.key.starts_with("Seq_Frame")) return true;
  const std::vector<double> numbers = numbers_of(field.value);
  const auto all_are = [&](double number) {
    return !numbers.empty() && std::ranges::count(numbers, number) == std::ssize(numbers);
  };
  if (field.key == "CenterOfRotation" || field.key == "ElementToIntensityFunctionOffset") {
    return all_are(0);
  }
  if (field.key == "ElementToIntensityFunctionSlope") return all_are(1);
  if (field.key == "DistanceUnits") return in_small_letters(field.value) == "mm";
  // MetaIO takes the size for the spacing where the header has no other.
  if (field.key == "ElementSize") {
    const std::string spacing = value_of(fields, "ElementSpacing");
    return spacing.empty() || numbers_of(spacing) == numbers;
  }
  return false;
}

/// Returns the beginnings of the axes by MetaIO's letters: "RAI" grow to left, posterior and
/// superior.
std::string letters_of(const Mat3<double>& direction) {
  std::string letters;
  for (const Vec3<double>& axis : direction.column) {
    int largest = 0;
    for (int i = 1; i < 3; ++i) {
      if (std::abs(axis[i]) > std::abs(axis[largest])) largest = i;
    }
    letters += (axis[largest] > 0 ? "RAI" : "LPS")[largest];
  }
  return letters;
}

void note_fields(const std::vector<Field>& fields, const MetaImageHeader& header,
                 const std::string& name, const Note& note) {
  if (!note) return;
  const std::string said = value_of(fields, "AnatomicalOrientation");
  const std::string lies = letters_of(header.placement.direction);
  if (said.size() == 3 && said.find_first_not_of("RLAPIS") == std::string::npos && said != lies) {
    note(name + ": says \"AnatomicalOrientation = " + said +
         "\", but its TransformMatrix is that of " + lies + "; the matrix is used");
  }
  const bool is_local = in_small_letters(std::string(trimmed(header.data_file))) == "local";
  if (is_local && header.header_size != 0) {
    note(name + ": says \"HeaderSize = " + std::to_string(header.header_size) +
         "\", which is not taken into account beside \"ElementDataFile = LOCAL\"; the values "
         "begin behind the header");
  }
  std::vector<std::string> ignored;
  for (const Field& field : fields) {
    if (value_of(fields, field.key) != field.value)
      ignored.push_back(field.key + " (more than once)");
    if (!is_taken_into_account(field, fields)) ignored.push_back(field.key);
  }
  note_ignored_keys(note, name, ignored);
}

/// Returns the steps of a fourth axis: by the times that PlusToolkit writes of each, else by the
/// axis' origin and spacing.
VolumeSteps steps_of(const std::vector<Field>& fields, std::size_t count) {
  VolumeSteps steps;
  for (std::size_t i = 0; i < count; ++i) {
    std::string number = std::to_string(i);
    if (number.size() < 4) number.insert(0, 4 - number.size(), '0');
    const std::vector<double> time =
        numbers_of(value_of(fields, "Seq_Frame" + number + "_Timestamp"));
    if (time.size() != 1) break;
    steps.times.push_back(time.front());
  }
  if (steps.times.size() == count) {
    steps.unit = "s";
    return steps;
  }
  const auto fourth = [&](std::initializer_list<const char*> keys, double none) {
    for (const char* const key : keys) {
      const std::vector<double> numbers = numbers_of(value_of(fields, key));
      if (numbers.size() > 3) return numbers[3];
    }
    return none;
  };
  const double step = fourth({"ElementSpacing", "ElementSize"}, 1);
  steps.times =
      even_times(count, fourth({"Offset", "Position", "Origin"}, 0), step == 0 ? 1 : step);
  return steps;
}

/// Opens MetaImage, .mha or .mhd, raw or zlib; values in one file or in one per slice. Channels and
/// a fourth axis are components.
VolumeFile open_meta_image(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  const std::vector<Field> fields = read_fields(path);
  check_fields(fields, name);
  check_numbers(fields, name);
  const MetaImageHeader header = read_meta_image_header(path);
  if (header.text) {
    throw Error(name + ": values written as text are not read; save the MetaImage as binary");
  }
  VolumeFile file;
  file.description = describe(header, name);
  std::size_t points = 1;
  for (const int side : file.description.dimensions) points *= static_cast<std::size_t>(side);
  const std::uintmax_t bytes =
      std::uintmax_t{value_count(points, header.components, name)} * value_size(header.type, name);
  note_fields(fields, header, name, options.note);
  file.space = patient_space;
  apply_overrides(options, file.description);
  file.components = header.components;
  file.holds = header.holds;
  file.reads_parts = !header.compressed && reads_parts({header.type, header.big_endian, 0,
                                                        header.components, header.interleaved});
  file.read = [header, points, name, note = options.note,
               files = find_files(path, header, bytes)](ComponentRange range) {
    return read_files(files, header, points, range, note, name);
  };
  const bool has_steps =
      header.components > 1 && !header.interleaved && value_of(fields, "NDims") == "4";
  if (has_steps) {
    take_steps(steps_of(fields, static_cast<std::size_t>(header.components)), options, name + ": ",
               file);
  } else if (options.time) {
    take_steps({}, options, name + ": ", file);
  }
  return file;
}

}  // namespace

extern const VolumeFormat meta_image_format{.name = "MetaImage",
                                            .extensions = ".mha .mhd",
                                            .open = open_meta_image,
                                            .has_times = true,
                                            .is_of_patients = true};

}  // namespace pellucid

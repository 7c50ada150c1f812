// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "files/input_file.h"
#include "itk_header.h"
#include "nrrd_axes.h"
#include "nrrd_fields.h"
#include "nrrd_space.h"
#include "nrrd_steps.h"
#include "pellucid/io/internal/temporary_folder.h"
#include "pellucid/scene/error.h"
#include "text/text.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace fs = std::filesystem;

using nrrd::axes_of;
using nrrd::axis_count;
using nrrd::find_field;
using nrrd::Header;
using nrrd::kind_of;
using nrrd::Line;
using nrrd::number_in;

namespace {

// NrrdIO panics about some kinds, ITK takes the mask out of others, and time is no axis of
// components to it.
bool is_kind_of_itk(const std::string& kind) {
  return !kind.empty() && kind != "time" && kind != "3-gradient" && kind != "3-normal" &&
         kind.find("masked") == std::string::npos;
}

// Two kinds of file break the letter of the format and are common all the same: "space directions"
// without a space or before it, and "spacings" beside a space. NrrdIO refuses both; and it needs to
// be told the kind of an axis of components, one that it knows. This is the header as it was meant,
// detached, or nothing where there is nothing to mend.
std::vector<std::string> mended_header(const Header& header, std::size_t components_axis,
                                       const fs::path& path) {
  const bool directions = find_field(header, "spacedirections") != nullptr;
  const bool space =
      find_field(header, "space") != nullptr || find_field(header, "spacedimension") != nullptr;
  const bool spacings = find_field(header, "spacings") != nullptr;
  const bool kinds = components_axis == 0 || is_kind_of_itk(kind_of(header, components_axis));
  if (kinds && !header.is_changed && !(directions && !space) &&
      !(spacings && space && !directions)) {
    return {};
  }
  const Line* file = find_field(header, "datafile");
  const bool is_list = file != nullptr && file->value.starts_with("LIST");
  const Line* skip = find_field(header, "lineskip");
  const std::optional<std::uint64_t> skipped = skip == nullptr ? 0 : number_in(skip->value);
  if (!skipped) return {};
  std::vector<std::string> mended;
  for (const Line& line : header.lines) {
    if (line.field == "datafile" || line.field == "lineskip") continue;
    if (spacings && !directions && line.field == "space") continue;
    if (!kinds && line.field == "kinds") continue;
    if (!space && line.field == "spacedirections") mended.emplace_back("space dimension: 3");
    mended.push_back(line.text);
  }
  if (!kinds) {
    std::string line = "kinds:";
    for (std::size_t axis = 1; axis <= axis_count(header); ++axis) {
      line += axis == components_axis ? " list" : " domain";
    }
    mended.push_back(line);
  }
  // What was attached stands behind the header, and the empty line at its end.
  const std::uint64_t above = file == nullptr ? header.lines_in_file : 0;
  mended.push_back("line skip: " + std::to_string(*skipped + above));
  const fs::path whole = fs::absolute(path);
  if (is_list) {
    mended.push_back("data file: " + file->value);
    for (const std::string& listed : nrrd::listed_files(header, path)) {
      mended.push_back((whole.parent_path() / listed).string());
    }
    return mended;
  }
  mended.push_back("data file: " +
                   (file == nullptr ? whole : whole.parent_path() / file->value).string());
  return mended;
}

// How many values the header says there are; 0 where it does not say.
std::uint64_t header_count(const Header& header, const std::string& name) {
  const Line* line = find_field(header, "sizes");
  if (line == nullptr) return 0;
  const std::string says = name + ": the NRRD header says \"" + line->text + "\", ";
  std::uint64_t count = 1;
  for (const std::string& word : axes_of(line->value)) {
    const std::optional<std::uint64_t> side = number_in(word);
    if (!side || *side == 0) throw Error(says + "where whole numbers from 1 are meant");
    // ITK 5.2 cuts sizes down to 32 bits.
    constexpr std::uint64_t largest = std::numeric_limits<std::int32_t>::max();
    if (*side > largest || count > std::numeric_limits<std::uint64_t>::max() / 8 / *side) {
      throw Error(says + "too large to read");
    }
    count *= *side;
  }
  return count;
}

// The first axis, but for one, of which `field` says one of `words`, from 1; 0 where there is none.
std::size_t axis_that_says(const Header& header, std::string_view field,
                           std::initializer_list<std::string_view> words, std::size_t but_for = 0) {
  const Line* line = find_field(header, field);
  if (line == nullptr) return 0;
  const std::vector<std::string> axes = axes_of(line->value);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (a + 1 == but_for) continue;
    for (const std::string_view word : words) {
      if (axes[a].find(word) != std::string::npos) return a + 1;
    }
  }
  return 0;
}

// Behind three axes, one that holds one value only, as one point of time, needs no spacing.
bool needs_spacing(const Header& header, std::size_t axis) {
  const Line* sizes = find_field(header, "sizes");
  if (axis <= 3 || sizes == nullptr) return true;
  const std::vector<std::string> sides = axes_of(sizes->value);
  return axis > sides.size() || number_in(sides[axis - 1]) != 1u;
}

bool is_kind_of_space(const std::string& kind) {
  return kind == "domain" || kind == "space";
}

// The one of four axes that is time or of an unknown kind, where the others are of space; else 0.
// The last one is 0, too: it is taken for components without that.
std::size_t axis_beside_space(const Header& header) {
  if (axis_count(header) != 4) return 0;
  std::size_t found = 0;
  for (std::size_t axis = 1; axis <= 4; ++axis) {
    if (is_kind_of_space(kind_of(header, axis))) continue;
    if (found != 0) return 0;
    found = axis;
  }
  return found == 4 ? 0 : found;
}

// Refuses a time beside components, unless it can be shown as z.
void refuse_second_axis(const Header& header, std::size_t components_axis,
                        const std::string& name) {
  const std::size_t last = components_axis == 4 ? 3 : 4;
  for (std::size_t axis = 1; axis < last && components_axis != 0; ++axis) {
    if (axis == components_axis || kind_of(header, axis) != "time") continue;
    throw Error(name + ": its kinds say that axis " + std::to_string(axis) + " is time and axis " +
                std::to_string(components_axis) +
                " holds components, so that two axes of space are left; save a volume of three "
                "axes of space as a file of its own");
  }
}

// The axis whose values are components, from 1; 0 where all are of space, or the last is time. The
// kind says it, or that the axis has no direction in space.
std::size_t find_components_axis(const Header& header, const std::string& name) {
  const std::size_t axes = axis_count(header);
  if (axes < 4) return 0;
  std::size_t found = 0;
  for (std::size_t axis = 1; axis <= axes && found == 0; ++axis) {
    const std::string kind = kind_of(header, axis);
    if (!kind.empty() && !is_kind_of_space(kind) && kind != "time") found = axis;
  }
  if (found == 0) found = axis_that_says(header, "spacedirections", {"none", "nan"});
  if (found == 0) found = axis_beside_space(header);
  refuse_second_axis(header, found, name);
  if (found > 1 && found < axes && axes > 4) {
    throw Error(name + ": axis " + std::to_string(found) + " of " + std::to_string(axes) +
                " holds components; save a volume of three axes of space as a file of its own");
  }
  return found;
}

// How many values lie along the axes in front of one, from 1.
std::size_t values_before(const Header& header, std::size_t axis) {
  const Line* line = find_field(header, "sizes");
  std::size_t count = 1;
  if (line == nullptr || axis == 0) return count;
  const std::vector<std::string> sides = axes_of(line->value);
  for (std::size_t a = 0; a + 1 < axis && a < sides.size(); ++a)
    count *= number_in(sides[a]).value_or(1);
  return count;
}

// ITK takes a spacing of 1 where NRRD says that it is unknown, or gives a range of each axis.
void check_spacing(const Header& header, std::size_t components_axis, const ReadOptions& options,
                   const std::string& name) {
  const bool directions = find_field(header, "spacedirections") != nullptr;
  if (const std::size_t axis =
          axis_that_says(header, "spacedirections", {"none", "nan"}, components_axis)) {
    throw Error(name + ": axis " + std::to_string(axis) +
                " is no axis of space, \"space directions\" has none for it; save a volume of "
                "three axes of space as a file of its own");
  }
  if (options.spacing) return;
  if (const std::size_t axis = axis_that_says(header, "spacings", {"nan"}, components_axis);
      axis != 0 && needs_spacing(header, axis)) {
    throw Error(name + ": the NRRD header does not know the spacing of axis " +
                std::to_string(axis) + "; give the spacing");
  }
  if (find_field(header, "axismaxs") != nullptr && find_field(header, "spacings") == nullptr &&
      !directions) {
    throw Error(name +
                ": the NRRD header gives the range of the axes instead of a spacing; give the "
                "spacing and the origin");
  }
}

bool is_bzip2(const Header& header) {
  const Line* encoding = find_field(header, "encoding");
  return encoding != nullptr && in_small_letters(encoding->value).starts_with("bz");
}

// How many bytes a value has by its name in the header; 0 where it is none of a number.
std::size_t bytes_per_value(const Header& header) {
  const Line* const line = find_field(header, "type");
  if (line == nullptr) return 0;
  std::string type = in_small_letters(line->value);
  for (const std::string_view word : {"unsigned ", "signed "}) {
    if (type.starts_with(word)) type.erase(0, word.size());
  }
  // "uint8_t" and "ushort", but not "u".
  if (type.size() > 1 && type.starts_with('u')) type.erase(0, 1);
  if (type.ends_with("_t")) type.erase(type.size() - 2);
  static constexpr std::pair<std::string_view, std::size_t> sizes[] = {
      {"char", 1},  {"int8", 1},      {"short", 2},        {"short int", 2}, {"int16", 2},
      {"int", 4},   {"int32", 4},     {"float", 4},        {"double", 8},    {"longlong", 8},
      {"int64", 8}, {"long long", 8}, {"long long int", 8}};
  for (const auto& [known, size] : sizes) {
    if (type == known) return size;
  }
  return 0;
}

// Skips below 0 have a meaning of their own, -1 alone and of plain bytes alone.
void check_skips(const Header& header, const std::string& name) {
  for (const char* const field : {"byteskip", "lineskip"}) {
    const Line* const line = find_field(header, field);
    if (line == nullptr) continue;
    const std::string says = name + ": the NRRD header says \"" + line->text + "\", ";
    const bool bytes = std::string_view(field) == "byteskip";
    const Line* const encoding = find_field(header, "encoding");
    if (bytes && line->value == "-1") {
      if (encoding == nullptr || in_small_letters(encoding->value) == "raw") continue;
      throw Error(says +
                  "but only of encoding \"raw\" the last bytes can be taken; decompress the "
                  "values");
    }
    if (!number_in(line->value)) {
      throw Error(says + (bytes ? "where a whole number from 0 is meant, or -1 for the last bytes"
                                : "where a whole number from 0 is meant"));
    }
  }
}

// Tells of bytes that the header does not need. A file of another format, with a header of its own,
// is often named as one of values.
void note_left_over(const Header& header, std::uint64_t count, const NrrdValues& values,
                    const ReadOptions& options) {
  const std::uintmax_t size = bytes_per_value(header);
  if (size == 0 || values.compression || values.offset == NrrdValues::last_bytes) return;
  const bool detached = find_field(header, "datafile") != nullptr;
  const bool skips = find_field(header, "byteskip") != nullptr;
  note_bytes_left_over(
      file_source(values.file), values.offset + count * size, options.note,
      !detached ? ""
      : skips   ? "\"byte skip: -1\" in the NRRD header takes the last bytes instead"
                : "the first bytes are taken; if they are a header of the data file's own, say "
                  "\"byte skip: -1\" in the NRRD header, which takes the last bytes");
}

// Where the values are if they lie in one file as they are in memory, or compressed by bzip2, which
// Debian's ITK lacks; or nothing: ITK then finds and decodes them.
std::optional<NrrdValues> raw_values(const Header& header, const fs::path& path) {
  const auto says = [&](std::string_view field) {
    const Line* line = find_field(header, field);
    return line == nullptr ? std::string() : in_small_letters(line->value);
  };
  NrrdValues values{path, header.bytes, {}, {}, 0};
  if (is_bzip2(header)) values.compression = DataStream::Compression::bzip2;
  if ((says("encoding") != "raw" && !values.compression) ||
      (!says("lineskip").empty() && says("lineskip") != "0")) {
    return {};
  }
  if (says("endian") == "little" || says("endian") == "big") {
    values.big_endian = says("endian") == "big";
  }
  if (const Line* file = find_field(header, "datafile")) {
    if (file->value.starts_with("LIST") || file->value.find('%') != std::string::npos) return {};
    values.file = path.parent_path() / file->value;
    values.offset = 0;
    check_input_file(values.file);
  }
  if (values.compression && !says("byteskip").empty()) {
    const std::optional<std::uint64_t> skipped = number_in(says("byteskip"));
    if (!skipped) return {};
    values.skip_inside = *skipped;
  } else if (says("byteskip") == "-1") {
    values.offset = NrrdValues::last_bytes;
  } else if (!says("byteskip").empty()) {
    const std::optional<std::uint64_t> skipped = number_in(says("byteskip"));
    if (!skipped || *skipped > fs::file_size(values.file)) return {};
    values.offset += *skipped;
  }
  return values;
}

// Checks the files of values, which ITK opens: it would wait for a pipe.
void check_data_files(const Header& header, const fs::path& path) {
  const auto check = [&](std::string_view file) {
    try {
      check_input_file(path.parent_path() / file);
    } catch (const Error& error) {
      throw Error(path.string() + ": its data file " + error.what());
    }
  };
  const Line* const field = find_field(header, "datafile");
  if (field == nullptr || field->value.find('%') != std::string::npos) return;
  if (!field->value.starts_with("LIST")) {
    check(field->value);
    return;
  }
  for (const std::string& listed : nrrd::listed_files(header, path)) check(listed);
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size()) {
    text.replace(at, what.size(), with);
  }
  return text;
}

/// Opens NRRD, attached (.nrrd) or detached (.nhdr), raw, gzip, bzip2, ascii or hex. Turned from
/// RAS or LAS to LPS; other spaces are taken as they are. Of a space of four axes the fourth is
/// time. Cell-centred where all three axes say so. One of four axes that is none of space, by its
/// kind or for want of a direction, holds components, and so does a fourth axis; steps in time by
/// nrrd::steps_of().
VolumeFile open_nrrd(const fs::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  check_input_file(path);
  Header header = nrrd::read_header(path);
  const nrrd::Space space = nrrd::space_of(header);
  nrrd::note_keys(header, space, name, options.note);
  const Header as_written = header;
  nrrd::drop_time(header, name);
  NrrdText text;
  text.count = header_count(header, name);
  text.components_axis = find_components_axis(header, name);
  text.values_before = values_before(header, text.components_axis);
  check_spacing(header, text.components_axis, options, name);
  nrrd::check_numbers(header, name);
  nrrd::note_axes(header, text.components_axis, name, options.note);
  text.cell_centred_axes = nrrd::cell_centred_axes(header, text.components_axis);
  text.left_anterior_superior = space.is_left_anterior_superior;
  check_skips(header, name);
  check_data_files(header, path);
  text.values = raw_values(header, path);
  if (text.values) note_left_over(header, text.count, *text.values, options);
  if (is_bzip2(header) && !text.values) {
    throw Error(name +
                ": its values are compressed with bzip2, which is read of one file, without a line "
                "skip; save it with gzip");
  }
  const VolumeSteps steps = nrrd::steps_of(as_written, text.components_axis);
  const auto with_steps = [&](VolumeFile&& file) {
    file.space = space.name;
    if (options.time || (!steps.times.empty() && std::ssize(steps.times) == file.components)) {
      take_steps(steps, options, name + ": ", file);
    }
    return std::move(file);
  };
  const std::vector<std::string> mended = mended_header(header, text.components_axis, path);
  if (mended.empty()) {
    return with_steps(open_nrrd_file(path, name, text, options));
  }
  // A space is kept beside directions alone.
  if (find_field(header, "spacedirections") == nullptr) text.left_anterior_superior = false;

  const auto folder = std::make_shared<const TemporaryFolder>("a mended header of " + name);
  const fs::path mended_path = folder->path() / "mended.nhdr";
  std::ofstream stream(mended_path, std::ios::binary);
  for (const std::string& line : mended) stream << line << '\n';
  stream.close();
  if (!stream) throw Error(name + ": cannot write a temporary header for it");
  const auto with_own_name = [folder, mended_path, name](const auto& call) {
    try {
      return call();
    } catch (const Error& e) {
      throw Error(replaced(e.what(), mended_path.string(), name));
    }
  };
  VolumeFile file = with_own_name([&] { return open_nrrd_file(mended_path, name, text, options); });
  file.read = [with_own_name, read = std::move(file.read)](ComponentRange range) {
    return with_own_name([&] { return read(range); });
  };
  return with_steps(std::move(file));
}

}  // namespace

extern const VolumeFormat nrrd_format{.name = "NRRD",
                                      .extensions = ".nrrd .nhdr",
                                      .open = open_nrrd,
                                      .has_times = true,
                                      .is_of_patients = true};

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
//
// The format: Imaris 5.5 (https://imaris.oxinst.com/support/imaris-file-format).
// /DataSet/ResolutionLevel r/TimePoint t/Channel c/Data has values (z, y, x) of whole chunks, of
// which the attributes ImageSizeX … of the channel are the image. /DataSetInfo/Image has the
// borders ExtMin0 … ExtMax2 of the image along x, y and z. Texts are lists of single letters.
#include "hdf5_imaris.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "hdf5_attributes.h"
#include "hdf5_parts.h"
#include "text/text.h"
#include "volumes/stored_numbers.h"

namespace pellucid {

namespace {

constexpr const char* info = "/DataSetInfo";

bool has_object(hid_t file, const std::string& path) {
  for (std::size_t end = path.find('/', 1); end != std::string::npos;
       end = path.find('/', end + 1)) {
    if (H5Lexists(file, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(file, path.c_str(), H5P_DEFAULT) > 0;
}

/// Returns an attribute's text, also where it is a list of letters; empty: it is not there.
std::string said(hid_t file, const std::string& path, const std::string& name) {
  const hid_t opened = H5Oopen(file, path.c_str(), H5P_DEFAULT);
  if (opened < 0) return {};
  const Id object(opened, H5Oclose, "an object");
  std::string text;
  for (const std::string& part : hdf5_texts(opened, name)) text += part;
  return std::string(trimmed(text));
}

std::optional<double> number_said(hid_t file, const std::string& path, const std::string& name) {
  const auto number = number_of_word<double>(said(file, path, name));
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::string data_folder(hid_t file) {
  const std::string name = said(file, "/", "DataSetDirectoryName");
  return "/" + (name.empty() ? std::string("DataSet") : name);
}

/// A level of resolution: how many steps and channels it has, and what each of them is.
struct Level {
  std::string path, type;
  int steps = 0, channels = 0;
  std::array<std::int64_t, 3> sides{}, stored{};  ///< x, y, z, of the image and of the dataset

  std::string step(int t) const { return path + "/TimePoint " + std::to_string(t); }
  std::string channel(int t, int c) const { return step(t) + "/Channel " + std::to_string(c); }
  std::string data(int t, int c) const { return channel(t, c) + "/Data"; }
};

struct Stored {
  std::string type;
  std::array<std::int64_t, 3> sides{};
  bool operator==(const Stored&) const = default;
};

Stored stored_at(hid_t file, const std::string& path) {
  const Id data(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, path.c_str());
  const Id space(H5Dget_space(data.get()), H5Sclose, "the axes of a dataset");
  const Id type(H5Dget_type(data.get()), H5Tclose, "the type of a dataset");
  check_kind(data.get(), type.get());
  std::array<hsize_t, 3> sides{};
  const auto number = type_of(type.get());
  if (!number || H5Sget_simple_extent_ndims(space.get()) != 3 ||
      H5Sget_simple_extent_dims(space.get(), sides.data(), nullptr) != 3) {
    throw Error("\"" + path + "\" is no array of three axes of numbers, as Imaris has them");
  }
  Stored stored{is_stored_only(*number) ? "f64" : *number, {}};
  constexpr hsize_t most = std::numeric_limits<int>::max();
  for (std::size_t a = 0; a < 3; ++a) {
    const hsize_t side = sides[2 - a];
    if (side < 1 || side > most) throw Error("\"" + path + "\" has an axis of no usable length");
    stored.sides[a] = static_cast<std::int64_t>(side);
  }
  return stored;
}

int count_of(hid_t file, const std::string& beginning) {
  constexpr int most = 100'000;
  int count = 0;
  while (count < most && has_object(file, beginning + std::to_string(count))) ++count;
  return count;
}

/// Takes the size of the image in the dataset, which is padded to whole chunks.
void take_sides(hid_t file, bool is_finest, const Stored& stored, Level& level) {
  level.stored = level.sides = stored.sides;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::string letter(1, "XYZ"[a]);
    auto side = number_said(file, level.channel(0, 0), "ImageSize" + letter);
    if (!side && is_finest) side = number_said(file, std::string(info) + "/Image", letter);
    if (!side) continue;
    if (*side < 1 || *side > static_cast<double>(stored.sides[a]) || *side != std::floor(*side)) {
      throw Error("its ImageSize" + letter + " is not from 1 to the " +
                  std::to_string(stored.sides[a]) + " values that are there; it is damaged");
    }
    level.sides[a] = static_cast<std::int64_t>(*side);
  }
}

Level level_of(hid_t file, const std::string& path, bool is_finest) {
  Level level;
  level.path = path;
  level.steps = count_of(file, path + "/TimePoint ");
  if (level.steps > 0) level.channels = count_of(file, level.step(0) + "/Channel ");
  if (level.channels == 0) throw Error("\"" + path + "\" has no TimePoint 0 with a Channel 0");
  if (level.steps > std::numeric_limits<int>::max() / level.channels) {
    throw Error("\"" + path + "\" has too many components");
  }
  const Stored first = stored_at(file, level.data(0, 0));
  for (int t = 0; t < level.steps; ++t) {
    for (int c = 0; c < level.channels; ++c) {
      if (!has_object(file, level.data(t, c))) {
        throw Error("\"" + level.data(t, c) + "\" is missing; it is damaged");
      }
      if (stored_at(file, level.data(t, c)) != first) {
        throw Error("\"" + level.data(t, c) +
                    "\" has another size or type than the first channel; it is damaged");
      }
    }
  }
  level.type = first.type;
  take_sides(file, is_finest, first, level);
  return level;
}

/// Returns positions in the middle between the borders that the file states; without numbers where
/// it states none that can be.
std::array<AxisPositions, 3> positions_of(hid_t file, const Level& level) {
  const std::string image = std::string(info) + "/Image";
  std::array<AxisPositions, 3> positions;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::string number = std::to_string(a);
    const auto least = number_said(file, image, "ExtMin" + number);
    const auto most = number_said(file, image, "ExtMax" + number);
    if (!least || !most || !(*most > *least)) return {};
    const double distance = (*most - *least) / static_cast<double>(level.sides[a]);
    AxisPositions& along = positions[a];
    along.name = "ExtMin" + number;
    along.units = said(file, image, "Unit").substr(0, 40);
    for (std::int64_t i = 0; i < level.sides[a]; ++i) {
      along.numbers.push_back(*least + (static_cast<double>(i) + 0.5) * distance);
    }
  }
  return positions;
}

std::string channel_names(hid_t file, int channels) {
  std::string names;
  for (int c = 0; c < channels; ++c) {
    const std::string name =
        said(file, std::string(info) + "/Channel " + std::to_string(c), "Name");
    if (name.empty()) return {};
    names += (names.empty() ? "" : ", ") + name.substr(0, 80);
  }
  return names;
}

GridArray array_of(hid_t file, const Level& level) {
  GridArray array;
  array.name = level.path;
  array.type = level.type;
  array.sides = level.sides;
  array.components = level.steps * level.channels;
  array.components_of_a_step = level.channels;
  array.reads_parts = true;
  array.positions = positions_of(file, level);
  if (array.positions[0].numbers.empty()) {
    array.notes.push_back(
        "\"" + level.path +
        "\": its ExtMin and ExtMax (DataSetInfo/Image) are no borders; the spacing "
        "is 1, give --spacing");
  }
  if (level.channels > 1) {
    const std::string names = channel_names(file, level.channels);
    array.holds = std::to_string(level.channels) + " channels";
    if (!names.empty()) array.holds += " (" + names + ")";
  }
  if (level.steps > 1) {
    array.holds += (array.holds.empty() ? "" : " of ") + std::to_string(level.steps) + " steps";
    for (int t = 0; t < level.steps; ++t) array.times.push_back(t);
    array.notes.push_back("\"" + level.path + "\": its steps in time are counted from 0");
  }
  const Id data(H5Dopen2(file, level.data(0, 0).c_str(), H5P_DEFAULT), H5Dclose, "a dataset");
  const Hdf5Fill fill =
      hdf5_fill(data.get(), {level.stored[2], level.stored[1], level.stored[0]}, level.data(0, 0));
  if (!fill.note.empty()) array.notes.push_back(fill.note);
  return array;
}

}  // namespace

bool is_imaris(hid_t file) {
  const bool is_marked =
      H5Aexists(file, "ImarisDataSet") > 0 || H5Aexists(file, "ImarisVersion") > 0 ||
      H5Aexists(file, "DataSetDirectoryName") > 0 || has_object(file, std::string(info) + "/Image");
  return is_marked && has_object(file, data_folder(file) + "/ResolutionLevel 0");
}

void list_imaris(hid_t file, GridContents& contents) {
  const std::string beginning = data_folder(file) + "/ResolutionLevel ";
  const int levels = count_of(file, beginning);
  for (int n = 0; n < levels; ++n) {
    const std::string path = beginning + std::to_string(n);
    try {
      contents.arrays.push_back(array_of(file, level_of(file, path, n == 0)));
    } catch (const Error& error) {
      if (n == 0) throw;
      contents.others.push_back({path, error.what()});
    }
  }
  if (levels > 1) {
    contents.arrays.front().notes.push_back(
        "is of Imaris and has " + std::to_string(levels) +
        " levels of resolution; the finest is read, --array \"" + beginning + "1\" takes another");
  }
}

void read_imaris(hid_t file, const std::string& name, ComponentRange range, GridValues& values) {
  const Level level = level_of(file, name, name.ends_with(" 0"));
  const GridPart part = wanted_part(level.sides, range);
  std::array<hsize_t, 3> start{}, count{};
  hsize_t points = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    start[2 - a] = static_cast<hsize_t>(part.box.first[a]);
    count[2 - a] = static_cast<hsize_t>(part.box.count[a]);
    points *= count[2 - a];
  }
  for (int i = range.first; i < range.first + range.number; ++i) {
    const std::string path = level.data(i / level.channels, i % level.channels);
    const Id data(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, path.c_str());
    const Id space(H5Dget_space(data.get()), H5Sclose, "the axes of a dataset");
    const Id memory(H5Screate_simple(1, &points, nullptr), H5Sclose, "the axes of a dataset");
    const std::span<std::byte> to = values.next(level.type);
    const bool done = to.size() == points * H5Tget_size(memory_type(level.type)) &&
                      H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr,
                                          count.data(), nullptr) >= 0 &&
                      H5Dread(data.get(), memory_type(level.type), memory.get(), space.get(),
                              H5P_DEFAULT, to.data()) >= 0;
    if (!done) throw unreadable_values(data.get(), path);
  }
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include "inviwo_values.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "files/gzip_source.h"
#include "files/memory_limit.h"
#include "pellucid/scene/error.h"
#include "raw/raw.h"
#include "text/header_keys.h"
#include "text/printable.h"
#include "text/text.h"

namespace pellucid {

namespace {

struct StoredType {
  std::string name;
  int components = 1;
};

// "Vec2FLOAT32" of Inviwo, "Vector2(float)" of Voreen: two at each point.
StoredType type_of(const std::string& format, const std::string& name) {
  static constexpr std::pair<std::string_view, const char*> types[] = {
      {"uchar", "u8"},    {"uint8", "u8"},      {"char", "i8"},     {"int8", "i8"},
      {"ushort", "u16"},  {"ushort_12", "u16"}, {"uint16", "u16"},  {"short", "i16"},
      {"int16", "i16"},   {"uint", "u32"},      {"uint32", "u32"},  {"int", "i32"},
      {"int32", "i32"},   {"float", "f32"},     {"float32", "f32"}, {"double", "f64"},
      {"float64", "f64"}, {"half", "f16"},      {"float16", "f16"}, {"int64", "i64"},
      {"uint64", "u64"}};
  std::string word = in_small_letters(format);
  StoredType type;
  if (word.starts_with("vec") && word.size() > 4 && word[3] >= '2' && word[3] <= '4') {
    type.components = word[3] - '0';
    word.erase(0, 4);
  }
  constexpr std::string_view vector_word = "vector";  // Voreen's "Vector3(float)"
  if (word.starts_with(vector_word) && word.size() > vector_word.size() + 3 &&
      word.ends_with(')') && word[6] >= '2' && word[6] <= '4' && word[7] == '(') {
    type.components = word[6] - '0';
    word = word.substr(8, word.size() - 9);
  }
  for (const auto& [known, stored] : types) {
    if (word == known) type.name = stored;
  }
  if (type.name.empty()) {
    throw Error(name + ": values of format \"" + format + "\" are not read");
  }
  return type;
}

void place(const InviwoHeader& header, const std::string& name, Volume::Description& description) {
  GridPlacement& placement = description.placement;
  if (header.spacing) placement.spacing = *header.spacing;
  if (!header.is_of_inviwo && !header.basis && !header.offset && !header.world) return;
  description.centering = Centering::cell;
  constexpr double side = 2;
  Vec3<double> all{0, 0, 0}, half_step{0, 0, 0};
  const std::array<Vec3<double>, 4> world = header.world.value_or(std::array{
      Vec3<double>{1, 0, 0}, Vec3<double>{0, 1, 0}, Vec3<double>{0, 0, 1}, Vec3<double>{0, 0, 0}});
  const auto turned = [&](const Vec3<double>& v) {
    return world[0] * v.x + world[1] * v.y + world[2] * v.z;
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const int i = static_cast<int>(a);
    Vec3<double> edge{0, 0, 0};
    edge[i] = header.spacing ? (*header.spacing)[i] * description.dimensions[a] : side;
    if (header.basis) edge = (*header.basis)[a];
    all = all + edge;
    edge = turned(edge);
    const double size = length(edge);
    if (!(size > 0) || !std::isfinite(size)) {
      throw Error(name + ": a basis vector has no length; mend the header");
    }
    placement.direction.column[i] = edge * (1 / size);
    placement.spacing[i] = size / description.dimensions[a];
    half_step = half_step + edge * (0.5 / description.dimensions[a]);
  }
  placement.origin = turned(header.offset.value_or(all * -0.5)) + world[3] + half_step;
}

/// Returns the values that stored ones stand for.
VolumeData mapped(const VolumeData& stored, const InviwoHeader& header, const std::string& name) {
  const double from = (*header.data_range)[0], to = (*header.data_range)[1];
  const double first = (*header.value_range)[0], last = (*header.value_range)[1];
  const double slope = (last - first) / (to - from);
  return std::visit(
      [&](const auto& values) -> VolumeData {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        using Real =
            std::conditional_t<(sizeof(Value) > 2 && !std::is_same_v<Value, float>), double, float>;
        check_memory(std::uintmax_t{values.size()} * sizeof(Real), name + ": its values");
        DataArray<Real> real(values.size());
        std::ranges::transform(values, real.writable().begin(), [&](Value value) {
          return static_cast<Real>(first + slope * (static_cast<double>(value) - from));
        });
        return real;
      },
      stored);
}

bool changes_values(const InviwoHeader& header, const std::string& name) {
  if (!header.value_range || !header.data_range || header.value_range == header.data_range) {
    return false;
  }
  if ((*header.data_range)[0] != (*header.data_range)[1]) return true;
  throw Error(name + ": DataRange has no length, and ValueRange maps it; mend the header");
}

void tell(const InviwoHeader& header, const std::string& name, const Note& note) {
  if (!note) return;
  if (!header.unit.empty()) {
    note(name + ": its values are in " + printable(header.unit) + " (Unit)");
  }
  if (header.value_range && !header.data_range) {
    note(name +
         ": says a ValueRange, but no DataRange that is mapped to it; the values are those stored");
  }
  note_ignored_keys(note, name, header.ignored_keys);
}

}  // namespace

int inviwo_side(double side, const std::string& name) {
  if (side >= 1 && side <= 1e9 && side == std::floor(side)) return static_cast<int>(side);
  throw Error(name + ": the header's sides are not all whole numbers from 1; mend the header");
}

VolumeFile open_inviwo_values(const InviwoHeader& header, const std::string& name,
                              const ReadOptions& options) {
  const StoredType stored = type_of(header.format, name);
  if (header.steps > 1 && stored.components > 1) {
    throw Error(name + ": holds " + std::to_string(header.steps) + " steps of " + header.format +
                "; save one of them as a file of its own");
  }
  ReadOptions raw;
  raw.dimensions = header.dimensions;
  raw.type = stored.name;
  raw.big_endian = header.big_endian;
  raw.skip_bytes = header.skip_bytes;
  if (stored.components > 1) raw.components = stored.components;
  if (header.steps > 1) raw.components = header.steps;
  const ByteSource source =
      header.compressed ? gzip_source(header.values) : file_source(header.values);
  raw.note = options.note;
  VolumeFile file = open_raw(source, raw);
  if (header.steps > 1) {
    const ValueLayout layout{stored.name, header.big_endian, header.skip_bytes, header.steps,
                             false,       options.note};
    const std::size_t count =
        value_count({header.dimensions[0], header.dimensions[1], header.dimensions[2]}, name);
    file.holds = std::to_string(header.steps) + " time steps (Sequences)";
    file.reads_parts = source.map && reads_parts(layout);
    file.read = [source, layout, count](ComponentRange range) {
      return read_components(source, layout, count, range);
    };
  }
  if (changes_values(header, name)) {
    file.read = [read = file.read, header, name](ComponentRange range) {
      std::vector<VolumeData> list = read(range);
      for (VolumeData& data : list) data = mapped(data, header, name);
      return list;
    };
  }
  tell(header, name, options.note);
  file.description.name = name;
  place(header, name, file.description);
  apply_overrides(options, file.description);
  return file;
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include "inviwo_values.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "gzip_source.h"
#include "pellucid/scene/error.h"
#include "text.h"

namespace pellucid {

namespace {

struct StoredType {
  std::string name;
  int components = 1;
};

// "Vec2FLOAT32" of Inviwo, "Vector2(float)" of Voreen: two at each point.
StoredType type_of(const std::string& format, const std::string& name) {
  static constexpr std::pair<std::string_view, const char*> types[] = {
      {"uchar", "u8"},   {"uint8", "u8"},    {"char", "i8"},    {"int8", "i8"},
      {"ushort", "u16"}, {"uint16", "u16"},  {"short", "i16"},  {"int16", "i16"},
      {"uint", "u32"},   {"uint32", "u32"},  {"int", "i32"},    {"int32", "i32"},
      {"float", "f32"},  {"float32", "f32"}, {"double", "f64"}, {"float64", "f64"},
      {"half", "f16"},   {"float16", "f16"}, {"int64", "i64"},  {"uint64", "u64"}};
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
  if (!header.basis) return;
  description.centering = Centering::cell;
  Vec3<double> all{0, 0, 0}, half_step{0, 0, 0};
  for (std::size_t a = 0; a < 3; ++a) {
    const int i = static_cast<int>(a);
    const Vec3<double>& edge = (*header.basis)[a];
    const double size = length(edge);
    if (!(size > 0)) throw Error(name + ": a basis vector has no length; mend the header");
    placement.direction.column[i] = edge * (1 / size);
    placement.spacing[i] = size / description.dimensions[a];
    all = all + edge;
    half_step = half_step + edge * (0.5 / description.dimensions[a]);
  }
  placement.origin = header.offset.value_or(all * -0.5) + half_step;
}

}  // namespace

int inviwo_side(double side, const std::string& name) {
  if (side >= 1 && side <= 1e9 && side == std::floor(side)) return static_cast<int>(side);
  throw Error(name + ": the header's sides are not all whole numbers from 1; mend the header");
}

VolumeFile open_inviwo_values(const InviwoHeader& header, const std::string& name,
                              const ReadOptions& options) {
  const StoredType stored = type_of(header.format, name);
  ReadOptions raw;
  raw.dimensions = header.dimensions;
  raw.type = stored.name;
  raw.big_endian = header.big_endian;
  raw.skip_bytes = header.skip_bytes;
  if (stored.components > 1) raw.components = stored.components;
  const ByteSource source =
      header.compressed ? gzip_source(header.values) : file_source(header.values);
  raw.note = options.note;
  VolumeFile file = open_raw(source, raw);
  file.description.name = name;
  place(header, name, file.description);
  apply_overrides(options, file.description);
  return file;
}

}  // namespace pellucid

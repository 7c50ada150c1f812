// SPDX-License-Identifier: Apache-2.0
#include "mesh_archive.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace pellucid {

namespace {

/// Counts the bytes where there is nowhere to write to.
class Writer {
 public:
  static constexpr bool reads = false;
  explicit Writer(std::span<std::byte> to = {}) : to_(to) {}

  std::size_t size() const { return size_; }
  void bytes(const void* data, std::size_t size) {
    size_ += size;
    if (to_.empty() || size == 0) return;
    std::memcpy(to_.data(), data, size);
    to_ = to_.subspan(size);
  }
  template <class List>
  void list(const List& values) {
    const std::uint64_t count = values.size();
    bytes(&count, sizeof(count));
    bytes(values.data(), values.size() * sizeof(values[0]));
  }

 private:
  std::span<std::byte> to_;
  std::size_t size_ = 0;
};

class Reader {
 public:
  static constexpr bool reads = true;
  explicit Reader(std::span<const std::byte> from) : from_(from) {}

  bool good() const { return good_; }
  void bytes(void* data, std::size_t size) {
    good_ = good_ && size <= from_.size();
    if (!good_ || size == 0) return;
    std::memcpy(data, from_.data(), size);
    from_ = from_.subspan(size);
  }
  template <class List>
  void list(List& values) {
    std::uint64_t count = 0;
    bytes(&count, sizeof(count));
    using Value = std::remove_cvref_t<decltype(values[0])>;
    good_ = good_ && count <= from_.size() / sizeof(Value);
    if (!good_) return;
    if constexpr (requires { values.writable(); }) {
      values = List(count);
      bytes(values.writable().data(), count * sizeof(Value));
    } else {
      values.resize(count);
      bytes(values.data(), count * sizeof(Value));
    }
  }

 private:
  std::span<const std::byte> from_;
  bool good_ = true;
};

template <class Archive, class Value>
void plain(Archive& archive, Value& value) {
  static_assert(std::is_trivially_copyable_v<Value>);
  archive.bytes(&value, sizeof(value));
}

/// Archives the number of things that follow, each of which takes a byte at least.
template <class Archive, class List>
void sized(Archive& archive, List& list) {
  std::uint64_t count = list.size();
  plain(archive, count);
  if constexpr (Archive::reads) {
    constexpr std::uint64_t most = 1 << 24;
    if (archive.good() && count <= most) list.resize(count);
  }
}

template <class Archive, class Array>
void exchange_array(Archive& archive, Array& array) {
  archive.list(array.name);
  plain(archive, array.centering);
  plain(archive, array.components);
  std::string type(type_name(array.values));
  archive.list(type);
  if constexpr (Archive::reads) {
    if (!archive.good()) return;
    array.values = make_volume_data(type, 0);
  }
  std::visit([&](auto& values) { archive.list(values); }, array.values);
}

/// Writes or reads, by the kind of the archive.
template <class Archive, class Mesh>
void exchange(Archive& archive, Mesh& mesh) {
  auto& file = mesh.file;
  archive.list(file.format);
  archive.list(file.active);
  archive.list(file.times);
  bool has_time = file.time.has_value();
  double time = file.time.value_or(0);
  plain(archive, has_time);
  plain(archive, time);
  if constexpr (Archive::reads) {
    if (has_time) file.time = time;
  }
  plain(archive, file.flat_cells);
  plain(archive, file.ghost_cells);
  plain(archive, file.trimmed_cells);
  plain(archive, file.first_trimmed_cell);
  sized(archive, file.notes);
  for (auto& note : file.notes) archive.list(note);
  plain(archive, mesh.cells);
  plain(archive, mesh.is_active_of_cells);
  sized(archive, mesh.blocks);
  for (auto& block : mesh.blocks) {
    archive.list(block.points);
    archive.list(block.shapes);
    archive.list(block.corners);
    archive.list(block.layouts);
    archive.list(block.cell_numbers);
    sized(archive, block.arrays);
    for (auto& array : block.arrays) exchange_array(archive, array);
  }
}

/// Returns whether nothing points out of it: the process may have written anywhere before it ended.
bool agrees_with_itself(const UnstructuredGrid& block) {
  const std::size_t points = block.points.size(), cells = block.shapes.size();
  return std::ranges::all_of(block.corners,
                             [&](std::int32_t corner) {
                               return corner >= 0 && static_cast<std::size_t>(corner) < points;
                             }) &&
         (block.cell_numbers.empty() || block.cell_numbers.size() == cells) &&
         std::ranges::all_of(block.arrays, [&](const MeshArray& array) {
           const std::size_t places = array.centering == Centering::point ? points : cells;
           const std::size_t count =
               std::visit([](const auto& values) { return values.size(); }, array.values);
           return array.components > 0 &&
                  count == places * static_cast<std::size_t>(array.components);
         });
}

}  // namespace

void write_mesh_blocks(const MeshBlocks& mesh, const MakeAnswer& make) {
  Writer counter;
  exchange(counter, mesh);
  Writer writer(make(counter.size()));
  exchange(writer, mesh);
}

std::optional<MeshBlocks> read_mesh_blocks(std::span<const std::byte> from) {
  Reader reader(from);
  MeshBlocks mesh;
  exchange(reader, mesh);
  if (!reader.good() || !std::ranges::all_of(mesh.blocks, agrees_with_itself)) return std::nullopt;
  return mesh;
}

}  // namespace pellucid

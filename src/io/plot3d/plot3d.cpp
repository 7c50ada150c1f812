// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "meshes/mesh_blocks.h"
#include "meshes/mesh_format.h"
#include "pellucid/scene/error.h"
#include "volumes/volume_source.h"

namespace pellucid {

namespace {

using Dimensions = std::array<std::int32_t, 3>;

/// Layout of the numbers of a file.
struct Layout {
  bool big_endian = false;
  bool marks = false;    ///< each record between two lengths, as Fortran writes them
  bool several = false;  ///< the number of blocks comes first
  bool wide = false;     ///< f64
  bool blanking = false;

  std::size_t real() const { return wide ? 8 : 4; }
  std::size_t mark() const { return marks ? 4 : 0; }
};

/// A file, read from front to back.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : source_(file_source(path)) {}

  std::uintmax_t size() const { return source_.size; }
  const std::string& name() const { return source_.name; }
  std::uintmax_t at() const { return at_; }
  void go_to(std::uintmax_t at) { at_ = at; }

  bool has(std::uintmax_t bytes) const { return at_ <= size() && size() - at_ >= bytes; }

  /// Reads an integer. The caller has asked has().
  std::int32_t integer(bool big_endian) {
    std::array<std::byte, 4> bytes{};
    source_.read(at_, bytes);
    at_ += bytes.size();
    if (big_endian != (std::endian::native == std::endian::big)) std::ranges::reverse(bytes);
    return std::bit_cast<std::int32_t>(bytes);
  }

  VolumeData values(const char* type, bool big_endian, std::size_t count) {
    ValueLayout layout{type, big_endian, at_, 1, false};
    check_size(source_, layout, count);
    // Not in place: what is mapped is an index of a volume.
    VolumeData data = make_values(type, count, name());
    std::visit([&](auto& values) { source_.read(at_, std::as_writable_bytes(values.writable())); },
               data);
    to_native_order(data, big_endian);
    at_ += count * value_size(type, name());
    return data;
  }

 private:
  ByteSource source_;
  std::uintmax_t at_ = 0;
};

std::int64_t points_of(const Dimensions& d) {
  return std::int64_t{d[0]} * d[1] * d[2];
}

/// Returns the dimensions of the blocks where the file's head can be read so; the reader then
/// stands behind them.
std::optional<std::vector<Dimensions>> read_head(Reader& file, const Layout& layout) {
  constexpr int max_blocks = 1 << 20;
  file.go_to(0);
  int blocks = 1;
  if (layout.several) {
    file.go_to(layout.mark());
    if (!file.has(4)) return std::nullopt;
    blocks = file.integer(layout.big_endian);
    if (blocks < 1 || blocks > max_blocks) return std::nullopt;
    file.go_to(file.at() + layout.mark());
  }
  file.go_to(file.at() + layout.mark());
  if (!file.has(std::uintmax_t{12} * static_cast<std::uintmax_t>(blocks))) return std::nullopt;
  std::vector<Dimensions> list(static_cast<std::size_t>(blocks));
  for (Dimensions& block : list) {
    std::int64_t points = 1;
    for (std::int32_t& side : block) {
      side = file.integer(layout.big_endian);
      if (side < 1) return std::nullopt;
      points *= side;
      if (points > std::numeric_limits<std::int32_t>::max()) return std::nullopt;
    }
  }
  file.go_to(file.at() + layout.mark());
  return list;
}

/// Returns the bytes of a grid's file behind its head.
std::uintmax_t grid_bytes(const std::vector<Dimensions>& blocks, const Layout& layout) {
  std::uintmax_t bytes = 0;
  for (const Dimensions& block : blocks) {
    const auto points = static_cast<std::uintmax_t>(points_of(block));
    bytes += points * (3 * layout.real() + (layout.blanking ? 4 : 0)) + 2 * layout.mark();
  }
  return bytes;
}

struct Head {
  Layout layout;
  std::vector<Dimensions> blocks;
};

/// Returns the layout in which the file is as long as its head says. Some are padded to whole
/// sectors.
Head find_head(Reader& file) {
  constexpr std::uintmax_t longest_padding = 511;
  std::optional<Head> best;
  std::uintmax_t least = longest_padding + 1;
  for (unsigned choice = 0; choice < 32; ++choice) {
    const Layout layout{(choice & 1) != 0, (choice & 2) != 0, (choice & 4) != 0, (choice & 8) != 0,
                        (choice & 16) != 0};
    const auto blocks = read_head(file, layout);
    if (!blocks) continue;
    const std::uintmax_t bytes = grid_bytes(*blocks, layout);
    if (!file.has(bytes)) continue;
    const std::uintmax_t rest = file.size() - file.at() - bytes;
    if (rest >= least) continue;
    least = rest;
    best = {layout, *blocks};
  }
  if (!best) {
    throw Error(file.name() +
                ": is no binary PLOT3D grid of three dimensions (in none of its layouts are its "
                "dimensions those of a file of " +
                std::to_string(file.size()) + " bytes); it is cut off, or of another format");
  }
  return *std::move(best);
}

const char* real_type(const Layout& layout) {
  return layout.wide ? "f64" : "f32";
}

/// Adds the hexahedra whose eight points are all shown.
void add_cells(const Dimensions& d, const DataArray<std::int32_t>& shown, UnstructuredGrid& block,
               std::size_t& hidden) {
  const std::int32_t row = d[0], layer = d[0] * d[1];
  for (std::int32_t z = 0; z + 1 < d[2]; ++z) {
    for (std::int32_t y = 0; y + 1 < d[1]; ++y) {
      for (std::int32_t x = 0; x + 1 < d[0]; ++x) {
        const std::int32_t p = x + row * y + layer * z;
        std::array<std::int32_t, 8> corners{};
        for (std::size_t i = 0; i < 8; ++i) {
          constexpr std::array<std::int32_t, 4> right{0, 1, 1, 0}, back{0, 0, 1, 1};
          corners[i] = p + right[i % 4] + row * back[i % 4] + (i < 4 ? 0 : layer);
        }
        const auto is_hidden = [&](std::int32_t i) {
          return shown[static_cast<std::size_t>(i)] == 0;
        };
        if (!shown.empty() && std::ranges::any_of(corners, is_hidden)) {
          ++hidden;
          continue;
        }
        block.corners.insert(block.corners.end(), corners.begin(), corners.end());
        block.shapes.push_back(CellShape::hexahedron);
      }
    }
  }
}

UnstructuredGrid read_block(Reader& file, const Layout& layout, const Dimensions& d,
                            MeshFile& about) {
  const auto count = static_cast<std::size_t>(points_of(d));
  UnstructuredGrid block;
  block.points.resize(count);
  file.go_to(file.at() + layout.mark());
  for (int axis = 0; axis < 3; ++axis) {
    std::visit(
        [&](const auto& values) {
          for (std::size_t i = 0; i < count; ++i) {
            block.points[i][axis] = static_cast<double>(values[i]);
          }
        },
        file.values(real_type(layout), layout.big_endian, count));
  }
  DataArray<std::int32_t> shown;
  if (layout.blanking) {
    shown = std::get<DataArray<std::int32_t>>(file.values("i32", layout.big_endian, count));
  }
  file.go_to(file.at() + layout.mark());
  const std::size_t most =
      count == 0 ? 0 : static_cast<std::size_t>(std::int64_t{d[0] - 1} * (d[1] - 1) * (d[2] - 1));
  block.shapes.reserve(most);
  block.corners.reserve(most * 8);
  if (most > 0) {
    add_cells(d, shown, block, about.ghost_cells);
  } else {
    // Those of the sheet, the line or the point that it is.
    const auto along = [&](std::size_t axis) {
      return static_cast<std::size_t>(std::max(d[axis] - 1, 1));
    };
    about.flat_cells += count == 0 ? 0 : along(0) * along(1) * along(2);
  }
  return block;
}

/// Adds the quantities that follow from density, momentum and energy, for an ideal gas whose ratio
/// of specific heats is 1.4, in units of density and speed of sound of the free stream; the gas
/// constant is 1. Where there is no density there is nothing.
template <class Value>
void add_derived(const DataArray<Value>& q, UnstructuredGrid& block) {
  constexpr double gamma = 1.4;
  const std::size_t n = q.size() / 5;
  DataArray<Value> velocity(3 * n), pressure(n), temperature(n);
  const std::span<Value> v = velocity.writable(), p = pressure.writable(),
                         t = temperature.writable();
  for (std::size_t i = 0; i < n; ++i) {
    const auto density = static_cast<double>(q[i]);
    double square = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double speed = density != 0 ? static_cast<double>(q[(1 + a) * n + i]) / density
                                        : std::numeric_limits<double>::quiet_NaN();
      v[3 * i + a] = static_cast<Value>(speed);
      square += speed * speed;
    }
    const double of_gas = (gamma - 1) * (static_cast<double>(q[4 * n + i]) - density * square / 2);
    p[i] = static_cast<Value>(of_gas);
    t[i] = static_cast<Value>(of_gas / density);
  }
  block.arrays.push_back({"Velocity", Centering::point, 3, std::move(velocity)});
  block.arrays.push_back({"Pressure", Centering::point, 1, std::move(pressure)});
  block.arrays.push_back({"Temperature", Centering::point, 1, std::move(temperature)});
}

/// Adds the five numbers of a block's points, which lie one behind the other.
template <class Value>
void add_solution(const DataArray<Value>& q, UnstructuredGrid& block) {
  const std::size_t n = q.size() / 5;
  DataArray<Value> density(n), momentum(3 * n), energy(n);
  std::copy_n(q.begin(), n, density.writable().begin());
  std::copy_n(q.begin() + 4 * n, n, energy.writable().begin());
  const std::span<Value> m = momentum.writable();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t a = 0; a < 3; ++a) m[3 * i + a] = q[(1 + a) * n + i];
  }
  block.arrays.push_back({"Density", Centering::point, 1, std::move(density)});
  block.arrays.push_back({"Momentum", Centering::point, 3, std::move(momentum)});
  block.arrays.push_back({"StagnationEnergy", Centering::point, 1, std::move(energy)});
  add_derived(q, block);
}

void read_solution(const std::filesystem::path& path, const Head& grid, MeshBlocks& mesh) {
  Reader file(path);
  const auto blocks = read_head(file, grid.layout);
  if (!blocks || *blocks != grid.blocks) {
    throw Error(file.name() +
                ": has other dimensions than the grid, or another byte order; give the solution "
                "that belongs to it");
  }
  // The numbers need not be as wide as those of the grid.
  Layout layout = grid.layout;
  const auto bytes = [&] {
    std::uintmax_t sum = 0;
    for (const Dimensions& block : *blocks) {
      sum += (4 + 5 * static_cast<std::uintmax_t>(points_of(block))) * layout.real() +
             4 * layout.mark();
    }
    return sum;
  };
  layout.wide = true;
  if (!file.has(bytes())) layout.wide = false;
  if (!file.has(bytes())) {
    throw Error(file.name() + ": has " + std::to_string(file.size()) +
                " bytes, too few for five numbers at each point of the grid; it is cut off");
  }
  for (std::size_t b = 0; b < blocks->size(); ++b) {
    // Mach number, angle of attack, Reynolds number, time.
    file.go_to(file.at() + 4 * layout.real() + 3 * layout.mark());
    const auto count = static_cast<std::size_t>(points_of((*blocks)[b]));
    const VolumeData q = file.values(real_type(layout), layout.big_endian, 5 * count);
    file.go_to(file.at() + layout.mark());
    if (const auto* narrow = std::get_if<DataArray<float>>(&q)) {
      add_solution(*narrow, mesh.blocks[b]);
    } else {
      add_solution(std::get<DataArray<double>>(q), mesh.blocks[b]);
    }
  }
}

/// Reads a PLOT3D grid of three dimensions, and its solution where `q` is not empty. How the
/// numbers lie in the file is found by its size. Throws Error.
MeshBlocks read_plot3d(const std::filesystem::path& xyz, const std::filesystem::path& q) {
  Reader file(xyz);
  const Head head = find_head(file);
  read_head(file, head.layout);  // to stand behind it
  MeshBlocks mesh;
  mesh.file.format = "PLOT3D";
  mesh.blocks.reserve(head.blocks.size());
  for (const Dimensions& d : head.blocks) {
    mesh.blocks.push_back(read_block(file, head.layout, d, mesh.file));
  }
  if (!q.empty()) read_solution(q, head, mesh);
  return mesh;
}

}  // namespace

extern const MeshFormat plot3d_format{
    .name = "PLOT3D",
    .extensions = ".xyz .p3d .x",
    .read =
        [](const std::filesystem::path& path, const MeshReadOptions& options) {
          if (options.time)
            throw Error(path.string() + ": the file has no steps in time; leave the time out");
          return read_plot3d(path, options.q);
        },
    .takes_solution = true};

}  // namespace pellucid

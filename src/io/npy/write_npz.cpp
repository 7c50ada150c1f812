// SPDX-License-Identifier: Apache-2.0
#include "write_npz.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/zip_writer.h"
#include "npy.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

/// Names of arrays that say where others are.
constexpr std::string_view companions[] = {"affine", "x", "y", "z", npz_space};

std::span<const std::byte> bytes_of(const std::vector<double>& numbers) {
  return std::as_bytes(std::span(numbers));
}

void put_array(ZipWriter& archive, const std::string& name, const std::string& header,
               std::uint64_t bytes) {
  archive.begin(name + ".npy", header.size() + bytes);
  archive.put(std::as_bytes(std::span(header)));
}

void put_numbers(ZipWriter& archive, const std::string& name, const std::vector<double>& numbers,
                 const std::vector<std::size_t>& shape) {
  put_array(archive, name, npy_header("f64", shape), 8 * numbers.size());
  archive.put(bytes_of(numbers));
}

/// Returns the matrix that maps indices of x, y and z to right, anterior and superior: nibabel's
/// "affine" of an array with these axes.
std::vector<double> affine_of(const GridPlacement& placement) {
  std::vector<double> matrix;
  matrix.reserve(16);
  const Vec3<double> spacing = placement.spacing;
  const auto& direction = placement.direction.column;
  const std::array<Vec3<double>, 4> columns{spacing.x * direction[0], spacing.y * direction[1],
                                            spacing.z * direction[2], placement.origin};
  for (const Vec3<double>& column : columns) matrix.push_back(-column.x);
  for (const Vec3<double>& column : columns) matrix.push_back(-column.y);
  for (const Vec3<double>& column : columns) matrix.push_back(column.z);
  matrix.insert(matrix.end(), {0, 0, 0, 1});
  return matrix;
}

/// Puts positions along the axes, where one is rectilinear: those of uniform axes as well.
void put_positions(ZipWriter& archive, const Volume::Description& d, const std::string& path) {
  const GridPlacement& placement = d.placement;
  if (d.centering == Centering::cell) {
    throw Error(path +
                ": not written: cells of several sizes, with values in them, cannot be held "
                "by .npz; write tetrahedra, .vtu");
  }
  if (placement.direction != Mat3<double>()) {
    throw Error(path +
                ": not written: the values stand at positions of their own along axes that "
                "are turned, which .npz cannot hold; write tetrahedra, .vtu");
  }
  const std::array<double, 3> origin{placement.origin.x, placement.origin.y, placement.origin.z};
  const std::array<double, 3> spacing{placement.spacing.x, placement.spacing.y,
                                      placement.spacing.z};
  for (std::size_t a = 0; a < 3; ++a) {
    std::vector<double> positions = d.coordinates[a];
    if (positions.empty()) {
      for (int i = 0; i < d.dimensions[a]; ++i) positions.push_back(i * spacing[a]);
    }
    for (double& x : positions) x += origin[a];
    put_numbers(archive, std::string(1, "xyz"[a]), positions, {positions.size()});
  }
}

}  // namespace

bool has_npz_matrix(const Volume::Description& description) {
  return std::ranges::all_of(description.coordinates,
                             [](const auto& positions) { return positions.empty(); });
}

Losses write_npz(const WrittenVolume& volume, const Sink& sink) {
  const Volume::Description& d = volume.description();
  const bool is_uniform = has_npz_matrix(d);
  // As nibabel has it where there is a matrix, as xarray where there are coordinates: x is fastest
  // in memory in both.
  std::vector<std::size_t> shape;
  for (const int side : d.dimensions) shape.push_back(static_cast<std::size_t>(side));
  if (!is_uniform) std::swap(shape[0], shape[2]);
  if (volume.count() > 1) shape.push_back(static_cast<std::size_t>(volume.count()));
  ZipWriter archive(sink);
  Losses losses;
  std::string name = volume.array;
  if (std::ranges::find(companions, name) != std::end(companions)) {
    name += "_values";
    losses.push_back("the array is named " + name + ", for " + volume.array +
                     " says in .npz where another one is");
  }
  const std::string header = npy_header(type_name(volume.data()), shape, is_uniform);
  std::uint64_t bytes = 0;
  std::visit([&](const auto& values) { bytes = values.size() * sizeof(*values.data()); },
             volume.data());
  put_array(archive, name, header, bytes * static_cast<std::uint64_t>(volume.count()));
  const Sink into_archive = [&](std::span<const std::byte> part) { archive.put(part); };
  if (is_uniform) {
    put_one_by_one(volume, into_archive);
  } else {
    put_interleaved(volume, into_archive);
  }
  if (is_uniform) {
    put_numbers(archive, "affine", affine_of(d.placement), {4, 4});
    if (d.centering == Centering::cell) {
      losses.emplace_back(
          ".npz does not say that the values stand in cells; read it with --centering cell");
    }
  } else {
    put_positions(archive, d, volume.path);
  }
  if (!volume.space.empty()) {
    put_array(archive, npz_space, npy_header("u8", {volume.space.size()}), volume.space.size());
    archive.put(std::as_bytes(std::span(volume.space)));
  }
  archive.finish();
  return losses;
}

extern const VolumeWriter npz_writer{
    .extension = ".npz", .write = write_npz, .keeps_positions = true};

}  // namespace pellucid

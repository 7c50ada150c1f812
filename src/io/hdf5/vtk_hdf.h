// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "volumes/components.h"

namespace pellucid {

/// The name of an array that says which places are ghosts or hidden.
inline constexpr const char* ghost_flags = "vtkGhostType";

/// An array of a VTKHDF file.
struct VtkHdfArray {
  enum class Place : std::uint8_t { root, point, cell } place = Place::root;
  std::string name;
  std::string type;                 ///< that its values are kept in
  std::vector<std::int64_t> sides;  ///< in the file's order, at most five
  std::string fault;                ///< why it cannot be read; empty: it can
};

/// Numbers of the group Steps, one for each step: "Values", "PartOffsets", or of an array
/// "PointDataOffsets/T".
struct VtkHdfStepList {
  std::string name;
  std::vector<double> numbers;
};

/// Contents of the group VTKHDF of a file.
struct VtkHdfContents {
  std::string type;  ///< "ImageData" …; empty: there is no such group
  std::int64_t version = 0;
  std::int64_t steps = 0;                                  ///< in time; 0: it knows no time
  std::vector<double> extent, origin, spacing, direction;  ///< as many numbers as there are
  std::string point_scalars, cell_scalars;                 ///< the active ones
  std::vector<VtkHdfArray> arrays;
  std::vector<VtkHdfStepList> step_lists;  ///< each with as many numbers as there are steps
  std::string error;

  /// Returns the times of the steps; counted from 0 where the file does not say them.
  std::vector<double> times() const;
  /// Returns the number that a list has for a step, a whole one from 0; `otherwise` where there is
  /// no such list. Throws Error, without the file's name, where it is no such number.
  std::int64_t of_step(const std::string& list, std::size_t step, std::int64_t otherwise) const;
};

/// Which values of an array are read, and where they go.
struct VtkHdfWanted {
  VtkHdfArray array;
  std::optional<std::int64_t> component;  ///< of the last axis; none: all values
  std::optional<IndexBox> box;            ///< of the three axes in front, x first; none: all
  /// First and number along the first axis, in front of those of the box; none: all.
  std::optional<std::array<std::int64_t, 2>> rows;
  std::span<std::byte> to;
};

/// The functions of HDF5's module, by these names. They are called in a process of their own, for
/// the library does not stand any file that is damaged. No exception leaves them.
using ListVtkHdf = void(const std::filesystem::path& path, VtkHdfContents& answer);
using ReadVtkHdf = void(const std::filesystem::path& path, std::span<const VtkHdfWanted> wanted,
                        std::string& error);
inline constexpr const char* list_vtk_hdf_name = "pellucid_list_vtk_hdf_2";
inline constexpr const char* read_vtk_hdf_name = "pellucid_read_vtk_hdf_3";

/// Returns the contents of a file; nothing if it is no VTKHDF file. Asks HDF5 only where the first
/// bytes, or the name, are of that kind. Throws Error where HDF5 cannot read it, or the build has
/// none.
std::optional<VtkHdfContents> vtk_hdf_contents(const std::filesystem::path& path);
/// Returns the same of a file that is one. Throws Error for kinds and versions that are not read.
VtkHdfContents vtk_hdf_contents(const std::filesystem::path& path, const char* type);
/// Returns the type of the file's data; empty: it is none, or cannot be read.
std::string vtk_hdf_type(const std::filesystem::path& path);

/// The values of arrays one behind the other, each from a multiple of 8 bytes on.
class VtkHdfValues {
 public:
  /// Begins without the values.
  explicit VtkHdfValues(std::filesystem::path path) : path_(std::move(path)) {}
  /// Returns the number by which its values are asked for.
  std::size_t want(const VtkHdfArray& array, std::optional<std::int64_t> component = {},
                   const std::optional<IndexBox>& box = {},
                   const std::optional<std::array<std::int64_t, 2>>& rows = {});
  /// Reads all that is wanted. Throws Error, also where memory does not hold it.
  void read();
  /// Returns the values, in the array's type, in place: they live as long as anyone has them.
  VolumeData operator[](std::size_t number) const;

 private:
  struct Entry {
    VtkHdfArray array;
    std::optional<std::int64_t> component;
    std::optional<IndexBox> box;
    std::optional<std::array<std::int64_t, 2>> rows;
    std::size_t count, offset;
  };
  std::filesystem::path path_;
  std::vector<Entry> entries_;
  std::size_t bytes_ = 0;
  std::shared_ptr<std::byte> all_;
};

}  // namespace pellucid

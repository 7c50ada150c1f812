// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files/data_stream.h"
#include "stored_numbers.h"
#include "volume_source.h"

namespace pellucid {

struct ArrayBeside;

/// A part of a grid with so many values along its axes.
struct GridPart {
  std::array<int, 3> dimensions;
  IndexBox box;
};

/// Returns the number of values of a box.
inline std::size_t value_count(const IndexBox& box) noexcept {
  std::size_t count = 1;
  for (const int side : box.count) count *= static_cast<std::size_t>(side);
  return count;
}

/// Components first … first + number - 1 of a file.
struct ComponentRange {
  int first = 0, number = 1;
  /// The part of the grid that is wanted; null: all. Whoever can reads no more; others read all.
  const GridPart* part = nullptr;
};

/// The space of a patient that worlds are turned to, as world_space() names it.
inline constexpr const char* patient_space = "LPS";

/// A file whose header has been read: its grid, and its values when they are asked for.
struct VolumeFile {
  Volume::Description description;
  int components = 1;
  std::string holds;  ///< what several components are: "3 time steps (axis 4)"
  /// The file's names of the components, which need not differ; empty: it has none.
  std::vector<std::string> component_names;
  /// Full light of colors, RGB or RGBA in sRGB: the number of full light; 0: the components are no
  /// colors.
  double largest_color = 0;
  std::vector<double> times;  ///< of its steps, in the order of the file; empty: it has none
  std::string times_unit;     ///< text of the file: "s"; empty: it says none
  std::optional<int> step;    ///< the component that a time chose
  bool reads_parts = false;   ///< whether `read` reads a part of the grid without the rest
  std::string array;  ///< the one of the file's arrays that this is; empty: they have no names
  std::string space;  ///< that it is placed in, see world_space()
  /// The values of each component by itself. Throws Error.
  std::function<std::vector<VolumeData>(ComponentRange)> read;
};

/// Reads the one volume that the options choose, or that there is. Throws Error where the file has
/// several and none is chosen, or the chosen one is not there.
Volume read_chosen(const VolumeFile& file, const ReadOptions& options);
/// Reads all of them, or the chosen one alone.
std::vector<Volume> read_all(const VolumeFile& file, const ReadOptions& options);

/// Fills a span with the bytes that come next.
using ReadOn = std::function<void(std::span<std::byte>)>;
/// Returns what reads from this byte of the source on, which must hold what is asked for and
/// outlive the function.
ReadOn read_on(const ByteSource& source, std::uintmax_t from);

/// Returns the number of values of all components. Throws Error where no machine holds so many.
std::size_t value_count(std::size_t points, int components, const std::string& name);

/// Returns whether the next function reads a part of a grid without the rest.
bool reads_parts(const ValueLayout& layout);
/// Reads each component of `points` values, as ValueLayout says how they lie; those that lie as in
/// memory in place. The source must hold all components.
std::vector<VolumeData> read_components(const ByteSource& source, const ValueLayout& layout,
                                        std::size_t points, ComponentRange range);
/// Reads the same from a stream that stands at the first value of the first component. Reads on to
/// the end of the last, so that a stream that is cut off is found out.
std::vector<VolumeData> read_components(DataStream& stream, const ValueLayout& layout,
                                        std::size_t points, ComponentRange range);

/// Components that lie side by side in memory, each by itself; one alone is not copied. Throws
/// Error where there is no memory for them.
std::vector<VolumeData> split_components(const VolumeData& values, int components,
                                         ComponentRange range, const std::string& name);

/// Gives whole numbers of components, each of `points` values, one type and takes them out. `note`
/// is told after `name` how many were rounded; it may be missing.
std::vector<VolumeData> take_components(std::vector<WholeNumbers>& components, std::size_t points,
                                        const std::string& name,
                                        const std::function<void(const std::string&)>& note);

}  // namespace pellucid

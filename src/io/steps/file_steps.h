// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "volumes/components.h"

namespace pellucid {

/// A file that is one step in time of several.
struct FileStep {
  double time = 0;
  std::filesystem::path file;
};

/// Returns whether a path stands for files that are steps: a list of ParaView's (".vtu.series"), or
/// a pattern of names with numbers ("run_%04d.vti", "run_*.vti") that is no file itself and no
/// pattern of images, which are slices.
bool lists_file_steps(const std::filesystem::path& path);

/// Returns the steps of such a path, ascending by time. The times are those that a list says; of a
/// pattern those that all files state themselves (TimeValue of VTK's files), else the numbers of
/// the names. Throws Error, also where two files have one time.
std::vector<FileStep> file_steps(const std::filesystem::path& path);

/// Returns the step nearest to a time, the first without one. Throws Error that begins with the
/// path for a time that is not finite.
const FileStep& nearest_file(const std::vector<FileStep>& steps, std::optional<double> time,
                             const std::filesystem::path& path);
/// Returns their times.
std::vector<double> times_of(const std::vector<FileStep>& steps);

/// Opens the volume at the time that the options ask for. Throws Error, also where that file has
/// steps of its own.
VolumeFile open_file_step(const std::vector<FileStep>& steps, const std::filesystem::path& path,
                          const ReadOptions& options);
/// Lists the arrays of that volume. Throws Error.
std::vector<VolumeArray> list_file_step(const std::vector<FileStep>& steps,
                                        const std::filesystem::path& path,
                                        const ReadOptions& options);

}  // namespace pellucid

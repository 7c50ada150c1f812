// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/device/speed.h"
#include "pellucid/cpu/render.h"

/// What scripts/device-check asks of a card, each part in a process of its own. A part appends a
/// line of JSON to a file for each thing that it found, so that what is there stays if it is cut
/// off. It returns whether all of it was good; it throws if it could not do its work.
namespace pellucid::device_check {

struct Arguments {
  Device device = Device::cuda;
  int threads = 0;
  std::filesystem::path rows;     ///< file of results
  std::filesystem::path truths;   ///< folder of reference frames and pixels
  std::filesystem::path against;  ///< results of the first run
  int size = 32, points = 64;     ///< pixels along an edge; values along an edge of the data
  int cameras = 3;
  int every = 1;          ///< takes every n-th scene
  bool examples = false;  ///< only the small scenes
  std::vector<std::string> scenes;
  bench::SpeedOptions speed;
};

/// Writes the names of the device and of the CPU. Throws Error, in one line, if there is no device.
bool name_device(const Arguments& arguments);

/// Makes the reference's frames of the matrix, for check_matrix() on another machine.
bool make_truths(const Arguments& arguments);

/// Holds the scenes of the tolerance matrix against the reference: all of them from their first
/// camera, then from the second, and so on.
bool check_matrix(const Arguments& arguments);

/// Renders a frame of each function of a card twice, and compares all bits; with `against` also
/// those of another process.
bool check_frames(const Arguments& arguments);

/// Measures frames per second. Not good is only an error above the tolerance.
bool check_speed(const Arguments& arguments);

/// Makes the table of all parts from `folder`, where each has a line in the file `parts` (name,
/// state, seconds, limit, description and remark, with tabs between them) and its results in
/// NAME.rows: writes `json` and `markdown`, new each time.
void write_tables(const std::filesystem::path& folder, const std::filesystem::path& json,
                  const std::filesystem::path& markdown, const std::string& commit);

}  // namespace pellucid::device_check

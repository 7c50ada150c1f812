// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"

namespace pellucid {

/// Returns "5 times (0, 3, 6, 9, 12) in s; --time chooses one", with the first and the last of
/// many, and the unit where there is one.
std::string times_note(const std::vector<double>& times, const std::string& unit = {});

/// Returns "step 2 of 5 is read, time 3 (nearest to 4)", without the bracket where the time
/// is met exactly; with a unit, "time 3 s". `step` counts from 0.
std::string step_note(const std::vector<double>& times, std::size_t step, double wanted,
                      const std::string& unit = {});

/// Returns the times of steps that follow each other at one distance.
std::vector<double> even_times(std::size_t count, double first, double step);

/// Returns times as they go on, each once, without those that are missing (NaN).
std::vector<double> ascending_times(std::vector<double> times);

/// A time between two steps, which are next to each other.
struct MomentBetween {
  double before = 0, after = 0;
  double share = 0;  ///< part of the way from `before`, above 0 and below 1
};
/// Returns the steps around a time; nothing where it is that of a step, or beyond the first or the
/// last. `times` are in any order.
std::optional<MomentBetween> moment_between(const std::vector<double>& times, double time);
/// Returns "time 2.5 lies between the steps 2 and 3; values are linear between them".
std::string moment_note(const MomentBetween& moment, double time);

/// Throws Error that begins with `name` if there are two or more times of one plane each, which is
/// no volume, unless `options.centering` is `cell`.
void refuse_movie(std::size_t times, std::int64_t planes, const ReadOptions& options,
                  const std::string& name);

}  // namespace pellucid

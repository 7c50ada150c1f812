// SPDX-License-Identifier: Apache-2.0
#include "time_steps.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

/// Writes a time in as many digits as it needs.
std::string written(double time) {
  std::array<char, 40> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), time).ptr};
}

}  // namespace

std::string times_note(const std::vector<double>& times, const std::string& unit) {
  constexpr std::size_t most = 12;
  std::string list;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times.size() > most && i == most - 2) {
      list += ", ...";
      i = times.size() - 1;
    }
    list += (i == 0 ? "" : ", ") + written(times[i]);
  }
  return std::to_string(times.size()) + " times (" + list + ")" +
         (unit.empty() ? "" : " in " + unit) + "; --time chooses one";
}

std::string step_note(const std::vector<double>& times, std::size_t step, double wanted,
                      const std::string& unit) {
  return "step " + std::to_string(step + 1) + " of " + std::to_string(times.size()) +
         " is read, time " + written(times[step]) + (unit.empty() ? "" : " " + unit) +
         (times[step] == wanted ? "" : " (nearest to " + written(wanted) + ")");
}

std::vector<double> ascending_times(std::vector<double> times) {
  std::erase_if(times, [](double time) { return std::isnan(time); });
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::optional<MomentBetween> moment_between(const std::vector<double>& times, double time) {
  std::optional<double> before, after;
  for (const double step : times) {
    if (step == time) return std::nullopt;
    if (step < time && (!before || step > *before)) before = step;
    if (step > time && (!after || step < *after)) after = step;
  }
  if (!before || !after) return std::nullopt;
  return MomentBetween{*before, *after, (time - *before) / (*after - *before)};
}

std::string moment_note(const MomentBetween& moment, double time) {
  return "time " + written(time) + " lies between the steps " + written(moment.before) + " and " +
         written(moment.after) + "; values are linear between them";
}

void refuse_movie(std::size_t times, std::int64_t planes, const ReadOptions& options,
                  const std::string& name) {
  if (times < 2 || planes > 1 || options.centering == Centering::cell) return;
  throw Error(name + ": is a movie, " + std::to_string(times) +
              " times of a single plane, and a volume needs two planes; read one time with cell "
              "centering, or save the times as slices if they are some");
}

std::vector<double> even_times(std::size_t count, double first, double step) {
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i) times[i] = first + step * static_cast<double>(i);
  return times;
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/scaling/study.h"

#include <algorithm>
#include <new>

#include "benchmarks/scaling/way.h"
#include "benchmarks/support/document.h"
#include "benchmarks/support/interleave.h"
#include "pellucid/scene/error.h"
#include "tests/scenes/peers.h"

namespace pellucid::bench {
namespace {

using scenes::NamedScene;
using scenes::TransferPointer;

std::string milliseconds(double seconds) {
  return format(seconds < 0.01 ? "%.2f ms" : "%.1f ms", 1e3 * seconds);
}

Scene oblique(const scenes::VolumePointer& volume, const TransferPointer& transfer, int size) {
  return scenes::make_scene(volume, transfer, scenes::view_camera(scenes::View::oblique),
                            {size, size});
}

/// Haze, band and spike in the field of Marschner and Lobb.
std::vector<NamedScene> three_scenes(const StudyOptions& options) {
  const auto volume = scenes::builtin("marschner_lobb", options.points);
  return {{"haze", oblique(volume, scenes::haze_transfer(), options.size)},
          {"band", oblique(volume, scenes::band_transfer(), options.size)},
          {"spike", oblique(volume, scenes::spike_transfer(), options.size)}};
}

/// Columns of a comparison with the first: "41.0 ms | 1.97×, 20.8 ms |".
std::string speedups(const std::vector<double>& seconds) {
  std::string text = " " + milliseconds(seconds.front()) + " |";
  for (std::size_t i = 1; i < seconds.size(); ++i) {
    text += format(" %.2f×, ", seconds.front() / seconds[i]) + milliseconds(seconds[i]) + " |";
  }
  return text;
}

std::string table_head(const std::vector<std::string>& columns) {
  std::string text = "|", line = "|";
  for (const std::string& column : columns) {
    text += " " + column + " |";
    line += "---|";
  }
  return text + "\n" + line + "\n";
}

/// Extinction in the ball r < radius of the field 1 - r, from its surface to a depth of 4 through
/// the middle, whatever the radius.
TransferPointer ball_transfer(double radius) {
  const double surface = 1 - radius;
  return scenes::transfer({{surface, 0, {0.2, 0.5, 1}}, {1, 4 / radius, {1, 0.6, 0.2}}});
}

}  // namespace

Study study_threads(const StudyOptions& options) {
  std::vector<int> counts{1};
  while (counts.back() < options.threads) {
    counts.push_back(std::min(2 * counts.back(), options.threads));
  }
  std::vector<std::string> columns{"scene", "method"};
  for (const int count : counts)
    columns.push_back(format("%d thread%s", count, count == 1 ? "" : "s"));
  Study study{"threads", table_head(columns), nlohmann::ordered_json::array()};
  for (const NamedScene& named : three_scenes(options)) {
    options.say("threads: " + named.name);
    for (const Way& way : compared_ways()) {
      std::vector<std::function<double()>> runs;
      for (const int count : counts) {
        runs.push_back(
            [&, count] { return seconds_of_frame(named.scene, way.integration, count); });
      }
      const std::vector<double> seconds = interleaved_medians(runs, options.rounds);
      study.markdown += "| " + named.name + " | " + way.name + " |" + speedups(seconds) + "\n";
      study.figures.push_back(
          {{"scene", named.name}, {"method", way.name}, {"threads", counts}, {"seconds", seconds}});
    }
  }
  return study;
}

Study study_instruction_sets(const StudyOptions& options) {
  if (!instruction_set_is_a_choice()) {
    return {"instruction sets", "This version has no choice of instruction set.\n", {}};
  }
  std::vector<InstructionSet> sets;
  std::vector<std::string> columns{"scene", "method"}, names;
  for (const InstructionSet set : instruction_sets) {
    if (!is_supported(set)) continue;
    sets.push_back(set);
    names.emplace_back(name_of(set));
    columns.push_back(names.back());
  }
  Study study{"instruction sets", table_head(columns), nlohmann::ordered_json::array()};
  for (const NamedScene& named : three_scenes(options)) {
    options.say("instruction sets: " + named.name);
    for (const Way& way : compared_ways()) {
      std::vector<std::function<double()>> runs;
      for (const InstructionSet set : sets) {
        runs.push_back(
            [&, set] { return seconds_of_frame(named.scene, way.integration, 1, nullptr, set); });
      }
      const std::vector<double> seconds = interleaved_medians(runs, options.rounds);
      study.markdown += "| " + named.name + " | " + way.name + " |" + speedups(seconds) + "\n";
      study.figures.push_back({{"scene", named.name},
                               {"method", way.name},
                               {"instruction_sets", names},
                               {"seconds", seconds}});
    }
  }
  return study;
}

Study study_size(const StudyOptions& options) {
  Study study{"size",
              table_head({"scene", "data", "cells crossed", "cells visited", "exact to 1/512",
                          "per cell crossed", "against half the size: cells", "time"}),
              nlohmann::ordered_json::array()};
  const std::pair<const char*, TransferPointer> transfers[] = {{"haze", scenes::haze_transfer()},
                                                               {"spike", scenes::spike_transfer()}};
  const Integration exact = compared_ways().front().integration;
  // The rows of one scene stand together, and each volume is made once.
  std::string rows[std::size(transfers)];
  double cells_before[std::size(transfers)] = {}, seconds_before[std::size(transfers)] = {};
  for (int points = options.largest_points / 8; points <= options.largest_points; points *= 2) {
    options.say(format("size: %d", points));
    scenes::VolumePointer volume;
    try {
      volume = scenes::builtin("marschner_lobb", points);
    } catch (const Error& error) {
      options.say(error.what());
      break;
    }
    for (std::size_t i = 0; i < std::size(transfers); ++i) {
      const auto& [name, transfer] = transfers[i];
      const Scene scene = oblique(volume, transfer, options.size);
      RenderReport report;
      const double seconds =
          interleaved_medians(
              {[&] { return seconds_of_frame(scene, exact, options.threads, &report); }},
              options.rounds)
              .front();
      const auto cells = static_cast<double>(cells_crossed(scene));
      rows[i] += std::string("| ") + name +
                 format(" | %d³ | %.1f M | %.1f M | ", points, 1e-6 * cells,
                        1e-6 * static_cast<double>(report.cells)) +
                 milliseconds(seconds) + format(" | %.2f ns | ", 1e9 * seconds / cells);
      rows[i] += cells_before[i] > 0 ? format("%.2f× | %.2f× |\n", cells / cells_before[i],
                                              seconds / seconds_before[i])
                                     : "— | — |\n";
      cells_before[i] = cells;
      seconds_before[i] = seconds;
      study.figures.push_back({{"scene", name},
                               {"points", points},
                               {"threads", options.threads},
                               {"cells_crossed", cells},
                               {"cells_visited", report.cells},
                               {"seconds", seconds}});
    }
  }
  for (const std::string& text : rows) study.markdown += text;
  return study;
}

Study study_empty_space(const StudyOptions& options) {
  Study study{"empty space",
              table_head({"ball's share of the side", "pixels that see it", "cells crossed",
                          "cells visited", "exact to 1/512", "against the box full of it"}),
              nlohmann::ordered_json::array()};
  const auto volume = scenes::builtin("sphere", options.points);
  const Integration exact = compared_ways().front().integration;
  const std::vector<double> shares{1, 1.0 / 2, 1.0 / 4, 1.0 / 8, 1.0 / 16};
  std::vector<Scene> list;
  std::vector<RenderReport> reports(shares.size());
  std::vector<std::function<double()>> runs;
  for (const double share : shares) {
    list.push_back(oblique(volume, ball_transfer(share), options.size));
  }
  for (std::size_t i = 0; i < shares.size(); ++i) {
    runs.push_back(
        [&, i] { return seconds_of_frame(list[i], exact, options.threads, &reports[i]); });
  }
  options.say("empty space");
  const std::vector<double> seconds = interleaved_medians(runs, options.rounds);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double radius = shares[i];
    const double seen = 3.14159265358979 / 4 * radius * radius;
    study.markdown += format("| 1/%.0f | %.2g %% | %.1f M | %.2f M | ", 1 / radius, 100 * seen,
                             1e-6 * static_cast<double>(cells_crossed(list[i])),
                             1e-6 * static_cast<double>(reports[i].cells)) +
                      milliseconds(seconds[i]) +
                      format(" | %.3f× |\n", seconds[i] / seconds.front());
    study.figures.push_back({{"share_of_side", radius},
                             {"threads", options.threads},
                             {"cells_visited", reports[i].cells},
                             {"seconds", seconds[i]}});
  }
  return study;
}

}  // namespace pellucid::bench

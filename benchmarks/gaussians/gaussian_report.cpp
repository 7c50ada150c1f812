// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/gaussians/gaussian_report.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/frames/pellucid_contenders.h"
#include "benchmarks/support/document.h"

namespace pellucid::bench {
namespace {

Reach exact_reach(const SceneResult& result, double error) {
  const Curve* exact = result.find(exact_name);
  return exact == nullptr ? Reach{} : reach(*exact, error, ErrorKind::largest);
}

std::string time_cell(const Reach& reach) {
  const double ms = 1e3 * reach.seconds;
  return (reach.reached ? "" : "> ") + format(ms < 10 ? "%.1f ms" : "%.0f ms", ms);
}

/// Where the ratio is 1 between two widths, straight in logarithms.
double equal_at(double wide, double ratio_wide, double narrow, double ratio_narrow) {
  const double share = std::log(ratio_wide) / (std::log(ratio_wide) - std::log(ratio_narrow));
  return std::exp(std::lerp(std::log(wide), std::log(narrow), share));
}

}  // namespace

TimeRatio sampler_over_exact(const SceneResult& result, double error) {
  const Reach exact = exact_reach(result, error);
  const BestSampler sampler = best_sampler(result, error);
  if (!exact.reached || sampler.curve == nullptr) return {};
  return {true, !sampler.reach.reached, sampler.reach.seconds / exact.seconds};
}

std::string crossings(const Series& widths) {
  std::string text;
  for (const double error : compared_errors) {
    const std::string to = "- To " + error_name(error) + ": ";
    const SeriesPoint* before = nullptr;
    bool found = false;
    for (const SeriesPoint& point : widths.points) {
      const TimeRatio here = sampler_over_exact(point.result, error);
      if (!here.known) continue;
      // A sampler that gave up in less time than exact takes may be slower or not.
      if (here.at_least && here.value < 1) continue;
      if (here.value >= 1) {
        found = true;
        if (before == nullptr) {
          text += to + format("exact is the faster one from a width of %g on.\n", point.at);
        } else if (here.at_least) {
          text += to + format("sampling is the faster one at a width of %g, exact at %g.\n",
                              before->at, point.at);
        } else {
          const TimeRatio there = sampler_over_exact(before->result, error);
          text += to + format("both take as long at a width of about %.2g.\n",
                              equal_at(before->at, there.value, point.at, here.value));
        }
        break;
      }
      before = &point;
    }
    if (found) continue;
    text += to + (before == nullptr
                      ? std::string("not known.\n")
                      : format("sampling is the faster one at least down to a width of %g.\n",
                               before->at));
  }
  return text;
}

Plot ratio_plot(const Series& widths) {
  Plot plot;
  plot.title = "Three Gaussians in the field of Marschner and Lobb";
  plot.x_label = "width, of the data's range";
  plot.y_label = "time of the best sampler / exact";
  plot.marks.push_back({1, "equal"});
  for (const double error : compared_errors) {
    PlotLine line;
    line.name = "to " + error_name(error);
    line.thick = error == default_tolerance;
    for (const SeriesPoint& point : widths.points) {
      const TimeRatio ratio = sampler_over_exact(point.result, error);
      if (ratio.known) {
        line.points.push_back({point.at, ratio.value, ratio.at_least ? "or more" : ""});
      }
    }
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

std::string counts_table(const std::string& number, const std::vector<Series>& list, double error) {
  std::string text = "| " + number + " |", rule = "|---|";
  for (const Series& series : list) {
    text += " " + series.name + (series.name.empty() ? "" : ": ") + "exact | best sampler |";
    rule += "---|---|";
  }
  text += "\n" + rule + "\n";
  for (std::size_t i = 0; i < list.front().points.size(); ++i) {
    text += format("| %g |", list.front().points[i].at);
    for (const Series& series : list) {
      const SceneResult& result = series.points[i].result;
      const BestSampler sampler = best_sampler(result, error);
      text += " " + time_cell(exact_reach(result, error)) + " | ";
      text += sampler.curve == nullptr ? "—" : time_cell(sampler.reach);
      text += " |";
    }
    text += "\n";
  }
  return text;
}

Plot counts_plot(const std::string& number, const std::vector<Series>& list, double error) {
  Plot plot;
  plot.title = "Time of a frame to " + error_name(error) + " over the number of " + number;
  plot.x_label = "number of " + number;
  plot.y_label = "time of a frame in ms";
  for (const Series& series : list) {
    const std::string suffix = series.name.empty() ? "" : ", " + series.name;
    PlotLine exact{"exact" + suffix, {}, true, false},
        sampler{"best sampler" + suffix, {}, false, true};
    for (const SeriesPoint& point : series.points) {
      exact.points.push_back({point.at, 1e3 * exact_reach(point.result, error).seconds, ""});
      const BestSampler best = best_sampler(point.result, error);
      if (best.curve != nullptr && best.reach.reached) {
        sampler.points.push_back({point.at, 1e3 * best.reach.seconds, ""});
      }
    }
    plot.lines.push_back(std::move(exact));
    plot.lines.push_back(std::move(sampler));
  }
  return plot;
}

}  // namespace pellucid::bench

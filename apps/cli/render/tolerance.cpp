// SPDX-License-Identifier: Apache-2.0
#include "tolerance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid::cli {

namespace {

/// Returns the number upwards to two digits, so that as a tolerance it is not below the number.
double rounded_up(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1);
  return std::ceil(x / unit) * unit;
}

std::string advice(const RenderReport& report, const Integration& integration) {
  if (integration.precision == Precision::float32) {
    return "--precision automatic uses double where float is too coarse";
  }
  if (!(report.largest_error < largest_tolerance)) return "--error-map FILE.png shows where";
  return fmt::format("ask for --tolerance {:.2g}, or --error-map FILE.png to see where",
                     rounded_up(report.largest_error));
}

}  // namespace

std::optional<std::string> over_tolerance(const RenderReport& report,
                                          const Integration& integration) {
  if (report.pixels_over_tolerance == 0) return std::nullopt;
  const std::string by = std::isfinite(report.largest_error)
                             ? fmt::format("by up to {:.3g}", report.largest_error)
                             : "by an unknown amount";
  return fmt::format("{} of {} pixels may be off by more than the tolerance {}, {}; {}",
                     report.pixels_over_tolerance, report.pixels, integration.tolerance, by,
                     advice(report, integration));
}

std::string share_text(std::uint64_t part, std::uint64_t whole) {
  if (part == whole) return "all";
  if (part == 0) return "none";
  const double percent = 100 * static_cast<double>(part) / static_cast<double>(whole);
  return fmt::format("{:.1f} %", std::clamp(percent, 0.1, 99.9));
}

}  // namespace pellucid::cli

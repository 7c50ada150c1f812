// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/internal/binned_transfer_storage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double far = static_cast<double>(BinnedTransfer::far);
constexpr double unit = 0x1p-24;
/// Corners that move a value by less than this share of it are rounding.
constexpr double flat = 0x1p-46;

float above(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

/// Returns the indices of the points that are left of a curve through (value, curves[c]) when those
/// go that lie on the line between their neighbours that stay; both points of a jump stay.
std::vector<int> breakpoints(const PiecewiseLinear<double>& table, const auto& curves_at) {
  std::vector<int> kept{0};
  constexpr std::size_t channels = std::tuple_size_v<decltype(curves_at(0))>;
  std::array<double, channels> least{}, most{};
  const auto start = [&] {
    least.fill(-infinity);
    most.fill(infinity);
  };
  start();
  for (int i = 1; i < table.count; ++i) {
    const int anchor = kept.back();
    const double width = table.value[i] - table.value[anchor];
    bool straight = width > 0 && table.value[i] > table.value[i - 1];
    const auto from = curves_at(anchor), here = curves_at(i);
    for (std::size_t c = 0; straight && c < channels; ++c) {
      const double slope = (here[c] - from[c]) / width;
      straight = slope >= least[c] && slope <= most[c];
    }
    if (!straight && i - 1 != anchor) {
      kept.push_back(i - 1);
      start();
      --i;
      continue;
    }
    if (!straight) {  // a jump, or its other side
      kept.push_back(i);
      start();
      continue;
    }
    for (std::size_t c = 0; c < channels; ++c) {
      const double slack = flat * std::fabs(here[c]);
      least[c] = std::max(least[c], (here[c] - slack - from[c]) / width);
      most[c] = std::min(most[c], (here[c] + slack - from[c]) / width);
    }
  }
  if (kept.back() != table.count - 1) kept.push_back(table.count - 1);
  return kept;
}

std::array<double, 3> components(const Rgb<double>& c) {
  return {c.r, c.g, c.b};
}

/// Records field by field, if there are few of them; the upper ends of those that are not there are
/// infinite.
template <std::size_t Fields, std::size_t Few>
bool by_fields(const std::vector<float>& records, float (&fields)[Fields][Few]) {
  const float beyond = std::numeric_limits<float>::infinity();
  const std::size_t count = records.size() / Fields;
  if (count > Few) return false;
  for (std::size_t i = 0; i < Few; ++i) {
    for (std::size_t k = 0; k < Fields; ++k) {
      fields[k][i] = i < count ? records[i * Fields + k] : k == 1 ? beyond : 0.0f;
    }
  }
  return true;
}

/// Returns whether anything absorbs in the table's own interval between points i - 1 and i.
bool absorbs(const PiecewiseLinear<double>& table, int i) {
  return table.material[i - 1].extinction > 0 || table.material[i].extinction > 0;
}

}  // namespace

BinnedTransferStorage::BinnedTransferStorage(const PiecewiseLinear<double>& table,
                                             double largest_value) {
  const int last = table.count - 1;
  double largest_extinction = 0, largest_color = 0;
  for (int i = 0; i <= last; ++i) {
    const Material<double>& m = table.material[i];
    largest_extinction = std::max(largest_extinction, m.extinction);
    largest_color = std::max({largest_color, m.color.r, m.color.g, m.color.b});
  }
  const std::vector<int> at_extinction = breakpoints(
      table, [&](int i) { return std::array<double, 1>{table.material[i].extinction}; });
  const std::vector<int> at_color =
      breakpoints(table, [&](int i) { return components(table.material[i].color); });

  // Intervals of the extinction.
  const auto slope_of = [&](std::size_t i) {  // between breakpoints i - 1 and i
    if (i == 0 || i == at_extinction.size()) return 0.0;
    const int a = at_extinction[i - 1], b = at_extinction[i];
    const double width = table.value[b] - table.value[a];
    return width > 0 ? (table.material[b].extinction - table.material[a].extinction) / width : 0.0;
  };
  const double size =
      std::max({std::fabs(table.value[0]), std::fabs(table.value[last]), largest_value});
  // What is narrower is marked as a jump where it absorbs, below.
  const double widest_jump = 256 * unit * size;
  // The largest of something over an interval and those that rounding may take data to: up to the
  // next one on either side that is no jump.
  const auto with_neighbours = [&](const auto& own) {
    const auto is_jump = [&](std::size_t i) {
      return i > 0 && i < at_extinction.size() &&
             !(table.value[at_extinction[i]] - table.value[at_extinction[i - 1]] > widest_jump);
    };
    auto largest = own;
    auto near = own[0];
    for (std::size_t i = 1; i < own.size(); ++i) {
      near = is_jump(i - 1) ? std::max(near, own[i - 1]) : own[i - 1];
      largest[i] = std::max(largest[i], near);
    }
    near = own.back();
    for (std::size_t i = own.size() - 1; i > 0; --i) {
      near = is_jump(i) ? std::max(near, own[i]) : own[i];
      largest[i - 1] = std::max(largest[i - 1], near);
    }
    return largest;
  };
  std::vector<double> own_slopes;
  for (std::size_t i = 0; i <= at_extinction.size(); ++i) {
    own_slopes.push_back(std::fabs(slope_of(i)));
  }
  const std::vector<double> steepest = with_neighbours(own_slopes);
  for (std::size_t i = 0; i <= at_extinction.size(); ++i) {
    const bool below = i == 0, beyond = i == at_extinction.size();
    const int a = below ? 0 : at_extinction[i - 1], b = beyond ? last : at_extinction[i];
    const double at_lower = table.material[a].extinction, at_upper = table.material[b].extinction;
    std::array<double, 3> least{infinity, infinity, infinity},
        most{-infinity, -infinity, -infinity};
    double color_slope = 0;
    if (!below && !beyond) {
      for (int k = a + 1; k <= b; ++k) {
        if (!absorbs(table, k)) continue;
        const double width = table.value[k] - table.value[k - 1];
        const std::array<double, 3> c0 = components(table.material[k - 1].color),
                                    c1 = components(table.material[k].color);
        for (std::size_t c = 0; c < 3; ++c) {
          least[c] = std::min({least[c], c0[c], c1[c]});
          most[c] = std::max({most[c], c0[c], c1[c]});
          if (width > 0) color_slope = std::max(color_slope, std::fabs(c1[c] - c0[c]) / width);
        }
      }
    }
    double range = 0;
    for (std::size_t c = 0; c < 3; ++c) range = std::max(range, most[c] - least[c]);
    for (const double field :
         {below ? -far : table.value[a], beyond ? far : table.value[b], at_lower, slope_of(i)}) {
      extinction_.push_back(static_cast<float>(field));
      wide_extinction_.push_back(field);
    }
    for (const double field : {std::max(at_lower, at_upper), steepest[i], range, color_slope}) {
      extinction_.push_back(field > 0 ? above(field) : 0.0f);
    }
  }

  // A jump of the color alone counts with the extinction that shows it.
  jump_.assign(at_extinction.size() + 1, 0.0f);
  for (std::size_t i = 1; i < at_extinction.size(); ++i) {
    const int a = at_extinction[i - 1], b = at_extinction[i];
    if (table.value[b] > table.value[a]) continue;
    const double shown = std::max(table.material[a].extinction, table.material[b].extinction);
    if (!(shown > 0)) continue;
    for (const std::size_t k : {i - 1, i, i + 1}) jump_[k] = std::max(jump_[k], above(shown));
  }

  // Beside a breakpoint rounding may take a color from there, too.
  const auto color_slope_of = [&](std::size_t i) -> float& {
    return extinction_[(i + 1) * BinnedTransfer::extinction_fields - 1];
  };
  std::vector<float> own_color_slopes;
  for (std::size_t i = 0; i <= at_extinction.size(); ++i) {
    own_color_slopes.push_back(color_slope_of(i));
  }
  const std::vector<float> color_slopes = with_neighbours(own_color_slopes);
  for (std::size_t i = 0; i < color_slopes.size(); ++i) color_slope_of(i) = color_slopes[i];

  // Intervals of the color.
  for (std::size_t i = 0; i <= at_color.size(); ++i) {
    const bool below = i == 0, beyond = i == at_color.size();
    const int a = below ? 0 : at_color[i - 1], b = beyond ? last : at_color[i];
    const double width = below || beyond ? 0 : table.value[b] - table.value[a];
    const std::array<double, 3> from = components(table.material[a].color),
                                to = components(table.material[b].color);
    const double lower = below ? -far : table.value[a];
    wide_color_end_.push_back(lower);
    color_.push_back(static_cast<float>(lower));
    color_.push_back(beyond ? std::numeric_limits<float>::infinity()
                            : static_cast<float>(table.value[b]));
    for (const double c : from) color_.push_back(static_cast<float>(c));
    for (std::size_t c = 0; c < 3; ++c) {
      // Times no offset an infinite one would be NaN.
      const double slope = width > 0 ? std::clamp((to[c] - from[c]) / width, -far, far) : 0;
      color_.push_back(static_cast<float>(slope));
    }
  }

  wide_color_end_.push_back(infinity);

  // Bins.
  const double first_value = table.value[0], span = table.value[last] - first_value;
  double narrowest = infinity;
  for (std::size_t i = 1; i < at_extinction.size(); ++i) {
    const double its_width = table.value[at_extinction[i]] - table.value[at_extinction[i - 1]];
    if (its_width > widest_jump) narrowest = std::min(narrowest, its_width);
  }
  view_.narrowest = static_cast<float>(narrowest);
  const int inside = span > 0 ? std::clamp(4 * table.count, 254, 4094) : 0;
  view_.bins = span > 0 ? inside + 2 : 1;
  view_.origin = static_cast<float>(first_value);
  view_.bins_per_value = span > 0 ? static_cast<float>(inside / span) : 0.0f;
  const double width = span > 0 ? span / inside : 0, margin = width / 16 + 16 * unit * size;
  const auto lower_edge = [&](int bin) {
    return bin == 0 ? -infinity : first_value + (bin - 1) * width - margin;
  };
  const auto upper_edge = [&](int bin) {
    return bin == view_.bins - 1 ? infinity : first_value + bin * width + margin;
  };
  const auto bins_of = [&](double from, double to, auto&& visit) {
    const int reach =
        static_cast<int>(std::ceil(width > 0 ? std::min(margin / width, 4096.0) : 0)) + 1;
    const auto near = [&](double value) {
      const double place = span > 0 ? (value - first_value) / width : 0;
      return static_cast<int>(std::clamp(place, -1.0, static_cast<double>(view_.bins))) + 1;
    };
    for (int bin = std::max(near(from) - reach, 0);
         bin <= std::min(near(to) + reach, view_.bins - 1); ++bin) {
      if (to >= lower_edge(bin) && from <= upper_edge(bin)) visit(static_cast<std::size_t>(bin));
    }
  };
  const auto bins = static_cast<std::size_t>(view_.bins);
  std::vector<int> mark(bins, 0), hard(bins, 0);
  std::vector<double> bend(bins, 0.0);
  const auto interval_in = [&](const std::vector<float>& records, std::size_t fields, double value,
                               std::int32_t from) {
    // The last interval whose lower end is not above the value, by the floats that are compared
    // with.
    const auto count = static_cast<std::int32_t>(records.size() / fields);
    while (from + 1 < count &&
           static_cast<double>(records[static_cast<std::size_t>(from) * fields + 1]) <= value) {
      ++from;
    }
    return from;
  };
  std::int32_t extinction_interval = 0, color_interval = 0;
  for (int bin = 0; bin < view_.bins; ++bin) {
    const auto b = static_cast<std::size_t>(bin);
    const double lower = lower_edge(bin), upper = upper_edge(bin);
    if (table.has_extinction(table.interval(lower), table.interval(upper))) mark[b] = 1;
    extinction_interval =
        interval_in(extinction_, BinnedTransfer::extinction_fields, lower, extinction_interval);
    color_interval = interval_in(color_, BinnedTransfer::color_fields, lower, color_interval);
    first_extinction_.push_back(extinction_interval);
    first_color_.push_back(color_interval);
    const auto upper_of = [&](std::int32_t interval) {
      return color_[static_cast<std::size_t>(interval) * BinnedTransfer::color_fields + 1];
    };
    color_split_.push_back(upper_of(color_interval));
    // The last interval ends at no breakpoint.
    const bool has_next = static_cast<std::size_t>(color_interval) + 1 < at_color.size();
    if (has_next && static_cast<double>(upper_of(color_interval + 1)) <= upper) {
      view_.has_full_bins = true;
    }
  }
  const auto mark_jump = [&](double from, double to, bool is_hard) {
    bins_of(from, to, [&](std::size_t b) {
      mark[b] |= BinnedTransfer::one_jump;
      if (is_hard) hard[b] = 1;
    });
  };
  const auto color_slope = [&](int i, std::size_t c) {  // between points i - 1 and i
    if (i == 0 || i > last) return 0.0;
    const double distance = table.value[i] - table.value[i - 1];
    return distance > 0 ? (components(table.material[i].color)[c] -
                           components(table.material[i - 1].color)[c]) /
                              distance
                        : 0.0;
  };
  for (int i = 0; i <= last; ++i) {
    const bool in_front = i > 0 && absorbs(table, i), behind = i < last && absorbs(table, i + 1);
    const double distance = i > 0 ? table.value[i] - table.value[i - 1] : infinity;
    // Beyond what data in binary64 are off by (40 u of it, six times over) nothing need be known of
    // a jump. What is narrower hides one behind it, whether it absorbs or not.
    const double here = table.value[i], near = 16 * unit * size;
    const bool is_hard =
        distance > 0 && !(distance > 0x1p-44 * size) &&
        table.has_extinction(table.interval(here - near), table.interval(here + near));
    if (is_hard || (in_front && !(distance > widest_jump) &&
                    !(table.material[i].extinction == table.material[i - 1].extinction &&
                      table.material[i].color == table.material[i - 1].color))) {
      mark_jump(table.value[i - 1], table.value[i], is_hard);
    }
    // No piece goes across a breakpoint of the extinction.
    const bool is_cut = std::binary_search(at_extinction.begin(), at_extinction.end(), i);
    if (!in_front || !behind || is_cut) continue;
    double change = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      change = std::max(change, std::fabs(color_slope(i + 1, c) - color_slope(i, c)));
    }
    bins_of(table.value[i], table.value[i], [&](std::size_t b) { bend[b] += change; });
  }

  std::int32_t marks = 0, unresolved_jumps = 0;
  double bends = 0;
  for (std::size_t b = 0; b < bins; ++b) {
    marks_.push_back(marks);
    hard_jumps_.push_back(unresolved_jumps);
    unresolved_jumps += hard[b];
    color_slope_change_.push_back(static_cast<float>(bends));
    marks += mark[b];
    bends += bend[b];
  }
  marks_.push_back(marks);
  hard_jumps_.push_back(unresolved_jumps);
  color_slope_change_.push_back(static_cast<float>(bends));
  // Of either sum, of their difference, and what colors of less than `flat` leave out.
  view_.color_slope_change_rounding = above(4 * unit * bends);
  view_.has_color_breakpoints = bends > 0;

  // Bins that absorb are one run, and none of them holds a jump.
  int runs = 0;
  bool jumps = false;
  for (std::size_t b = 0; b < bins; ++b) {
    jumps = jumps || mark[b] >= BinnedTransfer::one_jump;
    if (mark[b] != 0 && (b == 0 || mark[b - 1] == 0)) ++runs;
  }
  view_.has_marks = jumps || runs > 1;

  struct Range {
    double lower, upper;
  };
  std::vector<Range> supports;
  if (table.material[0].extinction > 0) supports.push_back({-infinity, first_value});
  for (int i = 1; i <= last; ++i) {
    if (!absorbs(table, i)) continue;
    if (supports.empty() || supports.back().upper < table.value[i - 1]) {
      supports.push_back({table.value[i - 1], table.value[i]});
    }
    supports.back().upper = table.value[i];
  }
  if (table.material[last].extinction > 0) {
    if (supports.empty()) supports.push_back({table.value[last], infinity});
    supports.back().upper = infinity;
  }
  const auto as_float = [&](double x) { return static_cast<float>(std::clamp(x, -far, far)); };
  const bool none = supports.empty();
  view_.support_min =
      none ? BinnedTransfer::far : as_float(supports.front().lower - 16 * unit * size);
  view_.support_max =
      none ? -BinnedTransfer::far : as_float(supports.back().upper + 16 * unit * size);
  constexpr std::size_t max_supports = BinnedTransfer::max_supports;
  if (!jumps && supports.size() > 1 && supports.size() <= max_supports) {
    view_.supports = static_cast<int>(supports.size());
    for (std::size_t i = 0; i < supports.size(); ++i) {
      view_.support[2 * i] = as_float(supports[i].lower - 16 * unit * size);
      view_.support[2 * i + 1] = as_float(supports[i].upper + 16 * unit * size);
    }
  }
  view_.largest_extinction = above(largest_extinction);
  view_.largest_color = above(largest_color);
  view_.few_extinctions = by_fields(extinction_, view_.few_extinction);
  view_.few_colors = by_fields(color_, view_.few_color);
  view_.extinction = extinction_.data();
  view_.jump = jump_.data();
  view_.wide_extinction = wide_extinction_.data();
  view_.color = color_.data();
  view_.wide_color_end = wide_color_end_.data();
  view_.first_extinction = first_extinction_.data();
  view_.first_color = first_color_.data();
  view_.color_split = color_split_.data();
  view_.marks = marks_.data();
  view_.unresolved_jumps = hard_jumps_.data();
  view_.color_slope_change = color_slope_change_.data();
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include "dicom_volumes.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "dicom_marks.h"
#include "pellucid/geometry/vec3.h"

namespace pellucid {

namespace {

using Indices = std::vector<std::size_t>;

/// Fewer slices than this do not show that they are a stack of their own.
constexpr std::size_t least_of_a_stack = 3;

/// The slices of a series, and where they stand along their normal.
class Series {
 public:
  explicit Series(const std::vector<DicomSlice>& slices) : slices_(slices) {
    const DicomSlice& any = slices.front();
    const auto [row, column] =
        any.orientation.value_or(std::array{Vec3<double>{1, 0, 0}, Vec3<double>{0, 1, 0}});
    const Vec3<double> normal = normalized(cross(row, column));
    for (const DicomSlice& slice : slices) heights_.push_back(dot(*slice.position, normal));
    const auto [x, y] = any.spacing.value_or(std::array{1.0, 1.0});
    same_place_ = 1e-3 * std::min(x, y);
  }

  const DicomSlice& slice(std::size_t i) const { return slices_[i]; }
  double height(std::size_t i) const { return heights_[i]; }

  Indices by_height(Indices part) const {
    std::ranges::stable_sort(part, {}, [&](std::size_t i) { return heights_[i]; });
    return part;
  }
  bool is_same_place(std::size_t i, std::size_t k) const {
    return std::abs(heights_[i] - heights_[k]) <= same_place_;
  }

  /// Returns the number of slices that stand where the one before them stands.
  std::size_t doubles(const Indices& part) const {
    const Indices sorted = by_height(part);
    std::size_t count = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      count += is_same_place(sorted[i], sorted[i - 1]) ? 1 : 0;
    }
    return count;
  }

  /// Returns the distances of the slices, in their order along the normal.
  std::vector<double> gaps(const Indices& part) const {
    const Indices sorted = by_height(part);
    std::vector<double> list;
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      list.push_back(heights_[sorted[i]] - heights_[sorted[i - 1]]);
    }
    return list;
  }

  /// Returns whether the numbers of the slices rise or fall along the normal.
  bool is_numbered_along(const Indices& part) const {
    const Indices sorted = by_height(part);
    bool rises = true, falls = true;
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      const auto before = slices_[sorted[i - 1]].number, after = slices_[sorted[i]].number;
      rises = rises && before && after && *before < *after;
      falls = falls && before && after && *before > *after;
    }
    return rises || falls;
  }

  /// Returns the share of the shorter of the ranges of two parts that both have; below 0 they are
  /// apart.
  double overlap(const Indices& one, const Indices& other) const {
    const Indices a = by_height(one), b = by_height(other);
    const double lower = std::max(heights_[a.front()], heights_[b.front()]);
    const double upper = std::min(heights_[a.back()], heights_[b.back()]);
    const double shorter = std::min(heights_[a.back()] - heights_[a.front()],
                                    heights_[b.back()] - heights_[b.front()]);
    return (upper - lower) / shorter;
  }

  /// Returns whether each part is a stack by itself, in which slices may be missing, and they stand
  /// between each other's slices. If all together make a stack too, most of them must.
  bool are_interleaved(const std::vector<Indices>& parts, const Indices& whole) const {
    double least_step = std::numeric_limits<double>::infinity();
    for (const Indices& part : parts) {
      if (part.size() < least_of_a_stack) return false;
      const std::vector<double> distances = gaps(part);
      const double step = middle(distances);
      if (std::ranges::min(distances) < nearly * step) return false;
      least_step = std::min(least_step, step);
    }
    const std::vector<double> together = gaps(whole);
    if (std::ranges::min(together) >= nearly * least_step) return false;
    std::vector<double> overlaps;
    for (std::size_t i = 1; i < parts.size(); ++i) {
      overlaps.push_back(overlap(parts[i - 1], parts[i]));
    }
    return is_even(whole) ? std::ranges::min(overlaps) > 0.5 : std::ranges::max(overlaps) > 0;
  }

  /// Returns whether the distances are the same, to what rounded positions leave.
  bool is_even(const Indices& part) const {
    const std::vector<double> distances = gaps(part);
    return std::ranges::max(distances) * nearly <= std::ranges::min(distances);
  }

 private:
  static constexpr double nearly = 0.9;  // what rounded positions leave of a distance

  static double middle(std::vector<double> numbers) {
    std::ranges::sort(numbers);
    return numbers[numbers.size() / 2];
  }

  const std::vector<DicomSlice>& slices_;
  std::vector<double> heights_;
  double same_place_ = 0;
};

struct Part {
  Indices slices;
  std::string mark, note;
};

std::string joined(const std::string& mark, const std::string& more) {
  return mark.empty() ? more : mark + ", " + more;
}

/// Values as numbers where they are some, else as text.
struct MarkOrder {
  bool operator()(const std::string& a, const std::string& b) const {
    const auto number = [](const std::string& text) -> std::optional<double> {
      double value = 0;
      const char* const end = text.data() + text.size();
      const auto [stop, error] = std::from_chars(text.data(), end, value);
      return error == std::errc{} && stop == end ? std::optional(value) : std::nullopt;
    };
    const std::optional<double> x = number(a), y = number(b);
    if (x && y && *x != *y) return *x < *y;
    if (x.has_value() != y.has_value()) return x.has_value();
    return a < b;
  }
};

std::vector<Part> parts_by_mark(const Series& series, const Part& whole, std::size_t mark) {
  std::map<std::string, Indices, MarkOrder> values;
  for (const std::size_t i : whole.slices) values[series.slice(i).marks[mark]].push_back(i);
  std::vector<Part> parts;
  parts.reserve(values.size());
  for (auto& [value, slices] : values) {
    parts.push_back({std::move(slices),
                     joined(whole.mark, std::string(dicom_marks[mark].name) + " " +
                                            (value.empty() ? "not said" : value)),
                     whole.note});
  }
  return parts;
}

std::vector<Indices> slices_of(const std::vector<Part>& parts) {
  std::vector<Indices> list;
  list.reserve(parts.size());
  for (const Part& part : parts) list.push_back(part.slices);
  return list;
}

/// Returns the first slices at each place by their numbers, the second, and so on, where there are
/// as many at each; else nothing.
std::vector<Part> parts_by_number(const Series& series, const Part& whole) {
  const Indices sorted = series.by_height(whole.slices);
  std::vector<Indices> places;
  for (const std::size_t i : sorted) {
    if (places.empty() || !series.is_same_place(places.back().front(), i)) places.emplace_back();
    places.back().push_back(i);
  }
  const std::size_t count = places.front().size();
  if (places.size() < 2) return {};
  std::vector<Part> parts(count);
  for (Indices& place : places) {
    if (place.size() != count) return {};
    const auto order = [&](std::size_t i) {
      const DicomSlice& slice = series.slice(i);
      return std::pair(slice.number.value_or(0), slice.frame);
    };
    std::ranges::sort(place, {}, order);
    for (std::size_t k = 0; k < count; ++k) {
      if (k > 0 && order(place[k - 1]) == order(place[k])) return {};
      parts[k].slices.push_back(place[k]);
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    parts[k].mark = joined(whole.mark, "volume " + std::to_string(k + 1) + " of " +
                                           std::to_string(count) + " by InstanceNumber");
    parts[k].note = whole.note;
  }
  return parts;
}

/// Returns the runs of slices whose numbers go along the normal, where each begins anew beside the
/// last.
std::vector<Part> parts_by_run(const Series& series, const Part& whole) {
  Indices numbered = whole.slices;
  for (const std::size_t i : numbered) {
    if (!series.slice(i).number) return {};
  }
  const auto number = [&](std::size_t i) { return *series.slice(i).number; };
  std::ranges::sort(numbered, {}, number);
  if (std::ranges::adjacent_find(numbered, {}, number) != numbered.end()) return {};
  std::vector<Part> parts;
  double direction = 0;
  for (const std::size_t i : numbered) {
    const double step =
        parts.empty() ? 0 : series.height(i) - series.height(parts.back().slices.back());
    if (parts.empty() || (parts.back().slices.size() > 1 && step * direction < 0)) {
      parts.emplace_back();
    } else if (parts.back().slices.size() == 1) {
      direction = step;
    }
    parts.back().slices.push_back(i);
  }
  if (parts.size() < 2 || !series.are_interleaved(slices_of(parts), whole.slices)) return {};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    parts[k].mark = joined(whole.mark, "volume " + std::to_string(k + 1) + " of " +
                                           std::to_string(parts.size()) + " by InstanceNumber");
    parts[k].note = whole.note;
  }
  return parts;
}

std::vector<Part> split(const Series& series, Part whole);

std::vector<Part> split_each(const Series& series, std::vector<Part> parts) {
  std::vector<Part> all;
  for (Part& part : parts) {
    for (Part& one : split(series, std::move(part))) all.push_back(std::move(one));
  }
  return all;
}

std::vector<Part> split(const Series& series, Part whole) {
  const std::size_t count = whole.slices.size();
  if (count < 4) return {std::move(whole)};
  const std::size_t doubles = series.doubles(whole.slices);
  for (std::size_t mark = 0; mark < dicom_marks.size(); ++mark) {
    std::vector<Part> parts = parts_by_mark(series, whole, mark);
    if (parts.size() < 2 || parts.size() > count / 2) continue;
    const std::vector<Indices> slices = slices_of(parts);
    if (doubles > 0) {
      std::size_t left = 0;
      for (const Indices& part : slices) left += series.doubles(part);
      if (left < doubles) return split_each(series, std::move(parts));
    } else if (series.are_interleaved(slices, whole.slices)) {
      if (dicom_marks[mark].is_decisive || !series.is_numbered_along(whole.slices)) {
        return split_each(series, std::move(parts));
      }
      whole.note = "its slices are of " + std::to_string(parts.size()) + " acquisitions (" +
                   dicom_marks[mark].name +
                   "), which alternate; their numbers make one stack of them, and so they are read";
    }
  }
  std::vector<Part> parts =
      doubles > 0 ? parts_by_number(series, whole) : parts_by_run(series, whole);
  if (!parts.empty()) return parts;
  return {std::move(whole)};
}

}  // namespace

std::vector<DicomStack> split_dicom_volumes(std::vector<DicomSlice> slices) {
  const bool have_places =
      std::ranges::all_of(slices, [](const DicomSlice& s) { return s.position.has_value(); });
  std::vector<DicomStack> stacks;
  if (slices.empty() || !have_places) {
    stacks.push_back({std::move(slices), {}, {}});
    return stacks;
  }
  Part whole;
  whole.slices.resize(slices.size());
  std::iota(whole.slices.begin(), whole.slices.end(), std::size_t{0});
  for (Part& part : split(Series(slices), std::move(whole))) {
    std::ranges::sort(part.slices);
    DicomStack stack;
    for (const std::size_t i : part.slices) stack.slices.push_back(slices[i]);
    stack.mark = std::move(part.mark);
    stack.note = std::move(part.note);
    stacks.push_back(std::move(stack));
  }
  return stacks;
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/meshes/segments.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <memory>
#include <random>

#include "benchmarks/meshes/segment_packets.h"
#include "benchmarks/support/interleave.h"
#include "benchmarks/vtk/segment_integrators.h"
#include "pellucid/segment/linear.h"
#include "pellucid/simd/instruction_set.h"
#include "tests/segment/wide_linear.h"
#include "tests/support/table.h"

namespace pellucid::bench {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class T>
using Kernel = void (*)(const PellucidBenchSegments<T>*);

/// Lists in T, as long as packets need them: the last segment stands for those that are missing.
template <class T>
struct PacketLists {
  std::vector<T> extinction_f, extinction_b, length, color_f[3], color_b[3], result[4];
  PellucidBenchSegments<T> view{};

  explicit PacketLists(const SegmentList& list) {
    constexpr std::size_t lanes = pellucid_bench_most_lanes;
    const std::size_t count = list.size(), padded = (count + lanes - 1) / lanes * lanes;
    const auto fill = [&](std::vector<T>& to, const auto& number) {
      to.reserve(padded);
      for (std::size_t i = 0; i < padded; ++i) {
        to.push_back(static_cast<T>(number(std::min(i, count - 1))));
      }
    };
    fill(extinction_f, [&](std::size_t i) { return list.extinction_f[i]; });
    fill(extinction_b, [&](std::size_t i) { return list.extinction_b[i]; });
    fill(length, [&](std::size_t i) { return list.length[i]; });
    for (std::size_t c = 0; c < 3; ++c) {
      fill(color_f[c], [&](std::size_t i) { return list.color_f[i][c]; });
      fill(color_b[c], [&](std::size_t i) { return list.color_b[i][c]; });
      view.color_f[c] = color_f[c].data();
      view.color_b[c] = color_b[c].data();
    }
    for (std::size_t c = 0; c < 4; ++c) {
      result[c].resize(padded);
      view.result[c] = result[c].data();
    }
    view.extinction_f = extinction_f.data();
    view.extinction_b = extinction_b.data();
    view.length = length.data();
    view.count = static_cast<int>(count);
  }
};

template <class T>
SegmentIntegrator integrator(const std::string& name, Kernel<T> kernel) {
  return {name, [=](const SegmentList& list) {
            const auto lists = std::make_shared<PacketLists<T>>(list);
            return PreparedSegments{[=] { kernel(&lists->view); },
                                    [=, count = list.size()] {
                                      SegmentColors colors(count);
                                      for (std::size_t i = 0; i < count; ++i) {
                                        for (std::size_t c = 0; c < 4; ++c) {
                                          colors[i][c] = static_cast<double>(lists->result[c][i]);
                                        }
                                      }
                                      return colors;
                                    }};
          }};
}

void add(SegmentList& list, double f, double b, double length, double c_f, double c_b) {
  list.extinction_f.push_back(f);
  list.extinction_b.push_back(b);
  list.length.push_back(length);
  list.color_f.push_back({c_f, 0, c_b});
  list.color_b.push_back({c_b, 0, c_f});
}

/// Segments and what they should give.
struct Truth {
  SegmentList list;
  SegmentColors colors;
};

/// The rows of the table whose depths, end by end, are at most `largest`, in random order.
Truth table_rows(double largest, double largest_mean) {
  const test::Table table = test::Table::reference("linear_segment.csv");
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double length = table.number(row, "D");
    if (std::max(table.number(row, "tau_f"), table.number(row, "tau_b")) * length <= largest &&
        table.number(row, "optical_depth") <= largest_mean) {
      rows.push_back(row);
    }
  }
  std::shuffle(rows.begin(), rows.end(), std::mt19937(1));
  Truth truth;
  for (const std::size_t row : rows) {
    const double c_f = table.number(row, "C_f"), c_b = table.number(row, "C_b");
    add(truth.list, table.number(row, "tau_f"), table.number(row, "tau_b"), table.number(row, "D"),
        c_f, c_b);
    const double f = table.number(row, "weight_f"), b = table.number(row, "weight_b");
    truth.colors.push_back({c_f * f + c_b * b, 0, c_b * f + c_f * b, table.number(row, "opacity")});
  }
  return truth;
}

/// Depths from 1e-6 to 100 whose ends differ by the contrast, one way and the other.
Truth with_contrast(double contrast) {
  constexpr int count = 40;
  Truth truth;
  for (int i = 0; i < count; ++i) {
    const double front = std::pow(10.0, -6 + 8.0 * i / (count - 1));
    const double back = front * (i % 2 == 0 ? 1 + contrast : 1 - contrast);
    add(truth.list, front, back, 1, 1, 0);
    const test::WideLinear w = test::wide_linear(front, back, 1);
    truth.colors.push_back({static_cast<double>(w.weight_f), 0, static_cast<double>(w.weight_b),
                            static_cast<double>(w.opacity)});
  }
  return truth;
}

double largest_error(const PreparedSegments& prepared, const Truth& truth) {
  prepared.run();
  const SegmentColors found = prepared.result();
  double largest = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double off = std::fabs(found[i][c] - truth.colors[i][c]);
      largest = std::max(largest, std::isfinite(off) ? off : infinity);
    }
  }
  return largest;
}

/// Of this thread alone: what others take of the machine does not count.
double thread_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds per segment, of as many runs as fit into the time.
double seconds_each(const PreparedSegments& prepared, std::size_t count, double seconds) {
  const double start = thread_seconds();
  double spent = 0;
  std::size_t runs = 0;
  while (spent < seconds) {
    for (int i = 0; i < 20; ++i) prepared.run();
    runs += 20;
    spent = thread_seconds() - start;
  }
  return spent / (static_cast<double>(runs) * static_cast<double>(count));
}

}  // namespace

std::vector<SegmentIntegrator> our_segment_integrators() {
  std::vector<SegmentIntegrator> list{
      integrator<float>("float", pellucid_bench_segments_scalar),
      integrator<double>("double", pellucid_bench_segments_double_scalar)};
#if PELLUCID_HAS_PACKETS
  for (const InstructionSet set : packet_sets) {
    if (!is_supported(set)) continue;
    const std::string lanes =
        std::to_string(lanes_of(set)) + " lanes (" + std::string(name_of(set)) + ")";
    list.push_back(integrator<float>("float, " + lanes,
                                     entry_of(set, PELLUCID_ENTRIES(pellucid_bench_segments))));
    list.push_back(integrator<double>(
        "double, " + lanes, entry_of(set, PELLUCID_ENTRIES(pellucid_bench_segments_double))));
  }
#endif
  return list;
}

SegmentStudy study_segments(int rounds, double seconds) {
  std::vector<SegmentIntegrator> ways = our_segment_integrators();
  for (SegmentIntegrator& way : vtk_segment_integrators()) ways.push_back(std::move(way));
  SegmentStudy study;
  study.contrasts = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  std::vector<Truth> contrasts;
  contrasts.reserve(study.contrasts.size());
  for (const double contrast : study.contrasts) contrasts.push_back(with_contrast(contrast));

  std::vector<std::function<double()>> runs;
  for (const SegmentIntegrator& way : ways) {
    SegmentResult result;
    result.name = way.name;
    const Truth all = table_rows(way.largest_depth, infinity);
    const Truth thin = table_rows(way.largest_depth, 2);
    const PreparedSegments of_all = way.prepare(all.list), of_thin = way.prepare(thin.list);
    result.rows = all.list.size();
    result.error = largest_error(of_all, all);
    for (const Truth& truth : contrasts) {
      result.contrast_error.push_back(largest_error(way.prepare(truth.list), truth));
    }
    runs.emplace_back(
        [=, count = all.list.size()] { return seconds_each(of_all, count, seconds); });
    runs.emplace_back(
        [=, count = thin.list.size()] { return seconds_each(of_thin, count, seconds); });
    study.results.push_back(std::move(result));
  }
  const std::vector<double> medians =
      interleaved_medians(runs, static_cast<std::size_t>(std::max(1, rounds)));
  for (std::size_t i = 0; i < study.results.size(); ++i) {
    study.results[i].nanoseconds = 1e9 * medians[2 * i];
    study.results[i].nanoseconds_thin = 1e9 * medians[2 * i + 1];
  }
  return study;
}

}  // namespace pellucid::bench

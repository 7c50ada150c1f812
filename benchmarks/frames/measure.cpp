// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/measure.h"

#include <algorithm>
#include <stdexcept>

#include "benchmarks/frames/reference_cache.h"
#include "benchmarks/support/document.h"
#include "pellucid/cpu/render.h"

namespace pellucid::bench {
namespace {

std::vector<Measurement> ways(const MeasureOptions& options) {
  std::vector<Measurement> list;
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    list.push_back({{Method::exact, precision, 1, smallest_tolerance}, {}, {}, 0});
  }
  if (options.exact_only) return list;
  for (const Method method : {Method::rectangle, Method::taylor, Method::midpoint,
                              Method::trapezoid, Method::simpson, Method::linear}) {
    for (const double step : options.steps) {
      list.push_back({{method, Precision::float32, step}, {}, {}, 0});
    }
  }
  return list;
}

std::string data_of(const Volume& volume) {
  const auto& n = volume.description().dimensions;
  return format("%d×%d×%d ", n[0], n[1], n[2]) + std::string(type_name(volume.data()));
}

}  // namespace

double Measurement::median_seconds() const {
  std::vector<double> sorted = seconds;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  return n % 2 == 1 ? sorted[n / 2] : 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]);
}

const Measurement& SceneResult::find(Method method, Precision precision) const {
  for (const Measurement& m : measurements) {
    if (m.integration.method == method && m.integration.precision == precision) return m;
  }
  throw std::out_of_range("no such measurement");
}

SceneResult measure(const scenes::NamedScene& named, const MeasureOptions& options) {
  options.say(named.name + ": reference");
  const Image reference = cached_reference(named.scene, options.cache);
  SceneResult result{named.name, named.scene.size, data_of(*named.scene.volume), ways(options)};

  RenderOptions render_options;
  render_options.threads = options.threads;
  Scene scene = named.scene;
  render(scene, render_options);  // Memory and caches are warm for the first way as for the last.
  for (int round = 0; round < options.repeats; ++round) {
    options.say(named.name + ": round " + std::to_string(round + 1));
    for (Measurement& m : result.measurements) {
      const bool exact = m.integration.method == Method::exact;
      if (round > 0 && !exact && m.seconds.front() > options.longest_repeated_seconds) continue;
      scene.integration = m.integration;
      RenderReport report;
      const Image image = render(scene, render_options, &report);
      m.seconds.push_back(report.seconds);
      if (round == 0) {
        m.error = scenes::difference(image, reference);
        m.cells = report.cells;
      }
    }
  }
  return result;
}

}  // namespace pellucid::bench

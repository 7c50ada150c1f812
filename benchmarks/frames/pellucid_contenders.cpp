// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/pellucid_contenders.h"

#include <utility>

#include "pellucid/cpu/render.h"

namespace pellucid::bench {
namespace {

TimedFrame timed_frame(const Scene& scene, int threads) {
  RenderOptions options;
  options.machine.threads = threads;
  auto [image, report] = render(scene, options);
  TimedFrame frame;
  frame.image = std::move(image);
  frame.seconds = report.seconds;
  frame.work = report.cells;
  return frame;
}

Contender exact(const Scene& scene, Grade grade, const std::vector<double>& tolerances,
                int threads) {
  return {grade == Grade::estimated ? exact_name : proved_name, Knob::tolerance, tolerances,
          [=](double tolerance) {
            Scene one = scene;
            one.integration = {};
            one.integration.tolerance = tolerance;
            one.integration.grade = grade;
            return timed_frame(one, threads);
          }};
}

}  // namespace

std::vector<Contender> pellucid_contenders(const Scene& scene, const PellucidSettings& settings) {
  std::vector<Contender> list{
      exact(scene, Grade::estimated, settings.tolerances, settings.threads),
      exact(scene, Grade::proved, settings.proved_tolerances, settings.threads)};
  std::erase_if(list, [](const Contender& contender) { return contender.settings.empty(); });
  for (const std::string& name : settings.methods) {
    const std::optional<Method> method = method_from_name(name);
    if (!method || *method == Method::exact) continue;
    const int threads = settings.threads;
    list.push_back({name, Knob::step, settings.steps, [=](double step) {
                      Scene one = scene;
                      one.integration = {};
                      one.integration.method = *method;
                      one.integration.precision = Precision::float32;
                      one.integration.step = step;
                      return timed_frame(one, threads);
                    }});
  }
  return list;
}

bool is_our_sampler(const std::string& contender) {
  const std::optional<Method> method = method_from_name(contender);
  return method && *method != Method::exact;
}

}  // namespace pellucid::bench

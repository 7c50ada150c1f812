// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/measure.h"

#include <algorithm>
#include <chrono>

#include "benchmarks/support/document.h"
#include "benchmarks/vtk/vtk_contenders.h"

namespace pellucid::bench {
namespace {

std::string data_of(const Scene& scene) {
  const auto& n =
      (scene.channels ? scene.channels->grid() : *scene.volume).description().dimensions;
  std::string text = format("%d×%d×%d", n[0], n[1], n[2]);
  if (!scene.channels) return text + " " + std::string(type_name(scene.volume->data()));
  for (const Channel& channel : *scene.channels) {
    text += (&channel == &*scene.channels->begin() ? " " : ", ") +
            std::string(type_name(channel.volume->data()));
  }
  return text;
}

/// What the next setting is expected to take: samples grow as steps shrink; what a tolerance costs
/// is not known before.
double expected_seconds(const CurvePoint& last, Knob knob, double next_setting) {
  const double seconds = last.seconds.front();
  return knob == Knob::step ? seconds * last.setting / next_setting : seconds;
}

/// Settings that are measured however long they take: exact goes at least to its default tolerance.
std::size_t least_points(Knob knob) {
  return knob == Knob::tolerance ? 3 : 1;
}

/// How long frames may take: `always`, and `inaccurate` where the last one has not come within the
/// default tolerance.
struct Longest {
  double always, inaccurate;
};

/// Until a sampler has taken a dozen times as long as exact at the default tolerance it is not
/// known that it is ten times slower.
Longest longest_of(const MeasureOptions& options, const Curve& exact) {
  const Reach there = reach(exact, default_tolerance, ErrorKind::largest);
  return {options.longest_seconds,
          std::max(options.longest_seconds, std::min(12 * there.seconds, 20.0))};
}

/// The first round, with errors: it finds how far each curve goes.
Curve first_round(const Contender& contender, const ReferencePixels& reference,
                  const Longest& longest) {
  Curve curve{contender.name, contender.knob, {}, false};
  for (const double setting : contender.settings) {
    if (curve.points.size() >= least_points(curve.knob)) {
      const CurvePoint& last = curve.points.back();
      const bool goes_on = curve.knob == Knob::step && last.error.largest > default_tolerance;
      if (expected_seconds(last, curve.knob, setting) >
          (goes_on ? longest.inaccurate : longest.always)) {
        curve.cut_short = true;
        break;
      }
    }
    const TimedFrame frame = contender.render(setting);
    curve.points.push_back(
        {setting, {frame.seconds}, error_of(frame.image, reference), frame.work});
  }
  return curve;
}

/// Of all curves in turn, so that neighbours are different contenders.
std::vector<std::pair<std::size_t, std::size_t>> in_turn(const std::vector<Curve>& curves) {
  std::vector<std::pair<std::size_t, std::size_t>> list;
  std::size_t most = 0;
  for (const Curve& curve : curves) most = std::max(most, curve.points.size());
  for (std::size_t p = 0; p < most; ++p) {
    for (std::size_t c = 0; c < curves.size(); ++c) {
      if (p < curves[c].points.size()) list.emplace_back(c, p);
    }
  }
  return list;
}

}  // namespace

SceneResult measure(const scenes::NamedScene& named, const MeasureOptions& options) {
  const Scene& scene = named.scene;
  options.say(named.name + ": reference");
  const ReferencePixels reference =
      reference_pixels(scene, options.pixels, std::max(1, options.pellucid.threads), options.cache);
  SceneResult result{named.name, scene.size, data_of(scene), reference.index.size(), {}, {}};

  std::vector<Contender> contenders = pellucid_contenders(scene, options.pellucid);
  if (options.vtk) {
    VtkContenders vtk = vtk_contenders(scene, options.vtk_steps, options.pellucid.threads);
    std::move(vtk.list.begin(), vtk.list.end(), std::back_inserter(contenders));
    if (!vtk.left_out.empty()) result.left_out.push_back(vtk.left_out);
  }
  const auto start = std::chrono::steady_clock::now();
  // Memory and caches are warm, and what depends on the data alone is made, for the first as for
  // the last.
  contenders.front().render(contenders.front().settings.front());
  for (const Contender& contender : contenders) {
    options.say(named.name + ": " + contender.name);
    const Longest longest = result.curves.empty()
                                ? Longest{options.longest_seconds, options.longest_seconds}
                                : longest_of(options, result.curves.front());
    result.curves.push_back(first_round(contender, reference, longest));
  }
  const auto ways = in_turn(result.curves);
  for (int round = 1; round < options.repeats; ++round) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    if (round > 1 && spent.count() > options.scene_seconds) break;
    options.say(named.name + format(": round %d of %d", round + 1, options.repeats));
    const std::size_t begin =
        ways.size() * static_cast<std::size_t>(round) / static_cast<std::size_t>(options.repeats);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const auto [c, p] = ways[(begin + i) % ways.size()];
      CurvePoint& point = result.curves[c].points[p];
      if (point.seconds.front() > options.longest_repeated_seconds) continue;
      point.seconds.push_back(contenders[c].render(point.setting).seconds);
    }
  }
  return result;
}

}  // namespace pellucid::bench

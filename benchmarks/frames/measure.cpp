// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/measure.h"

#include <algorithm>
#include <chrono>
#include <iterator>

#include "benchmarks/frames/report.h"
#include "benchmarks/support/document.h"
#include "benchmarks/vtk/vtk_contenders.h"

namespace pellucid::bench {
namespace {

std::string data_of(const Scene& scene) {
  const Volume& grid = *grid_of(scene.layers.front());
  const auto& n = grid.description().dimensions;
  std::string text = format("%d×%d×%d", n[0], n[1], n[2]);
  const auto* const content = only_content<ChannelsContent>(scene);
  if (content == nullptr) return text + " " + std::string(type_name(grid.data()));
  for (const Channel& channel : *content->channels) {
    text += (&channel == &*content->channels->begin() ? " " : ", ") +
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

/// How slow a sampler has to be, relative to exact at an equal error, to be left alone; and what a
/// frame takes at most, in seconds.
constexpr double slow_enough = 10, max_seconds = 30;

/// Whether it is not known yet how much slower than exact, whose curve this is, a sampler is at all
/// of the errors that are compared.
bool is_to_go_on(const CurvePoint& last, const Curve& exact) {
  return std::any_of(std::begin(compared_errors), std::end(compared_errors), [&](double error) {
    const Reach there = reach(exact, error, ErrorKind::largest);
    return last.error.largest > error && there.reached &&
           last.seconds.front() < slow_enough * there.seconds;
  });
}

/// The first round, with errors: it finds how far each curve goes. `exact`: null: it is this curve.
Curve first_round(const Contender& contender, const ReferencePixels& reference,
                  double longest_seconds, const Curve* exact) {
  Curve curve{contender.name, contender.knob, {}, false};
  for (const double setting : contender.settings) {
    if (curve.points.size() >= least_points(curve.knob)) {
      const CurvePoint& last = curve.points.back();
      const bool goes_on =
          exact != nullptr && curve.knob == Knob::step && is_to_go_on(last, *exact);
      if (expected_seconds(last, curve.knob, setting) >
          (goes_on ? std::max(max_seconds, longest_seconds) : longest_seconds)) {
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
    const Curve* const exact = result.curves.empty() ? nullptr : &result.curves.front();
    result.curves.push_back(first_round(contender, reference, options.longest_seconds, exact));
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

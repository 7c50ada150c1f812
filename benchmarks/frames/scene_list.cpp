// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/scene_list.h"

#include <algorithm>

#include "tests/scenes/real.h"

namespace pellucid::bench {
namespace {

using List = std::vector<NamedScene>;

/// One view of each scene, unless all are wanted.
List chosen(List list, const SceneSelection& selection, const char* view) {
  if (selection.all_views) return list;
  std::erase_if(list, [&](const NamedScene& named) { return !named.name.ends_with(view); });
  return list;
}

List marschner_lobb(const SceneSelection& s) {
  return chosen(scenes::marschner_lobb_scenes(s.tiny ? 32 : 256, s.size), s, "oblique");
}

/// Transfer functions as users of VTK write them: a ramp, and three thin peaks.
List ramp_and_peaks(const SceneSelection& s) {
  const auto volume = scenes::builtin("marschner_lobb", s.tiny ? 32 : 256);
  const auto ramp = scenes::transfer({{0.1, 0, {0.1, 0.2, 0.9}}, {1, 2, {1, 0.8, 0.2}}});
  constexpr double width = 0.006, tip = 100;
  scenes::Points points;
  const auto add_peak = [&](double value, const Rgb<double>& color) {
    points.push_back({value - width, 0, color});
    points.push_back({value, tip, color});
    points.push_back({value + width, 0, color});
  };
  add_peak(0.3, {0.2, 0.4, 1});
  add_peak(0.5, {0.3, 0.9, 0.3});
  add_peak(0.7, {1, 0.5, 0.1});
  const Camera oblique = scenes::view_camera(scenes::View::oblique);
  return {{"ramp, oblique", scenes::make_scene(volume, ramp, oblique, s.size)},
          {"peaks, oblique",
           scenes::make_scene(volume, scenes::transfer(std::move(points)), oblique, s.size)}};
}

List ray_splitting(const SceneSelection& s) {
  List list;
  for (const double upper : {.74, .6563, .582, .5161, .4577, .4059, .36}) {
    if (!s.all_views && upper != .74 && upper != .36) continue;
    list.push_back(scenes::ray_splitting_scene(s.tiny ? 32 : 128, s.size, upper));
  }
  return list;
}

List sphere(const SceneSelection& s) {
  return chosen(scenes::sphere_scenes(s.tiny ? 33 : 129, s.size), s, "diagonal");
}

List torture(const SceneSelection& s) {
  return s.all_views ? scenes::torture_scenes(s.tiny ? 33 : 129, s.size) : List{};
}

template <std::size_t Index>
List scan(const SceneSelection& s) {
  const scenes::RealData data = scenes::real_data().at(Index);
  // Scans are large: not read where the filter cannot want them ("brain", "brain, inside").
  const auto named_by = [&](const std::string& filter) {
    return data.name.find(filter) != std::string::npos ||
           filter.find(data.name) != std::string::npos;
  };
  const bool wanted =
      s.filters.empty() || std::any_of(s.filters.begin(), s.filters.end(), named_by);
  if (!wanted || !scenes::why_missing(data.file).empty()) return {};
  return chosen(scenes::real_scenes(data, s.size), s, "outside");
}

}  // namespace

bool SceneSelection::wants(const std::string& name) const {
  return filters.empty() || std::any_of(filters.begin(), filters.end(), [&](const std::string& f) {
           return name.find(f) != std::string::npos;
         });
}

std::vector<std::vector<NamedScene> (*)(const SceneSelection&)> scene_groups() {
  return {marschner_lobb, ramp_and_peaks, ray_splitting, sphere, torture,
          scan<0>,        scan<1>,        scan<2>,       scan<3>};
}

std::vector<std::string> missing_scans() {
  std::vector<std::string> missing;
  for (const scenes::RealData& data : scenes::real_data()) {
    if (!scenes::why_missing(data.file).empty()) missing.push_back(data.name);
  }
  return missing;
}

}  // namespace pellucid::bench

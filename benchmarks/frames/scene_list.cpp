// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/scene_list.h"

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
  const std::string& name = data.name;
  const bool wanted = s.filter.empty() || name.find(s.filter) != std::string::npos ||
                      s.filter.find(name) != std::string::npos;
  if (!wanted || !std::filesystem::exists(data.file)) return {};
  return chosen(scenes::real_scenes(data, s.size), s, "outside");
}

}  // namespace

std::vector<std::vector<NamedScene> (*)(const SceneSelection&)> scene_groups() {
  return {marschner_lobb, ray_splitting, sphere, torture, scan<0>, scan<1>, scan<2>, scan<3>};
}

std::vector<std::string> missing_scans() {
  std::vector<std::string> missing;
  for (const scenes::RealData& data : scenes::real_data()) {
    if (!std::filesystem::exists(data.file)) missing.push_back(data.name);
  }
  return missing;
}

}  // namespace pellucid::bench

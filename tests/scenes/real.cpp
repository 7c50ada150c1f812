// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/real.h"

#include <utility>

#include "pellucid/io/read_volume.h"
#include "tests/support/one_layer.h"
#include "tests/support/test_data.h"

namespace pellucid::scenes {

std::vector<RealData> real_data() {
  const std::filesystem::path data = test_data_folder() / "structured";
  // Extinction in 1/mm, or per voxel where a file has no unit.
  return {{"brain",
           "/usr/share/mricron/templates/ch2.nii.gz",
           {{45, 0, {0.4, 0.2, 0.1}},
            {75, 0.01, {0.6, 0.4, 0.3}},
            {107, 0.02, {0.8, 0.7, 0.6}},
            {110, 0.5, {0.9, 0.2, 0.1}},
            {113, 0.02, {0.9, 0.8, 0.7}},
            {160, 0.1, {1, 0.9, 0.6}},
            {220, 0.3, {1, 1, 0.9}}}},
          {"engine",
           data / "engine.nii.gz",
           {{70, 0, {0.1, 0.2, 0.4}},
            {125, 0.01, {0.3, 0.5, 0.7}},
            {149, 0.015, {0.4, 0.6, 0.8}},
            {150, 1, {1, 0.5, 0.1}},
            {151, 0.015, {0.5, 0.6, 0.8}},
            {255, 0.2, {1, 0.9, 0.7}}}},
          {"bonsai",
           data / "bonsai.nii.gz",
           {{15, 0, {0.1, 0.3, 0.1}},
            {35, 0.02, {0.2, 0.7, 0.2}},
            {49.5, 0.02, {0.3, 0.7, 0.2}},
            {50, 2, {0.9, 0.9, 0.2}},
            {50.5, 0.02, {0.4, 0.6, 0.2}},
            {130, 0.1, {0.5, 0.3, 0.2}},
            {255, 0.3, {0.9, 0.8, 0.7}}}},
          {"stent",
           data / "stent.nrrd",
           {{0.02, 0, {0.4, 0.1, 0.1}},
            {0.12, 0.01, {0.8, 0.4, 0.3}},
            {0.245, 0.02, {0.9, 0.7, 0.6}},
            {0.25, 1.5, {0.2, 0.9, 1}},
            {0.255, 0.02, {0.9, 0.8, 0.7}},
            {0.6, 0.5, {1, 1, 0.9}}}},
          {"hydrogen",
           data / "hydrogenatom" / "hydrogenatom.raw",
           {{8, 0, {0.1, 0.2, 0.8}},
            {40, 0.02, {0.2, 0.6, 1}},
            {79.5, 0.03, {0.3, 0.8, 0.9}},
            {80, 1, {1, 0.9, 0.2}},
            {80.5, 0.03, {0.5, 0.8, 0.4}},
            {250, 0.3, {1, 0.3, 0.1}}},
           {128, 128, 128}}};
}

std::string why_missing(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return file.string() + " not found";
#ifdef PELLUCID_HAVE_ITK
  constexpr bool has_itk = true;
#else
  constexpr bool has_itk = false;
#endif
#ifdef PELLUCID_HAVE_VTK
  constexpr bool has_vtk = true;
#else
  constexpr bool has_vtk = false;
#endif
  const std::string extension = file.extension().string();
  const bool is_of_vtk = extension == ".vtk" || extension == ".vtu" || extension == ".ex2";
  const char* reader = nullptr;
  if (!has_itk && extension == ".nrrd") reader = "ITK";
  if (!has_vtk && is_of_vtk) reader = "VTK";
  if (reader == nullptr) return {};
  return file.string() + " is read by " + reader + ", which is not built in";
}

VolumePointer read(const RealData& data) {
  ReadOptions options;
  if (data.raw_dimensions[0] > 0) {
    options.dimensions = data.raw_dimensions;
    options.type = "u8";
  }
  return std::make_shared<const Volume>(read_volume(data.file, options));
}

std::vector<NamedScene> real_scenes(const RealData& data, ImageSize size) {
  Scene scene;
  test::volume_of(scene).volume = read(data);
  test::volume_of(scene).transfer_function = std::make_shared<const TransferFunction>(data.points);
  scene.size = size;

  const auto corners = test::volume_of(scene).volume->world_corners();
  Vec3<double> centre{};
  for (const Vec3<double>& corner : corners) centre = centre + corner * 0.125;
  const double radius = length(corners[7] - centre);

  std::vector<NamedScene> scenes;
  const auto add = [&](const char* view) { scenes.push_back({data.name + ", " + view, scene}); };
  scene.camera.focal_point = centre;
  scene.camera.position = centre + Vec3<double>{1.9, -2.3, 1.1} * radius;
  scene.camera.up = {0, 0, 1};
  scene.camera.vertical_angle = 32;
  add("outside");

  scene.camera.projection = Projection::orthographic;
  scene.camera.position = centre + Vec3<double>{0, -2, 0} * radius;
  scene.camera.parallel_scale = 0.7 * radius;
  add("axis");

  scene.camera.projection = Projection::perspective;
  scene.camera.position = centre + Vec3<double>{0.05, 0.1, 0.02} * radius;
  scene.camera.focal_point = centre + Vec3<double>{-0.3, 0.4, 0.3} * radius;
  scene.camera.vertical_angle = 90;
  add("inside");
  return scenes;
}

}  // namespace pellucid::scenes

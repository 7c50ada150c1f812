// SPDX-License-Identifier: Apache-2.0
#include "tests/cuda/device_matrix.h"

#include <cmath>
#include <cstdio>

namespace pellucid::scenes {
namespace {

/// Returns whether the rays of a scene are left to the CPU, which says so.
bool goes_to_cpu(const RenderReport& report) {
  return report.device.starts_with("rendered by the CPU: ");
}

/// Whether a device is to follow the rays of a scene: as the documents say.
bool is_for_devices(const Scene& scene) {
  if (scene.layers.size() != 1 || !scene.clips.empty()) return false;
  const Layer& layer = scene.layers[0];
  const auto* const volume = std::get_if<VolumeContent>(&layer.content);
  if (!layer.visible || !layer.clips.empty() || layer.projection || has_surfaces(layer)) {
    return false;
  }
  if (volume != nullptr) return volume->mask == nullptr;
  return !std::holds_alternative<LabelContent>(layer.content) && !is_lit(layer) && !scene.backdrop;
}

/// What of a frame is not as it says.
std::vector<std::string> faults_of(const MatrixCell& cell, const GalleryEntry& entry) {
  const Verdict& verdict = cell.verdict;
  const RenderReport& report = cell.report;
  std::vector<std::string> faults;
  if (goes_to_cpu(report)) faults.push_back(report.device);
  if (!verdict.kept()) faults.push_back(verdict.text());
  const bool may_give_up = cell.grade == Grade::proved && entry.least_proved > 0;
  if (cell.tolerance >= entry.min_tolerance && !may_give_up && verdict.said_over != 0) {
    faults.push_back(std::to_string(verdict.said_over) +
                     " pixels say that they are over: " + verdict.text());
  }
  if (report.pixels_over_tolerance != static_cast<std::uint64_t>(verdict.said_over)) {
    faults.push_back("the report counts " + std::to_string(report.pixels_over_tolerance) +
                     " pixels over, the image " + std::to_string(verdict.said_over));
  }
  if (report.pixels_proved != static_cast<std::uint64_t>(verdict.proved)) {
    faults.push_back("the report counts " + std::to_string(report.pixels_proved) +
                     " proved pixels, the image " + std::to_string(verdict.proved));
  }
  // One of them was rounded to float.
  if (std::abs(report.largest_error - verdict.reported) > 1e-6 * verdict.reported) {
    faults.push_back("the report's largest error is " + std::to_string(report.largest_error) +
                     ", the image's " + std::to_string(verdict.reported));
  }
  return faults;
}

}  // namespace

DeviceRow check_on_device(const GalleryEntry& entry, const Exhibit& exhibit, std::size_t camera,
                          Device device, int size, const std::filesystem::path& cache) {
  MatrixOptions options;
  options.tolerances.assign(std::begin(quick_tolerances), std::end(quick_tolerances));
  options.size = size;
  options.sampling = false;
  options.least_proved = entry.least_proved;
  options.device = device;
  options.cache = cache;
  DeviceRow row;
  row.scene = entry.name;
  row.camera = exhibit.cameras[camera].name;
  const Scene scene = scene_of(exhibit, camera, options.size);
  if (!is_for_devices(scene)) {
    // The CPU's own matrix has these.
    RenderOptions one;
    one.machine.device = device;
    one.machine.threads = options.threads;
    RenderReport report;
    report = render(scene, one).report;
    if (!goes_to_cpu(report)) row.faults.push_back(row.camera + ": " + report.device);
    return row;
  }
  row.on_device = true;
  const MatrixRow matrix = measure_row(entry.name, exhibit, camera, options);
  if (!(matrix.brightest > 0)) row.faults.push_back(row.camera + ": there is nothing to see");
  for (const MatrixCell& cell : matrix.cells) {
    ++row.frames;
    row.pixels += matrix.pixels;
    row.in_double += cell.report.pixels_in_double;
    row.left += cell.report.pixels_left;
    row.over += static_cast<std::uint64_t>(cell.verdict.over);
    row.over_reported += static_cast<std::uint64_t>(cell.verdict.over_reported);
    for (const std::string& fault : faults_of(cell, entry)) {
      char tolerance[32];
      std::snprintf(tolerance, sizeof tolerance, "%g", cell.tolerance);
      row.faults.push_back(row.camera + ", " + grade_name(cell.grade) + ", tolerance " + tolerance +
                           ": " + fault);
    }
  }
  return row;
}

bool make_truth(const Exhibit& exhibit, std::size_t camera, int size,
                const std::filesystem::path& cache) {
  const Scene scene = scene_of(exhibit, camera, size);
  if (!is_for_devices(scene)) return false;
  cached_reference_frame(scene, 1, cache);
  return true;
}

}  // namespace pellucid::scenes

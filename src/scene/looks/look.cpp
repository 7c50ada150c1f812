// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/look.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "look_functions.h"
#include "mean_chord.h"
#include "message.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/value_noise.h"
#include "pellucid/scene/joint_histogram.h"
#include "pellucid/scene/labels.h"
#include "pellucid/scene/presets.h"
#include "value_sample.h"

namespace pellucid {
namespace {

constexpr LookName haze{"haze", "any data: the background clear, the rest transparent"};
constexpr LookName x_ray{"x-ray", "any data: density along the ray, as on a film"};
constexpr std::array<LookName, 11> all_looks{
    {{"ct", "CT in Hounsfield units: bone in light"},
     {"ct-skin", "CT in Hounsfield units: skin in light"},
     {"mr", "medical images in other units: tissue in light"},
     {"scan", "data with surfaces: material in light"},
     {"microscopy", "images: what is bright glows"},
     {"labels", "segmentations: a color for each label"},
     {"mask", "data of two values: the surface between them"},
     {"simulation", "smooth data: surfaces of equal value"},
     {"fog", "densities: white in light"},
     haze,
     x_ray}};
constexpr std::array<LookName, 3> mesh_looks{
    {{"body", "meshes: the values on and below the surface"}, haze, x_ray}};

/// Returns whether a name ends in one of these, whatever its case.
bool ends_in(const std::string& name, std::initializer_list<std::string_view> endings) {
  std::string lower = name;
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::any_of(endings, [&](std::string_view e) { return lower.ends_with(e); });
}

/// Contents of a folder by the names in it: images, or else a DICOM series. Of a file: none.
enum class FolderKind { none, images, series };
FolderKind folder_kind(const std::string& name) {
  std::error_code error;
  if (name.empty() || !std::filesystem::is_directory(name, error)) return FolderKind::none;
  for (const auto& entry : std::filesystem::directory_iterator(name, error)) {
    if (ends_in(entry.path().string(), {".tif", ".tiff", ".png"})) return FolderKind::images;
  }
  return FolderKind::series;
}

bool is_medical(const std::string& name, FolderKind folder) {
  return folder == FolderKind::series ||
         ends_in(name, {".nii", ".nii.gz", ".hdr", ".hdr.gz", ".img", ".img.gz", ".mgh", ".mgz",
                        ".mnc", ".dcm", ".ima"});
}

bool is_image(const std::string& name, FolderKind folder) {
  return folder == FolderKind::images || ends_in(name, {".tif", ".tiff", ".lsm", ".stk", ".png",
                                                        ".ome.zarr", ".zarr", ".companion.ome"});
}

/// Returns the share of sorted values that lie between two.
double share_between(const std::vector<double>& v, double lower, double upper) {
  const auto begin = std::ranges::lower_bound(v, lower), end = std::ranges::upper_bound(v, upper);
  return static_cast<double>(end - begin) / static_cast<double>(v.size());
}

/// Returns the value of air, if these are Hounsfield units, or those plus 1000 or 1024.
std::optional<double> air_of(const std::vector<double>& v, const VolumeStatistics& range) {
  if (v.empty()) return std::nullopt;
  constexpr double min_air = 0.05, most = 32767;
  if (range.minimum <= -500 && range.minimum >= -32768 && range.maximum >= 300 &&
      range.maximum <= most && share_between(v, -1100, -900) >= min_air) {
    return -1000;
  }
  // Twelve bits that begin at air, with soft tissue at about 1000 and hardly anything between the
  // two.
  if (range.minimum < 0 || range.minimum > 100 || range.maximum < 2000 || range.maximum > 8191 ||
      v.back() < 1300) {
    return std::nullopt;
  }
  const double air = share_between(v, 0, 150), tissue = share_between(v, 900, 1200);
  const double between = share_between(v, 300, 800);
  return air >= min_air && tissue >= 0.1 && 3 * between < tissue ? std::optional(24.0)
                                                                 : std::nullopt;
}

/// Returns whether neighbors differ less by noise than by what the data are.
bool is_smooth(const Volume& volume, const ClassedValues& of) {
  if (!of.differ) return true;
  const double threshold = of.threshold();
  const TransferFunction foreground({{threshold, 0, {}}, {threshold, 1, {}}});
  const TypicalNoise noise = volume.noise().where_absorbs(&foreground);
  return 4 * noise.deviation <= noise.median_gradient;
}

std::string chosen(const Volume& volume, const LookedAt& data, std::string& reason) {
  const auto because = [&](std::string_view name, std::string_view why) {
    reason = why;
    return std::string(name);
  };
  const std::string& name = volume.description().name;
  const std::vector<double>& v = data.values.values;
  // More than that are whole numbers that LabelVolume does not hold.
  constexpr double largest_label = 16777216;
  const VolumeStatistics& range = volume.statistics();
  const bool may_be_labels = std::max(-range.minimum, range.maximum) <= largest_label;
  if (const auto labels = may_be_labels ? label_count(volume) : std::nullopt) {
    return *labels > 2 ? because("labels", "whole numbers that look like labels")
                       : because("mask", "two values");
  }
  if (const auto air = air_of(v, volume.statistics())) {
    reason = *air == -1000 ? "values in Hounsfield units"
                           : "values that look like Hounsfield units plus 1024";
    return share_between(v, *air + 1250, v.back()) > 5e-4 ? "ct" : "ct-skin";
  }
  if (ends_in(name, {".vdb"})) return because("fog", "a density of OpenVDB");
  if (is_around_zero(data.values) &&
      (is_smooth(volume, data.values) || is_mostly_near_zero(data.values))) {
    return because("simulation", "values of both signs around 0");
  }
  const double share = 1 - static_cast<double>(data.values.classes.foreground) /
                               static_cast<double>(std::max(v.size(), std::size_t{1}));
  const FolderKind folder = folder_kind(name);
  const bool is_of_images = is_image(name, folder);
  constexpr double most_glowing = 0.2;
  if (is_of_images && data.values.differ && share < most_glowing) {
    return because("microscopy", "images of little on a dark ground");
  }
  if (has_surfaces(volume, data.values)) {
    return is_medical(name, folder) ? because("mr", "a medical image with surfaces")
                                    : because("scan", "data with surfaces");
  }
  if (is_of_images) return because("microscopy", "images without sharp surfaces");
  if (is_smooth(volume, data.values)) return because("simulation", "smooth data");
  return because("haze", "noisy data without surfaces");
}

/// Adds the look's name to what it is.
Look named(Look look, std::string name, std::string reason) {
  look.name = std::move(name);
  look.reason = std::move(reason);
  return look;
}

Look function_alone(TransferFunction function) {
  Look look;
  look.transfer_function = std::move(function);
  return look;
}

[[noreturn]] void refuse(std::string_view name, std::span<const LookName> looks,
                         std::string_view data) {
  std::string known;
  for (const LookName& each : looks) known += (known.empty() ? "" : ", ") + std::string(each.name);
  throw Error("look: \"" + std::string(name.substr(0, 64)) + "\" is none of " + std::string(data) +
              "; there are " + known);
}

Look made_look(const Volume& volume, std::string_view name) {
  const LookedAt data{ClassedValues(value_sample(volume)), mean_chord(volume), 1,
                      has_whole_numbers(volume)};
  std::string reason;
  std::string kind = name.empty() ? chosen(volume, data, reason) : std::string(name);
  const auto made = [&](Look look) { return named(std::move(look), kind, reason); };
  if (kind == "labels") {
    Look look;
    look.as_labels = true;
    return made(std::move(look));
  }
  if (kind == "ct" || kind == "ct-skin") {
    const auto air = air_of(data.values.values, volume.statistics());
    if (!air) check_hounsfield("look " + kind, volume.statistics());
    return made(ct_look(air.value_or(-1000), kind == "ct-skin", data.chord));
  }
  if (kind == "mr" || kind == "scan") return made(scan_look(data, kind == "mr"));
  if (kind == "microscopy") return made(microscopy_look(data));
  if (kind == "mask") {
    return made(mask_look(volume.statistics().minimum, volume.statistics().maximum));
  }
  if (kind == "simulation") return made(simulation_look(data));
  if (kind == "fog") return made(fog_look(data));
  if (kind == "haze") return made(function_alone(default_transfer_function(volume)));
  if (kind == "x-ray") return made(function_alone(make_preset("x-ray", volume)));
  refuse(name, all_looks, "a volume's");
}

Look made_look(const MeshChannels& mesh, std::string_view name) {
  if (name.empty() || name == "body") {
    const Box<double>& box = mesh.mesh().bounds();
    const Vec3<double> size = box.upper - box.lower;
    const double filled = mesh.mesh().statistics().volume / (size.x * size.y * size.z);
    const LookedAt data{ClassedValues(value_sample(mesh)), mean_chord(box), std::min(filled, 1.0),
                        false};
    return named(body_look(data), "body", name.empty() ? "a mesh" : "");
  }
  if (name == "haze") return named(function_alone(default_transfer_function(mesh)), "haze", "");
  if (name == "x-ray") return named(function_alone(make_preset("x-ray", mesh)), "x-ray", "");
  refuse(name, mesh_looks, "a mesh's");
}

template <class Data>
Look changed_look(const Data& data, std::string_view name, const FunctionChange& change) {
  Look look = made_look(data, name);
  if (change.is_none()) return look;
  if (look.as_labels && name.empty()) {
    look = made_look(data, "haze");
    look.reason = "a function to change";
  }
  const auto range = range_of(change, data);
  if (look.isosurfaces.empty()) {
    look.transfer_function = changed(look.transfer_function, change, range);
  } else {
    look.isosurfaces = changed(std::move(look.isosurfaces), change, range);
  }
  return look;
}

}  // namespace

std::span<const LookName> looks() noexcept {
  return all_looks;
}

std::span<const LookName> looks_of_meshes() noexcept {
  return mesh_looks;
}

Look choose_look(const Volume& volume, std::string_view name, const FunctionChange& change) {
  return changed_look(volume, name, change);
}

Look choose_look(const MeshChannels& mesh, std::string_view name, const FunctionChange& change) {
  return changed_look(mesh, name, change);
}

void check_hounsfield(const std::string& what, const VolumeStatistics& data) {
  constexpr double least = -150, most = 200;
  if (data.finite == 0 || (data.minimum < least && data.maximum > most)) return;
  throw Error(what + ": the data are " + number(data.minimum) + " to " + number(data.maximum) +
              ", but it is for Hounsfield units, with air at -1000; take another");
}

std::optional<double> hounsfield_air(const Volume& volume) {
  return air_of(value_sample(volume), volume.statistics());
}

std::vector<Light> look_lights(const Camera& camera) {
  const CameraAxes axes = camera_axes(camera);
  constexpr Rgb<double> half{0.6, 0.6, 0.6};
  Light head, key;
  head.color = half;
  key.color = half;
  // Three decimals, so that cameras that differ by rounding have one light.
  const auto short_number = [](double x) { return std::round(1000 * x) / 1000; };
  const Vec3<double> direction = axes.forward * 0.6 + axes.right * 0.55 - axes.up * 0.6;
  key.kind = DirectionalLight{
      {short_number(direction.x), short_number(direction.y), short_number(direction.z)}};
  return {head, key};
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
//
// What a scene leaves to its data, chosen from all steps of them.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "meshes/load_mesh_step.h"
#include "pellucid/io/film.h"
#include "scene/layer_functions.h"

namespace pellucid {
namespace {

/// Returns most_steps of the times at most, the first and the last among them.
std::vector<double> chosen(const std::vector<double>& times) {
  if (times.size() <= most_steps) return times;
  std::vector<double> made;
  for (std::size_t i = 0; i < most_steps; ++i) {
    made.push_back(times[i * (times.size() - 1) / (most_steps - 1)]);
  }
  return made;
}

/// Every second value of several volumes along each axis, one volume above the other, in the box of
/// the first: distributions and lengths are those of all, and so the functions made from them.
/// Every third or fourth value, and so on, of volumes so large that these would be more than half
/// of one.
class PooledVolume {
 public:
  explicit PooledVolume(std::size_t volumes) : volumes_(volumes) {}

  void add(const Volume& volume) {
    if (layers_ == 0) {
      description_ = volume.description();
      constexpr std::size_t always = std::size_t{1} << 21;
      const auto [nx, ny, nz] = description_.dimensions;
      const auto values = static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) *
                          static_cast<std::size_t>(nz);
      while (taken() > std::max(always, values / 2)) ++apart_;
      std::visit([&](const auto& of_type) { make_empty(of_type); }, volume.data());
    }
    std::visit([&](auto& pooled) { append(volume, pooled); }, values_);
  }

  Volume take() {
    const std::array<int, 3> whole = description_.dimensions;
    description_.coordinates = {};
    description_.dimensions = {taken(whole[0]), taken(whole[1]), layers_};
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      description_.placement.spacing[a] *=
          static_cast<double>(whole[axis]) / description_.dimensions[axis];
    }
    description_.centering = Centering::cell;
    return std::visit(
        [&](auto& values) {
          using Value = typename std::decay_t<decltype(values)>::value_type;
          return Volume(description_, VolumeData(DataArray<Value>(std::move(values))));
        },
        values_);
  }

 private:
  /// Returns how many of these values along an axis are taken.
  int taken(int values) const { return (values + apart_ - 1) / apart_; }
  /// Returns how many of all values are, if all volumes have the dimensions of the first.
  std::size_t taken() const {
    std::size_t product = volumes_;
    for (const int side : description_.dimensions) product *= static_cast<std::size_t>(taken(side));
    return product;
  }

  template <class Value>
  void make_empty(const DataArray<Value>&) {
    std::vector<Value> empty;
    empty.reserve(taken());
    values_ = std::move(empty);
  }

  template <class Value>
  void append(const Volume& volume, std::vector<Value>& pooled) {
    const auto [nx, ny, nz] = volume.description().dimensions;
    if (nx != description_.dimensions[0] || ny != description_.dimensions[1]) return;
    std::visit(
        [&](const auto& values) {
          for (int z = 0; z < nz; z += apart_, ++layers_) {
            for (int y = 0; y < ny; y += apart_) {
              const std::size_t row = (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) +
                                       static_cast<std::size_t>(y)) *
                                      static_cast<std::size_t>(nx);
              for (int x = 0; x < nx; x += apart_) {
                pooled.push_back(static_cast<Value>(values[row + static_cast<std::size_t>(x)]));
              }
            }
          }
        },
        volume.data());
  }

  std::size_t volumes_;
  Volume::Description description_;
  int apart_ = 2;  ///< distance of the values that are taken
  int layers_ = 0;
  std::variant<std::vector<std::uint8_t>, std::vector<std::int8_t>, std::vector<std::uint16_t>,
               std::vector<std::int16_t>, std::vector<std::uint32_t>, std::vector<std::int32_t>,
               std::vector<float>, std::vector<double>>
      values_;
};

/// Returns whether a layer leaves something to its data: which function, or where it lies.
bool leaves_open(const LayerDescription& layer) {
  if (layer.labels || layer.mask || !layer.channels.empty()) return false;
  if (layer.mesh && layer.mesh->channels.size() > 1) return false;
  if (!layer.transfer_function) return true;
  const auto* const preset = std::get_if<PresetDescription>(&*layer.transfer_function);
  return (preset != nullptr && !preset->range) || layer.function_change.range;
}

/// Writes a look as it was chosen into a description.
void write_look(Look look, LayerDescription& layer) {
  if (layer.look->chosen) layer.look->chosen(look);
  if (!layer.look->keeps_shading) layer.shading = look.shading;
  layer.isosurfaces = std::move(look.isosurfaces);
  layer.transfer_function = look.transfer_function.points();
  layer.look.reset();
  layer.function_change = {};
}

/// Returns whether there is something to be chosen. `of_first`: the look that the first step has,
/// of layers that take one.
bool choose(LayerDescription& layer, const std::optional<Look>& of_first, const Volume& pooled) {
  const FunctionChange& change = layer.function_change;
  if (of_first) {
    if (of_first->as_labels) return false;
    Look look = choose_look(pooled, of_first->name, change);
    look.reason = of_first->reason;
    write_look(std::move(look), layer);
    return true;
  }
  if (layer.transfer_function
          ? std::holds_alternative<OpacityTable>(*layer.transfer_function) ||
                std::holds_alternative<MultivariateDescription>(*layer.transfer_function)
          : layer.shows_surfaces()) {
    return false;
  }
  layer.transfer_function = changed(function_on(pooled, layer), change, pooled).points();
  layer.function_change = {};
  return true;
}

/// Lays the function of a mesh over the values of all steps: a mesh of all of them there is none.
/// `mesh` is that of the step before, and becomes that of this one.
void widen(std::array<double, 2>& range, const MeshSource& source,
           std::shared_ptr<const MeshChannels>& mesh, const ParallelFor& parallel) {
  mesh = load_mesh_step(source, mesh.get(), parallel).mesh;
  const VolumeStatistics& values = mesh->statistics(0);
  if (values.finite == 0) return;
  range = {std::min(range[0], values.minimum), std::max(range[1], values.maximum)};
}

}  // namespace

std::vector<std::size_t> choose_for_all_steps(SceneDescription& description,
                                              const SceneTimes& times, const ParallelFor& parallel,
                                              const std::function<bool()>& ended) {
  std::vector<std::size_t> changed_layers;
  for (std::size_t i = 0; i < description.layers.size(); ++i) {
    LayerDescription& layer = description.layers[i];
    const std::vector<double> steps = chosen(times.of(i));
    if (steps.size() < 2 || !leaves_open(layer)) continue;
    if (layer.mesh) {
      if (layer.function_change.range) continue;
      constexpr double infinity = std::numeric_limits<double>::infinity();
      std::array<double, 2> range{infinity, -infinity};
      MeshSource source = *layer.mesh;
      std::shared_ptr<const MeshChannels> mesh;
      for (const double step : steps) {
        if (ended && ended()) return {};
        source.options.time = step;
        widen(range, source, mesh, parallel);
      }
      if (!(range[0] < range[1])) continue;
      layer.function_change.range = RangeEnds{RangeEnd{range[0]}, RangeEnd{range[1]}};
      changed_layers.push_back(i);
      continue;
    }
    FieldSource source = layer.field;
    std::optional<Look> of_first;
    PooledVolume pooled(steps.size());
    for (const double step : steps) {
      if (ended && ended()) return {};
      source.options.time = step;
      const Volume volume = load_field(source);
      if (step == steps.front() && takes_look(layer)) of_first = look_of(volume, layer);
      pooled.add(volume);
    }
    if (choose(layer, of_first, pooled.take())) changed_layers.push_back(i);
  }
  return changed_layers;
}

}  // namespace pellucid

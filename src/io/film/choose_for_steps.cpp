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
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "meshes/load_mesh_step.h"
#include "pellucid/io/film.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/presets.h"
#include "scene/layer_functions.h"
#include "text/json_document.h"

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
    // Names of a binding are nothing that a lambda takes along.
    const auto& points = volume.description().dimensions;
    const int nx = points[0], ny = points[1], nz = points[2];
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

/// Returns whether a layer leaves something to its data: which function, or where it lies, or which
/// labels there are.
bool leaves_open(const LayerDescription& layer) {
  if (layer.labels) return layer.labels->styles.empty() && layer.labels->table.empty();
  if (layer.mask || !layer.channels.empty()) return false;
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

/// Gives a surface whose colors are a preset over the range of its data those over these data.
template <class Surface, class Data>
void write_colors(Surface& surface, const Data& data) {
  if (!surface.written_colors) return;
  const auto* const preset = std::get_if<PresetDescription>(surface.written_colors.get());
  if (preset == nullptr || preset->range) return;
  surface.colors =
      std::make_shared<const TransferFunction>(make_preset(preset->name, data, preset->range));
  surface.written_colors.reset();
}

/// Chooses the function of a layer without a look, and the colors of its surfaces. Data: a volume
/// or a mesh. Returns whether there is something to be chosen.
template <class Data>
bool choose_function(LayerDescription& layer, const Data& data) {
  const FunctionChange& change = layer.function_change;
  if (layer.transfer_function &&
      (std::holds_alternative<OpacityTable>(*layer.transfer_function) ||
       std::holds_alternative<MultivariateDescription>(*layer.transfer_function))) {
    return false;
  }
  layer.transfer_function = changed(function_on(data, layer), change, data).points();
  layer.function_change = {};
  for (Isosurface& surface : layer.isosurfaces) write_colors(surface, data);
  for (Slice& slice : layer.slices) write_colors(slice, data);
  return true;
}

/// The labels that occur at any of several steps.
class PooledLabels {
 public:
  /// Adds those of a volume. Throws Error if its values are no labels.
  void add(Volume volume) {
    const LabelVolume labels(std::make_shared<const Volume>(std::move(volume)));
    labels_.insert(labels.labels().begin(), labels.labels().end());
    if (!extinction_) extinction_ = default_label_extinction(labels.volume());
  }

  std::size_t size() const noexcept { return labels_.size(); }
  std::vector<LabelStyle> styles(std::optional<double> extinction) const {
    return default_label_table(std::vector<std::int32_t>(labels_.begin(), labels_.end()),
                               extinction.value_or(extinction_.value_or(1)))
        .styles();
  }

 private:
  std::set<std::int32_t> labels_;
  std::optional<double> extinction_;
};

/// Reader of the steps of one source.
class StepReader {
 public:
  StepReader(FieldSource source, const StepsAsked& asked)
      : source_(std::move(source)), asked_(asked) {}

  /// Calls visit(volume) with each of these steps that can be read: those that cannot matter once
  /// they are shown. Returns false where it was ended. Throws Error where none can be read.
  template <class Visit>
  bool visit(const std::vector<double>& steps, const Visit& visit) {
    std::size_t failed = 0;
    for (const double step : steps) {
      if (asked_.ended && asked_.ended()) return false;
      source_.options.time = step;
      std::optional<Volume> volume;
      try {
        volume.emplace(load_field(source_));
      } catch (const Error& error) {
        if (++failed == steps.size()) throw;
        if (asked_.note) {
          asked_.note("the step at time " + scene_json::number_text(step) +
                      " does not count for what is chosen for all: " + error.what());
        }
        continue;
      }
      visit(*std::move(volume));
    }
    return true;
  }

 private:
  FieldSource source_;
  const StepsAsked& asked_;
};

/// Returns whether a look is for values that may be labels.
bool is_of_labels(const Look& look) {
  return look.as_labels || look.name == "mask";
}

/// Returns the look that most of the steps have, the first of several. That of labels counts where
/// all steps have it: an initial condition has few values.
const Look& of_most(const std::vector<Look>& looks) {
  const bool are_labels = std::ranges::all_of(looks, is_of_labels);
  const Look* best = &looks.front();
  std::ptrdiff_t most = 0;
  for (const Look& look : looks) {
    if (is_of_labels(look) && !are_labels) continue;
    const std::ptrdiff_t count = std::ranges::count(looks, look.name, &Look::name);
    if (count > most) {
      most = count;
      best = &look;
    }
  }
  return *best;
}

/// Shows these labels.
void write_labels(const PooledLabels& labels, LayerDescription& layer) {
  show_as_labels(layer);
  layer.labels->styles = labels.styles(layer.labels->extinction);
}

/// Chooses the labels of a layer from all of these steps. Returns false where it was ended.
bool choose_labels(LayerDescription& layer, const std::vector<double>& steps,
                   const StepsAsked& asked) {
  PooledLabels labels;
  StepReader reader(layer.labels ? layer.labels->field : layer.field, asked);
  const auto add = [&](Volume volume) {
    try {
      labels.add(std::move(volume));
    } catch (const Error&) {
      // The picture of that step says it.
    }
  };
  if (!reader.visit(steps, add)) return false;
  write_labels(labels, layer);
  return true;
}

/// Outcome of a choice.
enum class Chosen { nothing, something, ended };

Chosen choose_of_volume(LayerDescription& layer, const std::vector<double>& all,
                        const StepsAsked& asked) {
  const auto as_labels = [&] {
    return choose_labels(layer, all, asked) ? Chosen::something : Chosen::ended;
  };
  if (layer.labels) return as_labels();
  const std::vector<double> steps = chosen(all);
  const bool has_look = takes_look(layer);
  std::vector<Look> looks;
  PooledVolume pooled(steps.size());
  std::optional<PooledLabels> labels(std::in_place);
  const bool is_whole = StepReader(layer.field, asked).visit(steps, [&](Volume volume) {
    if (has_look && (looks.empty() || layer.look->name.empty())) {
      looks.push_back(look_of(volume, layer));
      if (!is_of_labels(looks.back())) labels.reset();
    }
    pooled.add(volume);
    if (!has_look || !labels) return;
    try {
      labels->add(std::move(volume));
    } catch (const Error&) {
      labels.reset();  // two values that are no labels
    }
  });
  if (!is_whole) return Chosen::ended;
  if (!has_look) {
    return choose_function(layer, pooled.take()) ? Chosen::something : Chosen::nothing;
  }
  Look look = of_most(looks);
  const bool is_asked_for = !layer.look->name.empty();
  if (look.as_labels || (!is_asked_for && labels && labels->size() > 2)) {
    if (!look.as_labels) {
      look = Look();
      look.name = "labels";
      look.reason = "whole numbers that look like labels";
      look.as_labels = true;
    }
    if (layer.look->chosen) layer.look->chosen(look);
    layer.look.reset();
    if (!labels || steps.size() < all.size()) return as_labels();
    write_labels(*labels, layer);
    return Chosen::something;
  }
  Look of_all = choose_look(pooled.take(), look.name, layer.function_change);
  of_all.reason = look.reason;
  write_look(std::move(of_all), layer);
  return Chosen::something;
}

/// Chooses the function of a mesh on its first step, over the range of the values of all: a mesh of
/// all of them there is none.
Chosen choose_of_mesh(LayerDescription& layer, const std::vector<double>& steps,
                      const ParallelFor& parallel, const StepsAsked& asked) {
  MeshSource source = *layer.mesh;
  std::shared_ptr<const MeshChannels> first, mesh;
  const auto load = [&](double step) {
    source.options.time = step;
    mesh = load_mesh_step(source, mesh.get(), parallel).mesh;
    if (!first) first = mesh;
  };
  if (!layer.function_change.range) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 2> range{infinity, -infinity};
    for (const double step : steps) {
      if (asked.ended && asked.ended()) return Chosen::ended;
      load(step);
      const VolumeStatistics& values = mesh->statistics(0);
      if (values.finite == 0) continue;
      range = {std::min(range[0], values.minimum), std::max(range[1], values.maximum)};
    }
    if (!(range[0] < range[1])) return Chosen::nothing;
    layer.function_change.range = RangeEnds{RangeEnd{range[0]}, RangeEnd{range[1]}};
  }
  if (!first) load(steps.front());
  if (takes_look(layer)) {
    write_look(look_of(*first, layer), layer);
    return Chosen::something;
  }
  return choose_function(layer, *first) ? Chosen::something : Chosen::nothing;
}

}  // namespace

std::vector<std::size_t> choose_for_all_steps(SceneDescription& description,
                                              const SceneTimes& times, const ParallelFor& parallel,
                                              const StepsAsked& asked) {
  std::vector<std::size_t> changed_layers;
  for (std::size_t i = 0; i < description.layers.size(); ++i) {
    LayerDescription& layer = description.layers[i];
    const std::vector<double> steps = times.of(i);
    if (steps.size() < 2 || !leaves_open(layer)) continue;
    const Chosen found = layer.mesh ? choose_of_mesh(layer, chosen(steps), parallel, asked)
                                    : choose_of_volume(layer, steps, asked);
    if (found == Chosen::ended) return {};
    if (found == Chosen::something) changed_layers.push_back(i);
  }
  return changed_layers;
}

}  // namespace pellucid

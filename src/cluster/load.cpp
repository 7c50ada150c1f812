// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cluster/load.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "pellucid/cluster/render.h"
#include "pellucid/cluster/sub_scene.h"
#include "pellucid/geometry/box_around.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/checksum.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/box_corners.h"
#include "prepass.h"

namespace pellucid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Values of a grid that the first pass reads at once.
constexpr std::size_t values_at_once = std::size_t{1} << 24;

/// Calls visit(field) for each field of a layer of grids that is read from a file or built in.
template <class Visit>
void visit_fields(LayerDescription& layer, const Visit& visit) {
  if (layer.mesh) return;
  if (layer.labels) {
    visit(layer.labels->field);
    return;
  }
  if (layer.channels.empty()) visit(layer.field);
  for (ChannelSource& channel : layer.channels) {
    if (auto* const field = std::get_if<FieldSource>(&channel.source)) visit(*field);
  }
  if (layer.mask) visit(layer.mask->field);
}

/// Way in which the data of a layer come to the ranks.
struct LayerPlan {
  bool in_parts = false;
  Volume::Description description;  ///< of the grid, if in parts
  std::string whole_because;        ///< else, of a file
};

LayerPlan plan_of(LayerDescription layer) {
  LayerPlan plan;
  plan.in_parts = !layer.mesh;
  for (const ChannelSource& channel : layer_channels(layer)) {
    if (!std::holds_alternative<DerivedSource>(channel.source)) continue;
    plan.in_parts = false;
    plan.whole_because = "channels are derived from it";
  }
  if (!plan.in_parts) return plan;
  bool first = true;
  visit_fields(layer, [&](const FieldSource& field) {
    if (!field.builtin.empty()) {
      plan.in_parts = false;
      return;
    }
    const VolumeOutline outline = outline_volume(field.file, field.options);
    if (first) plan.description = outline.description;
    // Read whole, they are refused by what they are, and not by the part of a rank.
    if (outline.description.dimensions != plan.description.dimensions) {
      plan.in_parts = false;
      plan.whole_because = "its fields are not on one grid";
    }
    first = false;
    if (outline.reads_parts) return;
    plan.in_parts = false;
    plan.whole_because = field.file.string() + " is compressed, or of a format that is read whole";
  });
  return plan;
}

/// Throws Error where a layer has no look, for a default one is made of all of the data.
void check_functions(const SceneDescription& scene) {
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    const LayerDescription& layer = scene.layers[i];
    const bool has_look = layer.labels
                              ? !layer.labels->styles.empty() || !layer.labels->table.empty()
                              : layer.transfer_function || layer.shows_surfaces();
    if (has_look) continue;
    throw Error("ranks: layer " + std::to_string(i + 1) + " has no " +
                (layer.labels ? "looks of its labels" : "transfer function") +
                ", and no rank has all of its data to make one; give it ('pellucid render FILE "
                "--save-scene SCENE.json' writes one)");
  }
}

bool is_preset(const TransferFunctionDescription* function) {
  return function != nullptr && std::holds_alternative<PresetDescription>(*function);
}

/// Returns what of a layer's look is made of all of its data, for messages; empty: nothing.
std::string made_of_data(const LayerDescription& layer) {
  const auto* const function = layer.transfer_function ? &*layer.transfer_function : nullptr;
  if (is_preset(function)) return "a preset";
  if (layer.mask) {
    for (const MaskSource::Choice& choice : layer.mask->choices) {
      if (is_preset(&choice.transfer_function)) return "a preset in its mask";
    }
  }
  if (layer.function_change.range) {
    const auto& [least, most] = *layer.function_change.range;
    if (least.is_percent || most.is_percent) return "a range in percent";
  }
  if (layer.labels && !layer.labels->table.empty() && !layer.labels->extinction) {
    return "a table of labels without an extinction";
  }
  for (const Isosurface& surface : layer.isosurfaces) {
    if (is_preset(surface.written_colors.get())) return "an isosurface with the colors of a preset";
  }
  const bool is_of_one = function != nullptr && layer_channels(layer).empty();
  for (const Slice& slice : layer.slices) {
    if (is_preset(slice.written_colors.get())) return "a slice with the colors of a preset";
    if (!slice.colors && !slice.written_colors && !is_of_one) return "a slice without colors";
  }
  return "";
}

/// Returns a checksum of what ranks must have alike before they work together, without what
/// render() compares by name, and without paths, which may differ from machine to machine.
std::string checksum(SceneDescription scene, BrickBalance balance) {
  const bool has_camera = scene.camera.has_value();
  scene.camera.reset();
  scene.size = ImageSize{};
  scene.samples = 1;
  scene.integration.tolerance = default_tolerance;
  visit_paths(scene, [](std::filesystem::path& path) {
    if (!path.empty()) path = "file";
  });
  Checksum sum;
  sum.add(scene_to_json(scene));
  return std::to_string(sum.value()) + (has_camera ? " with" : " without") + " a camera" +
         (balance == BrickBalance::data ? ", balanced by data" : ", balanced by work");
}

class BrickLoader {
 public:
  BrickLoader(Communicator& ranks, const SceneDescription& description, const ParallelFor& parallel)
      : ranks_(ranks), description_(description), parallel_(parallel) {}

  BrickedScene load(BrickBalance balance) {
    agreed(ranks_, [&] { plan(); });
    std::string own;
    agreed(ranks_, [&] { own = checksum(description_, balance); });
    check_equal(ranks_, "the scene's checksum", own);
    check_equal(ranks_, "the size of the data", sizes());
    agreed(ranks_, [&] { load_whole(); });
    agreed(ranks_, [&] { find_frame(); });
    // Where the camera is given and bricks are equal, nobody asks where the data absorb.
    surveys_.resize(plans_.size());
    if (balance == BrickBalance::work || !description_.camera) survey();
    std::optional<BrickTree> tree;
    agreed(ranks_, [&] { tree.emplace(make_tree(balance)); });
    BrickedScene result{{}, *std::move(tree), {}, {}, {}, {}, {}};
    result.dimensions = dimensions();
    agreed(ranks_, [&] { load_parts(result.tree); });
    result.scene = make();
    result.visible = visible_;
    result.meshes = std::move(meshes_);
    result.notes = std::move(notes_);
    agree_on_ranges(ranks_, {}, result.scene);
    agreed(ranks_, [&] { check_data(result.scene); });
    result.nan = nan_values(ranks_, result.tree, result.scene);
    return result;
  }

 private:
  void plan() {
    check_functions(description_);
    layers_.resize(description_.layers.size());
    meshes_.resize(description_.layers.size());
    for (const LayerDescription& layer : description_.layers) {
      plans_.push_back(plan_of(layer));
      const std::string made = plans_.back().in_parts ? made_of_data(layer) : "";
      if (made.empty() || ranks_.size() == 1) continue;
      throw Error("ranks: layer " + std::to_string(plans_.size()) + " has " + made +
                  ", which is made of all of the data, and a rank has a part of them; give what "
                  "comes of it ('pellucid render FILE --save-scene SCENE.json' writes it)");
    }
  }

  std::vector<std::array<int, 3>> dimensions() const {
    std::vector<std::array<int, 3>> list;
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      const Volume* const grid = plans_[i].in_parts ? nullptr : grid_of(*layers_[i]);
      list.push_back(grid != nullptr ? grid->description().dimensions
                                     : plans_[i].description.dimensions);
    }
    return list;
  }

  std::string sizes() const {
    std::string text;
    for (const LayerPlan& plan : plans_) {
      for (const int side : plan.description.dimensions) text += std::to_string(side) + " ";
    }
    return text;
  }

  /// Reads one layer, or a part of each of its grids.
  Layer read(std::size_t index, const std::function<IndexBox(const Volume::Description&)>& part) {
    SceneDescription one = description_;
    one.layers = {description_.layers[index]};
    one.camera = Camera{};
    one.backdrop.clear();
    if (part) {
      visit_fields(one.layers[0], [&](FieldSource& field) { field.options.part = part; });
    }
    std::vector<MeshSource> mesh;
    Scene scene = make_scene(one, parallel_, &mesh);
    meshes_[index] = mesh[0];
    return std::move(scene.layers[0]);
  }

  void load_whole() {
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      if (plans_[i].in_parts) continue;
      layers_[i] = read(i, {});
      if (plans_[i].whole_because.empty() || ranks_.size() == 1) continue;
      notes_.push_back("each rank reads layer " + std::to_string(i + 1) +
                       " whole: " + plans_[i].whole_because);
    }
  }

  DataExtent extent(std::size_t index) const {
    const LayerDescription& layer = description_.layers[index];
    return plans_[index].in_parts ? extent_of(plans_[index].description, layer.transform)
                                  : extent_of(*layers_[index]);
  }

  /// Returns the layers that are seen; all if none is.
  std::vector<std::size_t> seen_layers() const {
    const bool any = std::ranges::any_of(description_.layers, &LayerDescription::visible);
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      if (!any || description_.layers[i].visible) seen.push_back(i);
    }
    return seen;
  }

  void find_frame() {
    std::vector<DataExtent> extents;
    for (const std::size_t i : seen_layers()) extents.push_back(extent(i));
    frame_ = frame_of(extents);
    const bool alone = extents.size() == 1 && plans_[seen_layers()[0]].in_parts;
    constexpr int max_cells = 64;
    for (std::size_t a = 0; a < 3; ++a) {
      cells_[a] =
          alone ? std::min(Survey::blocks_of(plans_[seen_layers()[0]].description)[a], max_cells)
                : max_cells / 2;
    }
  }

  /// Reads slabs of each grid that tells by its blocks where it absorbs.
  void survey() {
    for (const std::size_t i : seen_layers()) {
      if (!plans_[i].in_parts) continue;
      const Volume::Description& grid = plans_[i].description;
      const std::vector<SurveySlab> slabs =
          slabs_of(grid, ranks_.rank(), ranks_.size(), values_at_once);
      // Whether blocks tell, and the range of the values.
      std::vector<double> facts{1, infinity, infinity};
      agreed(ranks_, [&] {
        for (const SurveySlab& slab : slabs) {
          const Layer part = read_slab(i, slab);
          const VolumeStatistics& s = grid_of(part)->statistics();
          if (!tells_by_blocks(part)) facts[0] = 0;
          if (s.finite > 0) {
            facts[1] = std::min(facts[1], s.minimum);
            facts[2] = std::min(facts[2], -s.maximum);
          }
          // Where blocks have the values themselves, the range does not matter.
          if (facts[0] == 0 || has_short_values(*grid_of(part))) break;
        }
      });
      ranks_.reduce_all(facts, Communicator::Reduction::minimum);
      if (facts[0] == 0) continue;
      Survey found(grid, frame_from(i), frame_.bounds, cells_);
      agreed(ranks_, [&] {
        for (const SurveySlab& slab : slabs) {
          const Layer part = in_range(read_slab(i, slab), facts[1], -facts[2]);
          found.add(slab, absorbing_blocks(part, parallel_));
        }
      });
      found.join(ranks_);
      surveys_[i] = std::move(found);
    }
  }

  Layer read_slab(std::size_t index, const SurveySlab& slab) {
    return read(index, [&](const Volume::Description&) { return slab.values; });
  }

  static bool has_short_values(const Volume& volume) {
    return std::visit(
        [](const auto& values) {
          using Value = typename std::decay_t<decltype(values)>::value_type;
          return sizeof(Value) <= 2;
        },
        volume.data());
  }

  /// Blocks have the codes that they have in the whole.
  static Layer in_range(const Layer& layer, double minimum, double maximum) {
    Layer result = layer;
    if (!(minimum <= maximum) || has_short_values(*grid_of(layer))) return result;
    const auto whole = std::make_shared<const Volume>(grid_of(layer)->as_part_of(minimum, maximum));
    if (auto* const volume = std::get_if<VolumeContent>(&result.content)) volume->volume = whole;
    if (auto* const labels = std::get_if<LabelContent>(&result.content)) {
      labels->labels = std::make_shared<const LabelVolume>(whole);
    }
    return result;
  }

  /// Returns the map to the frame from a grid.
  Affine<double> frame_from(std::size_t index) const {
    const Affine<double> frame_from_world = inverse(frame_.world_from_frame);
    const Affine<double> map = extent(index).world_from_data;
    Affine<double> frame_from_grid;
    for (int a = 0; a < 3; ++a) {
      frame_from_grid.matrix.column[a] = frame_from_world.vector(map.matrix.column[a]);
    }
    frame_from_grid.translation = frame_from_world.point(map.translation);
    return frame_from_grid;
  }

  BrickTree make_tree(BrickBalance balance) {
    std::vector<std::array<Vec3<double>, 8>> seen;
    for (const std::size_t i : seen_layers()) seen.push_back(seen_corners(i));
    visible_ = around(seen);
    BrickWeights weights;
    Vec3<double> view{0, 0, 0};
    if (balance == BrickBalance::work) {
      weights = weights_in_frame();
      const Camera seen_by = camera();
      view = seen_by.focal_point - seen_by.position;
    }
    return BrickTree::split(frame_.world_from_frame, frame_.bounds, ranks_.size(), weights,
                            frame_.on_grid, view);
  }

  std::array<Vec3<double>, 8> seen_corners(std::size_t index) const {
    if (!plans_[index].in_parts) return visible_corners(*layers_[index], parallel_);
    const DataExtent data = extent(index);
    if (surveys_[index]) {
      const auto corners = surveys_[index]->corners(data.world_from_data);
      if (corners) return *corners;
    }
    return box_corners(data.box, data.world_from_data);
  }

  /// Returns the corners that visible_corners() of a scene has: the box of the only layer, or one
  /// along the axes.
  static std::array<Vec3<double>, 8> around(const std::vector<std::array<Vec3<double>, 8>>& boxes) {
    if (boxes.size() == 1) return boxes[0];
    auto whole = empty_box<double>();
    for (const auto& box : boxes) {
      for (const Vec3<double>& corner : box) include(whole, corner);
    }
    return box_corners(whole);
  }

  BrickWeights weights_in_frame() const {
    BrickWeights weights{cells_, {}};
    if (std::ranges::none_of(surveys_, [](const auto& survey) { return survey.has_value(); })) {
      return {};
    }
    weights.weight.assign(static_cast<std::size_t>(cells_[0]) *
                              static_cast<std::size_t>(cells_[1]) *
                              static_cast<std::size_t>(cells_[2]),
                          0);
    for (const std::optional<Survey>& survey : surveys_) {
      if (survey) survey->add_to(weights);
    }
    return weights;
  }

  void load_parts(const BrickTree& tree) {
    const int rank = ranks_.rank();
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      if (!plans_[i].in_parts) {
        layers_[i] = sub_layer(*layers_[i], tree, rank);
        continue;
      }
      const Affine<double>& transform = description_.layers[i].transform;
      layers_[i] = read(i, [&](const Volume::Description& grid) {
        return indices_of_brick(grid, transform, tree, rank);
      });
    }
  }

  Camera camera() const {
    return description_.camera ? *description_.camera : default_camera(visible_, description_.size);
  }

  Scene make() {
    Scene scene;
    for (std::optional<Layer>& layer : layers_) scene.layers.push_back(*std::move(layer));
    static_cast<SceneSettings&>(scene) = description_;
    scene.camera = camera();
    agreed(ranks_, [&] {
      if (!description_.backdrop.empty()) {
        scene.backdrop = std::make_shared<const Image>(read_exr(description_.backdrop));
      }
      fit_opacity_tables(description_, scene);
    });
    return scene;
  }

  Communicator& ranks_;
  const SceneDescription& description_;
  const ParallelFor& parallel_;
  std::vector<LayerPlan> plans_;
  std::vector<std::optional<Layer>> layers_;
  std::vector<std::optional<Survey>> surveys_;
  std::vector<MeshSource> meshes_;
  std::vector<std::string> notes_;
  SceneFrame frame_;
  std::array<int, 3> cells_{};  ///< of weights
  std::array<Vec3<double>, 8> visible_{};
};

}  // namespace

BrickedScene load_bricks(Communicator& ranks, const SceneDescription& description,
                         BrickBalance balance, const ParallelFor& parallel) {
  return BrickLoader(ranks, description, parallel).load(balance);
}

}  // namespace pellucid

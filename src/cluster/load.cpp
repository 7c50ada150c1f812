// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cluster/load.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "pellucid/cluster/render.h"
#include "pellucid/cluster/sub_scene.h"
#include "pellucid/io/image_files.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "survey.h"

namespace pellucid {
namespace {

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

/// How the data of a layer come to the ranks.
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
    first = false;
    if (outline.reads_parts) return;
    plan.in_parts = false;
    plan.whole_because = field.file.string() + " is compressed, or of a format that is read whole";
  });
  return plan;
}

/// A default function is made of all of the data.
void check_functions(const SceneDescription& scene) {
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    const LayerDescription& layer = scene.layers[i];
    const bool has_look = layer.labels ? !layer.labels->styles.empty() || !layer.labels->table.empty()
                                       : layer.transfer_function || layer.shows_surfaces();
    if (has_look) continue;
    throw Error("ranks: layer " + std::to_string(i + 1) + " has no " +
                (layer.labels ? "looks of its labels" : "transfer function") +
                ", and no rank has all of its data to make one; give it ('pellucid render FILE "
                "--save-scene SCENE.json' writes one)");
  }
}

class BrickLoader {
 public:
  BrickLoader(Communicator& ranks, const SceneDescription& description, const ParallelFor& parallel)
      : ranks_(ranks), description_(description), parallel_(parallel) {}

  BrickedScene load(BrickBalance balance) {
    agreed(ranks_, [&] { plan(); });
    check_equal(ranks_, "the size of the data", sizes());
    agreed(ranks_, [&] { load_whole(); });
    survey();
    BrickedScene result{{}, make_tree(balance), {}, {}, {}};
    agreed(ranks_, [&] { load_parts(result.tree); });
    result.scene = make();
    result.visible = visible_;
    result.meshes = std::move(meshes_);
    result.notes = std::move(notes_);
    agree_on_ranges(ranks_, {}, result.scene);
    agreed(ranks_, [&] { check_data(result.scene); });
    return result;
  }

 private:
  void plan() {
    check_functions(description_);
    layers_.resize(description_.layers.size());
    meshes_.resize(description_.layers.size());
    for (const LayerDescription& layer : description_.layers) plans_.push_back(plan_of(layer));
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
      notes_.push_back("each rank reads layer " + std::to_string(i + 1) + " whole: " +
                       plans_[i].whole_because);
    }
  }

  DataExtent extent(std::size_t index) const {
    const LayerDescription& layer = description_.layers[index];
    return plans_[index].in_parts ? extent_of(plans_[index].description, layer.transform)
                                  : extent_of(*layers_[index]);
  }

  /// Reads a slab of each grid that tells by its blocks where it absorbs.
  void survey() {
    surveys_.resize(plans_.size());
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      if (!plans_[i].in_parts || !description_.layers[i].visible) continue;
      const Volume::Description& grid = plans_[i].description;
      const SurveySlab slab = slab_of(grid, ranks_.rank(), ranks_.size());
      std::vector<double> range{1, std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::infinity()};
      std::optional<Layer> part;
      agreed(ranks_, [&] {
        if (slab.empty()) return;
        part = read(i, [&](const Volume::Description&) { return slab.values; });
        range[0] = tells_by_blocks(*part) ? 1 : 0;
        const VolumeStatistics& s = grid_of(*part)->statistics();
        if (s.finite > 0) range = {range[0], s.minimum, -s.maximum};
      });
      ranks_.reduce_all(range, Communicator::Reduction::minimum);
      if (range[0] == 0) continue;
      AbsorbingBlocks blocks;
      agreed(ranks_, [&] {
        if (part) blocks = absorbing_blocks(in_range(*part, range[1], -range[2]), parallel_);
      });
      surveys_[i] = join(ranks_, grid, slab, blocks);
    }
  }

  /// Blocks have the codes that they have in the whole.
  static Layer in_range(const Layer& layer, double minimum, double maximum) {
    Layer result = layer;
    if (!(minimum <= maximum)) return result;
    const auto whole = std::make_shared<const Volume>(grid_of(layer)->as_part_of(minimum, maximum));
    if (auto* const volume = std::get_if<VolumeContent>(&result.content)) volume->volume = whole;
    if (auto* const labels = std::get_if<LabelContent>(&result.content)) {
      labels->labels = std::make_shared<const LabelVolume>(whole);
    }
    return result;
  }

  BrickTree make_tree(BrickBalance balance) {
    std::vector<DataExtent> extents;
    std::vector<std::array<Vec3<double>, 8>> seen;
    const bool any = std::ranges::any_of(description_.layers, &LayerDescription::visible);
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      if (any && !description_.layers[i].visible) continue;
      extents.push_back(extent(i));
      seen.push_back(seen_corners(i));
    }
    visible_ = around(seen);
    const SceneFrame frame = frame_of(extents);
    BrickWeights weights;
    if (balance == BrickBalance::work) weights = weights_in(frame);
    return BrickTree::split(frame.world_from_frame, frame.bounds, ranks_.size(), weights,
                            frame.on_grid);
  }

  std::array<Vec3<double>, 8> seen_corners(std::size_t index) const {
    if (!plans_[index].in_parts) return visible_corners(*layers_[index], parallel_);
    const DataExtent data = extent(index);
    if (surveys_[index]) {
      const auto corners =
          corners_of(*surveys_[index], plans_[index].description, data.world_from_data);
      if (corners) return *corners;
    }
    std::array<Vec3<double>, 8> corners;
    for (unsigned n = 0; n < 8; ++n) {
      corners[n] = data.world_from_data.point(
          {(n & 1) != 0 ? data.box.upper.x : data.box.lower.x,
           (n & 2) != 0 ? data.box.upper.y : data.box.lower.y,
           (n & 4) != 0 ? data.box.upper.z : data.box.lower.z});
    }
    return corners;
  }

  /// As visible_corners() of a scene: the box of the only layer, or one along the axes.
  static std::array<Vec3<double>, 8> around(const std::vector<std::array<Vec3<double>, 8>>& boxes) {
    if (boxes.size() == 1) return boxes[0];
    Vec3<double> lower = boxes[0][0], upper = lower;
    for (const auto& box : boxes) {
      for (const Vec3<double>& corner : box) {
        for (int a = 0; a < 3; ++a) {
          lower[a] = std::min(lower[a], corner[a]);
          upper[a] = std::max(upper[a], corner[a]);
        }
      }
    }
    std::array<Vec3<double>, 8> corners{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (int a = 0; a < 3; ++a) corners[i][a] = (i >> a & 1) != 0 ? upper[a] : lower[a];
    }
    return corners;
  }

  BrickWeights weights_in(const SceneFrame& frame) const {
    constexpr int most_cells = 64;
    BrickWeights weights{{most_cells / 2, most_cells / 2, most_cells / 2}, {}};
    const bool alone = surveys_.size() == 1 && surveys_[0].has_value();
    for (std::size_t a = 0; a < 3; ++a) {
      if (alone) weights.cells[a] = std::min(surveys_[0]->count[a], most_cells);
    }
    weights.weight.assign(static_cast<std::size_t>(weights.cells[0]) *
                              static_cast<std::size_t>(weights.cells[1]) *
                              static_cast<std::size_t>(weights.cells[2]),
                          0);
    bool any = false;
    const Affine<double> frame_from_world = inverse(frame.world_from_frame);
    for (std::size_t i = 0; i < surveys_.size(); ++i) {
      if (!surveys_[i]) continue;
      any = true;
      const Affine<double> map = extent(i).world_from_data;
      Affine<double> frame_from_grid;
      for (int a = 0; a < 3; ++a) {
        frame_from_grid.matrix.column[a] = frame_from_world.vector(map.matrix.column[a]);
      }
      frame_from_grid.translation = frame_from_world.point(map.translation);
      add_weights(*surveys_[i], plans_[i].description, frame_from_grid, frame.bounds, weights);
    }
    return any ? weights : BrickWeights{};
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

  Scene make() {
    Scene scene;
    for (std::optional<Layer>& layer : layers_) scene.layers.push_back(*std::move(layer));
    scene.clips = description_.clips;
    scene.lights = description_.lights;
    scene.size = description_.size;
    scene.samples = description_.samples;
    scene.camera =
        description_.camera ? *description_.camera : default_camera(visible_, description_.size);
    scene.integration = description_.integration;
    scene.background = description_.background;
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
  std::array<Vec3<double>, 8> visible_{};
};

}  // namespace

BrickedScene load_bricks(Communicator& ranks, const SceneDescription& description,
                         BrickBalance balance, const ParallelFor& parallel) {
  return BrickLoader(ranks, description, parallel).load(balance);
}

}  // namespace pellucid

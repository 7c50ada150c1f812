// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/layer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "enum_names.h"
#include "layer_light.h"
#include "message.h"
#include "moved_source.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/absorbing_blocks.h"
#include "pellucid/scene/internal/box_corners.h"

namespace pellucid {
namespace {

template <class... Bodies>
struct Overloaded : Bodies... {
  using Bodies::operator()...;
};
template <class... Bodies>
Overloaded(Bodies...) -> Overloaded<Bodies...>;

/// Calls body(function) for each piecewise-linear function that the layer's data are shown by.
template <class Body>
void for_each_table(const Layer& layer, const Body& body) {
  std::visit(Overloaded{[&](const VolumeContent& content) {
                          body(*content.transfer_function);
                          if (!content.mask) return;
                          for (const LabelMask::Choice& choice : content.mask->choices()) {
                            body(*choice.transfer_function);
                          }
                        },
                        [](const ChannelsContent&) {},
                        [&](const LabelContent& content) { body(content.table->function()); },
                        // A mesh or a field of one's own.
                        [&](const auto& content) {
                          if (content.univariate() != nullptr) body(*content.univariate());
                        }},
             layer.content);
}

const MultivariateTransferFunction* multivariate_of(const Layer& layer) noexcept {
  if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    return channels->transfer_function.get();
  }
  if (const auto* source = std::get_if<SourceContent>(&layer.content)) {
    return source->multivariate();
  }
  const auto* mesh = std::get_if<MeshContent>(&layer.content);
  return mesh != nullptr ? mesh->multivariate() : nullptr;
}

/// Checks a layer; messages begin with its place in the scene.
class LayerCheck {
 public:
  explicit LayerCheck(const std::string& where) : where_(where) {}

  void operator()(const VolumeContent& content) const {
    require(content.volume, content.transfer_function, "a volume", "a transfer function");
    if (!content.mask) return;
    try {
      Channels(
          {{"data", "", content.volume}, {"mask", "", content.mask->labels().shared_volume()}});
    } catch (const Error& error) {
      fail("the mask is not on the grid of the data: " + std::string(error.what()));
    }
  }
  void operator()(const ChannelsContent& content) const {
    require(content.channels, content.transfer_function, "channels", "a multivariate function");
    count(*content.transfer_function, content.channels->count());
  }
  void operator()(const MeshContent& content) const {
    check(content.mesh, content, "a mesh", "the mesh has ", " channels");
  }
  void operator()(const LabelContent& content) const {
    require(content.labels, content.table, "labels", "a table of colors");
  }
  void operator()(const SourceContent& content) const {
    check(content.source, content, "a source", "the source has ", " variables");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(where_ + ": " + what); }

  template <class Data, class Content>
  void check(const Data& data, const Content& content, const char* name, const char* it_has,
             const char* variables) const {
    if (!data || (content.univariate() == nullptr && content.multivariate() == nullptr)) {
      require(data, nullptr, name, "a transfer function");
    }
    if (content.multivariate() != nullptr) {
      count(*content.multivariate(), data->count());
    } else if (data->count() != 1) {
      fail("the transfer function sees one variable, but " + std::string(it_has) +
           std::to_string(data->count()) + variables + "; leave one of them");
    }
  }
  template <class Data, class Function>
  void require(const Data& data, const Function& function, const char* name,
               const char* function_name) const {
    if (data != nullptr && function != nullptr) return;
    fail(std::string(name) + " and " + function_name + " are needed; set both before rendering");
  }
  void count(const MultivariateTransferFunction& function, int channels) const {
    if (function.channels() == channels) return;
    fail("the transfer function sees " + std::to_string(function.channels()) +
         " channels, but there are " + std::to_string(channels) + "; make it for as many");
  }

  const std::string& where_;
};

void check_projection(const Layer& layer, const std::string& where) {
  if (!layer.projection) return;
  const auto refuse = [&](const char* why) {
    throw Error(where + ": the projection " + std::string(projection_name(*layer.projection)) +
                " is of one variable, but the layer has " + why);
  };
  if (std::holds_alternative<LabelContent>(layer.content)) refuse("labels; leave it out");
  if (std::holds_alternative<SourceContent>(layer.content)) {
    throw Error(where + ": the projection " + std::string(projection_name(*layer.projection)) +
                " is of grids and meshes, but the layer has a stretch source; leave it out");
  }
  if (multivariate_of(layer) != nullptr) {
    refuse("a function of several; give a field or one array with a function of one");
  }
  const auto* const volume = std::get_if<VolumeContent>(&layer.content);
  if (volume != nullptr && volume->mask) refuse("a mask; leave one of the two out");
}

void check_transform(const Layer& layer, const std::string& where) {
  const Mat3<double>& m = layer.transform.matrix;
  const auto refuse = [&](const Vec3<double>& v) {
    throw Error(where + ": transform has the column " + tuple(v) +
                ", but all of its numbers must be finite");
  };
  for (const Vec3<double>& v :
       {m.column[0], m.column[1], m.column[2], layer.transform.translation}) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) refuse(v);
  }
  // As for the direction of a grid, in any unit of length: below it, positions keep fewer than half
  // of a double's digits.
  Mat3<double> unit;
  for (int a = 0; a < 3; ++a) {
    const Vec3<double>& v = m.column[a];
    const double length = std::hypot(v.x, v.y, v.z);
    unit.column[a] = {v.x / length, v.y / length, v.z / length};
  }
  if (!(std::abs(determinant(unit)) > std::sqrt(std::numeric_limits<double>::epsilon()))) {
    throw Error(where + ": transform is singular; its columns must be three independent axes");
  }
}

std::shared_ptr<const Volume> moved(const Volume& volume, const Affine<double>& transform) {
  return std::make_shared<const Volume>(volume.moved(transform));
}

std::shared_ptr<const LabelVolume> moved(const LabelVolume& labels,
                                         const Affine<double>& transform) {
  return std::make_shared<const LabelVolume>(labels.moved(transform));
}

std::shared_ptr<const MeshChannels> moved(const MeshChannels& channels,
                                          const Affine<double>& transform) {
  const TetrahedralMesh& mesh = channels.mesh();
  TetrahedralMesh::Description description;
  description.name = mesh.name();
  description.points.reserve(mesh.points().size());
  for (const Vec3<double>& point : mesh.points()) {
    description.points.push_back(transform.point(point));
  }
  description.tetrahedra.reserve(mesh.tetrahedra().size());
  for (const Tetrahedron& t : mesh.tetrahedra()) {
    description.tetrahedra.push_back({t[0], t[1], t[2], t[3]});
  }
  for (std::size_t i = 0; i < mesh.points().size(); ++i) {
    description.point_numbers.push_back(mesh.point_number(i));
  }
  return std::make_shared<const MeshChannels>(
      std::make_shared<const TetrahedralMesh>(std::move(description)),
      std::vector<MeshChannel>(channels.begin(), channels.end()));
}

}  // namespace

const ChannelTransferFunction* extinction_factor_of(const Layer& layer) noexcept {
  const MultivariateTransferFunction* const function = multivariate_of(layer);
  return function != nullptr ? function->factor() : nullptr;
}

std::string_view projection_name(LayerProjection projection) noexcept {
  return name_of(projection_names, projection);
}

std::optional<LayerProjection> projection_from_name(std::string_view name) noexcept {
  return value_of<LayerProjection>(projection_names, name);
}

const TransferFunction* univariate_in(const AnyTransferFunction& function) noexcept {
  const auto* own = std::get_if<std::shared_ptr<const TransferFunction>>(&function);
  return own != nullptr ? own->get() : nullptr;
}

const MultivariateTransferFunction* multivariate_in(const AnyTransferFunction& function) noexcept {
  const auto* own = std::get_if<std::shared_ptr<const MultivariateTransferFunction>>(&function);
  return own != nullptr ? own->get() : nullptr;
}

bool is_in_place(const Layer& layer) noexcept {
  const Affine<double> identity;
  for (int a = 0; a < 3; ++a) {
    if (layer.transform.matrix.column[a] != identity.matrix.column[a]) return false;
  }
  return layer.transform.translation == Vec3<double>{};
}

Layer moved_into_place(const Layer& layer) {
  if (is_in_place(layer)) return layer;
  check_transform(layer, layer.name.empty() ? "layer" : "layer \"" + layer.name + "\"");
  Layer result = layer;
  result.transform = {};
  const Affine<double>& to = layer.transform;
  std::visit(
      Overloaded{
          [&](VolumeContent& content) {
            content.volume = moved(*content.volume, to);
            if (!content.mask) return;
            content.mask = std::make_shared<const LabelMask>(moved(content.mask->labels(), to),
                                                             content.mask->choices());
          },
          [&](ChannelsContent& content) {
            std::vector<Channel> channels(content.channels->begin(), content.channels->end());
            for (Channel& channel : channels) channel.volume = moved(*channel.volume, to);
            content.channels = std::make_shared<const Channels>(std::move(channels));
          },
          [&](MeshContent& content) { content.mesh = moved(*content.mesh, to); },
          [&](LabelContent& content) { content.labels = moved(*content.labels, to); },
          [&](SourceContent& content) { content.source = moved_source(content.source, to); }},
      result.content);
  return result;
}

void check_layer(const Layer& layer, const std::string& where) {
  std::visit(LayerCheck(where), layer.content);
  check_transform(layer, where);
  check_projection(layer, where);
  check_light_of(layer, where);
  for (std::size_t i = 0; i < layer.clips.size(); ++i) {
    check_clip(layer.clips[i], where + ": clip " + std::to_string(i + 1));
  }
}

const Volume* grid_of(const Layer& layer) noexcept {
  return std::visit(
      Overloaded{[](const VolumeContent& content) { return content.volume.get(); },
                 [](const ChannelsContent& content) { return &content.channels->grid(); },
                 [](const LabelContent& content) { return &content.labels->volume(); },
                 [](const auto&) -> const Volume* { return nullptr; }},
      layer.content);
}

namespace {

/// Returns the box of what is not on a grid, in its own world.
const Box<double>& box_of(const Layer& layer) noexcept {
  const auto* const source = std::get_if<SourceContent>(&layer.content);
  return source != nullptr ? source->source->description().bounds
                           : std::get<MeshContent>(layer.content).mesh->mesh().bounds();
}

}  // namespace

std::array<Vec3<double>, 8> world_corners(const Layer& layer) noexcept {
  const Volume* const grid = grid_of(layer);
  std::array<Vec3<double>, 8> corners =
      grid != nullptr ? grid->world_corners() : box_corners(box_of(layer));
  for (Vec3<double>& corner : corners) corner = layer.transform.point(corner);
  return corners;
}

namespace {

/// Returns whether a function of the layer absorbs at some value from `lower` to `upper`, or an
/// isosurface has one.
bool absorbs_between(const Layer& layer, double lower, double upper) {
  bool absorbs = std::ranges::any_of(layer.isosurfaces, [&](const Isosurface& surface) {
    return lower <= surface.value && surface.value <= upper;
  });
  for_each_table(layer, [&](const TransferFunction& function) {
    const PiecewiseLinear<double> table = function.view<double>();
    absorbs = absorbs || table.has_extinction(table.interval(lower), table.interval(upper));
  });
  return absorbs;
}

}  // namespace

bool tells_by_blocks(const Layer& layer) noexcept {
  return grid_of(layer) != nullptr && !layer.projection && multivariate_of(layer) == nullptr &&
         layer.slices.empty();
}

AbsorbingBlocks absorbing_blocks(const Layer& layer, const ParallelFor& parallel) {
  const BlockRecords& records = grid_of(layer)->block_records(parallel);
  AbsorbingBlocks blocks{
      {records.axis[0].cells(), records.axis[1].cells(), records.axis[2].cells()}, {}};
  blocks.absorbs.reserve(static_cast<std::size_t>(records.count()));
  for (int block = 0; block < records.count(); ++block) {
    const BlockRange range = records.range(block);
    const bool absorbs =
        range.vacuum != BlockVacuum::all && absorbs_between(layer, range.min, range.max);
    blocks.absorbs.push_back(absorbs ? 1 : 0);
  }
  return blocks;
}

std::array<Vec3<double>, 8> visible_corners(const Layer& layer, const ParallelFor& parallel) {
  if (!tells_by_blocks(layer)) return world_corners(layer);
  const Volume* const grid = grid_of(layer);
  const BlockRecords& records = grid->block_records(parallel);
  const AbsorbingBlocks blocks = absorbing_blocks(layer, parallel);
  std::array<int, 3> first{}, last{-1, -1, -1};
  for (int k = 0; k < blocks.count[2]; ++k) {
    for (int j = 0; j < blocks.count[1]; ++j) {
      for (int i = 0; i < blocks.count[0]; ++i) {
        if (blocks.absorbs[static_cast<std::size_t>(records.index(i, j, k))] == 0) continue;
        const std::array<int, 3> block{i, j, k};
        const bool is_first = last[0] < 0;
        for (std::size_t a = 0; a < 3; ++a) {
          first[a] = is_first ? block[a] : std::min(first[a], block[a]);
          last[a] = std::max(last[a], block[a]);
        }
      }
    }
  }
  if (last[0] < 0) return world_corners(layer);
  std::array<Vec3<double>, 8> corners{};
  for (std::size_t n = 0; n < corners.size(); ++n) {
    Vec3<double> place;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      place[a] = records.axis[a].plane((n >> axis & 1) != 0 ? last[axis] + 1 : first[axis]);
    }
    corners[n] = layer.transform.point(grid->world_from_grid().point(place));
  }
  return corners;
}

double largest_color(const Layer& layer) noexcept {
  const MultivariateTransferFunction* const multivariate = multivariate_of(layer);
  double largest = largest_surface_color(layer);
  if (multivariate != nullptr) largest = std::max(largest, multivariate->largest_color());
  for_each_table(layer, [&](const TransferFunction& function) {
    largest = std::max(largest, function.largest_color());
  });
  return largest;
}

double largest_extinction(const Layer& layer) noexcept {
  const MultivariateTransferFunction* const multivariate = multivariate_of(layer);
  double largest = multivariate != nullptr ? multivariate->largest_extinction() : 0;
  for_each_table(layer, [&](const TransferFunction& function) {
    for (const auto& point : function.points()) largest = std::max(largest, point.extinction);
  });
  return layer.gradient_opacity ? largest * layer.gradient_opacity->largest_factor() : largest;
}

double approximation_error(const Layer& layer, double behind, const std::vector<Light>& lights) {
  double largest = 0;
  // Where a mask chooses, the functions lie one behind the other; so do a medium and its surfaces.
  const auto* const volume = std::get_if<VolumeContent>(&layer.content);
  const bool several = (volume != nullptr && volume->mask) || has_surfaces(layer);
  const double brightest =
      several || layer.shading ? std::max(behind, largest_color(layer, lights)) : behind;
  const double factor = brightest_factor(layer, lights);
  for_each_table(layer, [&](const TransferFunction& function) {
    if (layer.projection) {
      const double opacity = std::min(std::expm1(2 * function.relative_error()), 1.0);
      largest =
          opacity * (function.largest_color() + std::max(behind, 1.0)) + function.color_error();
      return;
    }
    largest = std::max(largest, factor * function.approximation_error(brightest));
  });
  if (const ChannelTransferFunction* const by = extinction_factor_of(layer)) {
    // What bounds the logarithm of the factor's ratio bounds that of the extinction's.
    const double off = by->function.relative_error();
    const TransferFunction whole({{0, 1, {1, 1, 1}}}, off);
    const double colors = std::max({largest_color(layer), brightest, 1.0});
    largest = std::max(largest, factor * whole.approximation_error(colors));
  }
  return largest + (has_surfaces(layer) ? surface_color_error(layer, lights) : 0);
}

}  // namespace pellucid

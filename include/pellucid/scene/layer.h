// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "pellucid/geometry/affine.h"
#include "pellucid/scene/channels.h"
#include "pellucid/scene/clip.h"
#include "pellucid/scene/label_volume.h"
#include "pellucid/scene/light.h"
#include "pellucid/scene/mesh_channels.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/scene/stretch_source.h"
#include "pellucid/scene/surfaces.h"
#include "pellucid/scene/transfer_function.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// A scalar field with a transfer function.
struct VolumeContent {
  std::shared_ptr<const Volume> volume;
  std::shared_ptr<const TransferFunction> transfer_function;
  /// Labels on the same grid that choose another function; may be null.
  std::shared_ptr<const LabelMask> mask{};

  bool operator==(const VolumeContent&) const = default;  ///< true for the same objects
};

/// Several fields on one grid with a function of all of them.
struct ChannelsContent {
  std::shared_ptr<const Channels> channels;
  std::shared_ptr<const MultivariateTransferFunction> transfer_function;

  bool operator==(const ChannelsContent&) const = default;  ///< true for the same objects
};

/// A function of one variable or of several.
using AnyTransferFunction = std::variant<std::shared_ptr<const TransferFunction>,
                                         std::shared_ptr<const MultivariateTransferFunction>>;
/// Returns the function of one variable; null if it is of several, or missing.
const TransferFunction* univariate_in(const AnyTransferFunction& function) noexcept;
/// Returns the function of several variables; null if it is of one, or missing.
const MultivariateTransferFunction* multivariate_in(const AnyTransferFunction& function) noexcept;

/// One or several variables on a mesh, with a function of one or of all of them.
struct MeshContent {
  std::shared_ptr<const MeshChannels> mesh;
  AnyTransferFunction transfer_function;

  const TransferFunction* univariate() const noexcept { return univariate_in(transfer_function); }
  const MultivariateTransferFunction* multivariate() const noexcept {
    return multivariate_in(transfer_function);
  }

  bool operator==(const MeshContent&) const = default;  ///< true for the same objects
};

/// A field of one's own, with a function of one or of all of its variables. Its layer has no
/// projection, and a transform of one with gradient opacity keeps angles. Devices, ranks, reference
/// pictures and scene files do not take it.
struct SourceContent {
  std::shared_ptr<const StretchSource> source;
  AnyTransferFunction transfer_function;

  const TransferFunction* univariate() const noexcept { return univariate_in(transfer_function); }
  const MultivariateTransferFunction* multivariate() const noexcept {
    return multivariate_in(transfer_function);
  }

  bool operator==(const SourceContent&) const = default;  ///< true for the same objects
};

/// A segmentation with the look of its labels.
struct LabelContent {
  std::shared_ptr<const LabelVolume> labels;
  std::shared_ptr<const LabelTable> table;

  bool operator==(const LabelContent&) const = default;  ///< true for the same objects
};

using LayerContent =
    std::variant<VolumeContent, ChannelsContent, MeshContent, LabelContent, SourceContent>;

/// Number that a projected layer shows for a ray, from the reconstructed field where the layer has
/// data that its clips keep. `mean` and `sum` are ∫ v ds by world length; mean divides it by the
/// length of these parts.
enum class LayerProjection { maximum, minimum, mean, sum };
/// Names of the projections as in scene files.
inline constexpr const char* projection_names[] = {"maximum", "minimum", "mean", "sum"};
/// Returns the name of a projection as in scene files.
std::string_view projection_name(LayerProjection projection) noexcept;
/// Returns the projection of this name, or none.
std::optional<LayerProjection> projection_from_name(std::string_view name) noexcept;

/// An object of a scene: a value, or one that others hold as well.
template <class Object>
struct Shared {
  Shared(Object value) : object(std::make_shared<const Object>(std::move(value))) {}
  Shared(std::shared_ptr<const Object> shared) noexcept : object(std::move(shared)) {}
  Shared(std::shared_ptr<Object> shared) noexcept : object(std::move(shared)) {}

  std::shared_ptr<const Object> object;
};

/// One kind of data with its look and its place in a scene.
struct Layer {
  Layer() = default;
  Layer(LayerContent wanted) : content(std::move(wanted)) {}
  /// Makes a layer of a volume with the look of the kind of data that it seems to be: function,
  /// shading, surfaces or labels of choose_look().
  explicit Layer(Shared<Volume> volume);
  /// Makes a layer of a mesh with its look, likewise.
  explicit Layer(Shared<MeshChannels> mesh);
  Layer(Shared<Volume> volume, Shared<TransferFunction> function);
  Layer(Shared<Channels> channels, Shared<MultivariateTransferFunction> function);
  Layer(Shared<MeshChannels> mesh, Shared<TransferFunction> function);
  Layer(Shared<MeshChannels> mesh, Shared<MultivariateTransferFunction> function);
  Layer(Shared<LabelVolume> labels, Shared<LabelTable> table);

  LayerContent content;
  std::string name{};
  bool visible = true;
  Affine<double> transform{};  ///< to the scene's world from the world of the data
  std::vector<Clip> clips{};   ///< in the scene's world; what all of them keep is shown
  /// Shows one number per ray through the transfer function, instead of the integral: its color at
  /// that number, with the opacity extinction / largest extinction. A ray without data is
  /// transparent. Such layers have no depth: they lie over the integral of all other layers, later
  /// ones of the list over earlier ones. For one variable without a mask.
  std::optional<LayerProjection> projection{};
  /// Reflection of the scene's lights by the layer and its surfaces; none: they glow in their own
  /// colors. Not for labels.
  std::optional<Shading> shading{};
  /// Multiplies the extinction of the layer's functions; may be null. Not for labels, nor beside
  /// the factor of a function of several variables.
  std::shared_ptr<const GradientOpacity> gradient_opacity{};
  std::vector<Isosurface> isosurfaces{};  ///< not of labels
  std::vector<Slice> slices{};            ///< not of labels
};

/// Returns whether the layer's transform is the identity.
bool is_in_place(const Layer& layer) noexcept;
/// Returns the layer with its transform applied to the data, which are shared where that is
/// possible: grids are moved, the points of meshes are copied and rounded to double. Throws Error
/// if the transform is singular or moves the data beyond the range of numbers.
Layer moved_into_place(const Layer& layer);

/// Throws Error unless the layer has data and a function for as many variables, its clips and its
/// transform pass their checks, and a projection suits its data. `where` begins the message, e.g.
/// "layer 2".
void check_layer(const Layer& layer, const std::string& where);

/// Returns the factor of the layer's function of several variables; null: there is none.
const ChannelTransferFunction* extinction_factor_of(const Layer& layer) noexcept;
/// Returns whether the layer has light, gradient opacity, a factor of the extinction, isosurfaces
/// or slices: what only the general path does.
bool is_lit(const Layer& layer) noexcept;
/// Returns whether the layer has isosurfaces or slices.
bool has_surfaces(const Layer& layer) noexcept;
/// Returns the number of variables per point.
int channels_of(const Layer& layer) noexcept;
/// Returns the size of a voxel of a layer in its place, in world units: the mean of the three edges
/// of a mean cell of the grid; of a mesh the edge of a cube of six mean tetrahedra; what a field of
/// one's own gives.
double voxel_of(const Layer& layer) noexcept;
/// Returns the gradient at which the squared normal in the layer's medium is a half: g0 of Shading,
/// in data units per world length. The layer is in its place and has a shading. What the shading
/// gives counts; else, of the data of the shading's channel,
///
///   g0 = max(min(5/2 · σ / voxel, g / 4), 1/50 · range / side)
///
/// with voxel_of(), the mean `side` of the data's box, and where the layer's function absorbs, by
/// its extinction (value_noise.h): the standard deviation σ of the noise between neighboring
/// values, and the gradient g that a fiftieth exceeds. Meshes and fields of one's own have the last
/// term alone.
double flat_gradient(const Layer& layer);
/// Returns the same for surfaces: 0, unless the shading gives a flatness.
double flat_gradient_of_surfaces(const Layer& layer) noexcept;
/// Returns the volume whose gradient lights the layer, which has a shading; null where it has none.
const Volume* lit_volume(const Layer& layer) noexcept;

/// Returns the volume whose grid the rays cross; null for a mesh and a field of one's own.
const Volume* grid_of(const Layer& layer) noexcept;
/// Returns the corners of a box around the data in the scene's world: the grid's own box, or for a
/// mesh or a field of one's own a box along the axes of its world.
std::array<Vec3<double>, 8> world_corners(const Layer& layer) noexcept;
/// Returns the corners of a box around what absorbs, for a camera that looks at it: of grids the
/// blocks of 8³ cells in which the function absorbs at some value that occurs; of channels, meshes,
/// fields of one's own, grids without such a block and projected layers those of world_corners().
/// Computes the block records of grids, in parallel if `parallel` is given.
std::array<Vec3<double>, 8> visible_corners(const Layer& layer, const ParallelFor& parallel = {});
/// Returns the largest color component of the layer's functions and surfaces, without light.
double largest_color(const Layer& layer) noexcept;
/// Returns the same in the light of `lights`.
double largest_color(const Layer& layer, const std::vector<Light>& lights) noexcept;
/// Returns the largest extinction of the layer's functions, with its gradient opacity.
double largest_extinction(const Layer& layer) noexcept;
/// Returns an upper bound on the error of a pixel because the layer's functions approximate others
/// (TransferFunction::approximation_error()). `behind`: the largest component of the color behind
/// the layer. With |ln(τ̂/τ)| <= ρ everywhere, the opacity τ / max τ of a projected layer is off by
/// at most the factor e^(2ρ). Light makes colors brighter, and their errors.
double approximation_error(const Layer& layer, double behind,
                           const std::vector<Light>& lights = {});

}  // namespace pellucid

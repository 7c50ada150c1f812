// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "layer_appearance.h"
#include "pellucid/render/integrate_cell.h"
#include "pellucid/scene/layer.h"
#include "pellucid/scene/stretch_source.h"
#include "pellucid/transfer/multivariate.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// A stretch of a ray on which all channels of a layer are cubics, or the layer is absent. Of
/// layers that need them (LayerAppearance) it has gradients; the magnitude is the argument of their
/// factor.
struct LayerStretch : FieldStretch {
  int function = -1;        ///< index of LayerSource::functions(); -1: absent
  PrimitiveSet primitives;  ///< of the function: those that may matter
  double left_out = 0;      ///< upper bound on the extinction of what is ignored here
  double unknown = 0;       ///< upper bound on an opacity in front of it that is not known

  /// The kind of what is told: data and gradients; of cells(), `cell` alone, which holds the
  /// stretch; or that it is a run of cells, which are to be found.
  enum class Kind { curves, cell, run };
  Kind kind = Kind::curves;
  StructuredWalk<double>::Step cell{};
};

/// The stretches of one layer along rays, one ray after the other, which do not reach out of the
/// range. Used by one thread.
using LayerStream = BasicStretchStream<LayerStretch>;

class LayerPoints;

/// A layer as rays need it: its functions and, for each thread, a stream.
class LayerSource {
 public:
  /// The layer must outlive the source.
  explicit LayerSource(const Layer& layer)
      : look_(layer), most_extinction_(largest_extinction(layer)) {}
  LayerSource(const LayerSource&) = delete;
  LayerSource& operator=(const LayerSource&) = delete;
  virtual ~LayerSource() = default;

  /// Returns the functions that its stretches refer to.
  const std::vector<MultivariateTransfer<double>>& functions() const noexcept { return functions_; }
  /// `by_cells`: stretches may tell cells of cells() alone (LayerStretch::Kind).
  virtual std::unique_ptr<LayerStream> stream(bool by_cells) const = 0;
  /// Returns its points, for methods that sample: those of its stretches, unless the data tell them
  /// in less time.
  virtual std::unique_ptr<LayerPoints> sampled_points() const;
  /// Returns the uniform grid whose cells its stretches can tell, with a variable's values; null:
  /// none.
  virtual const Volume* cells(int variable = 0) const noexcept {
    static_cast<void>(variable);
    return nullptr;
  }
  const LayerAppearance& look() const noexcept { return look_; }
  double most_extinction() const noexcept { return most_extinction_; }

 protected:
  std::vector<MultivariateTransfer<double>> functions_;

 private:
  LayerAppearance look_;
  double most_extinction_;
};

/// Parameters of a layer's source.
struct LayerTask {
  const Layer& layer;  ///< in its place; must outlive the source
  RayTolerance wanted;
  /// Extinction that the layer may ignore all along a ray.
  double negligible_extinction = 0;
  ParallelFor parallel;
};

/// Makes the source of a layer of any kind.
std::unique_ptr<const LayerSource> make_layer_source(const LayerTask& task);

// By kind of data:
std::unique_ptr<const LayerSource> make_volume_source(const LayerTask& task);
std::unique_ptr<const LayerSource> make_channels_source(const LayerTask& task);
std::unique_ptr<const LayerSource> make_mesh_source(const LayerTask& task);
std::unique_ptr<const LayerSource> make_label_source(const LayerTask& task);
std::unique_ptr<const LayerSource> make_own_source(const LayerTask& task);

/// A table as a function of one channel.
inline MultivariateTransfer<double> transfer_of(const ChannelTable<double>& table) {
  MultivariateTransfer<double> transfer;
  transfer.table = &table;
  transfer.tables = 1;
  return transfer;
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>

#include "grid_gradient.h"
#include "grid_stream.h"
#include "label_axes.h"
#include "pellucid/render/integrate_multivariate_ray.h"
#include "pellucid/scene/block_classes_storage.h"
#include "pellucid/scene/multivariate_blocks_storage.h"
#include "pellucid/scene/transfer_tables_storage.h"
#include "plane_doubt.h"

namespace pellucid {
namespace {

/// Blocks that all functions skip, where labels choose among several.
void skip_only_where_both_do(std::vector<BlockClass>& classes, const BlockClasses& other) {
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const BlockClass& second = other[static_cast<int>(i)];
    if (classes[i].kind != BlockKind::skip) continue;
    if (second.kind != BlockKind::skip) {
      classes[i] = second;
    } else {
      classes[i].level = std::min(classes[i].level, second.level);
    }
  }
}

/// Lets the blocks be visited in which a channel has the value of an isosurface.
void visit_isosurfaces(std::vector<BlockClass>& classes, const BlockRecords& records, int channel,
                       const LayerLook& look, const LayerTask& task) {
  const auto function = isosurface_support(look, channel, 0);
  if (!function) return;
  const TransferTablesStorage tables(*function);
  const BlockClassesStorage found(records, tables.tables(), 1, task.parallel);
  skip_only_where_both_do(classes, found.view());
}

/// The gradients of a grid that a layer's light and gradient opacity need.
class GridGradients {
 public:
  /// `volume_of(channel)` returns a volume.
  template <class VolumeOf>
  GridGradients(const LayerLook& look, const VolumeOf& volume_of) {
    if (const auto& shading = look.layer().shading) {
      gradient_.emplace(volume_of(shading->channel), shading->gradient);
    }
    if (const auto& factors = look.layer().gradient_opacity) {
      magnitude_.emplace(volume_of(factors->channel()), GradientKind::smooth);
    }
  }
  /// `axis`: that of the walk.
  void fill(const StructuredWalk<double>::Step& step, const GridAxis<double> (&axis)[3],
            const PlaneDoubt& planes, LayerStretch& stretch) const {
    if (gradient_) {
      gradient_->along(step, stretch.gradient);
      stretch.gradient_doubt = gradient_->doubt(step, axis, planes, stretch.gradient);
    }
    if (magnitude_) stretch.magnitude = magnitude_->magnitude_along(step);
  }

 private:
  std::optional<GridGradient> gradient_, magnitude_;
};

/// A volume with one function, or with a mask that chooses among several.
class VolumeSource : public LayerSource {
 public:
  explicit VolumeSource(const LayerTask& task)
      : LayerSource(task.layer),
        content_(std::get<VolumeContent>(task.layer.content)),
        channels_({{"value", "", content_.volume}}),
        grid_(multichannel_grid(channels_)),
        records_(content_.volume->block_records(task.parallel)),
        gradients_(look(), [&](int) -> const Volume& { return *content_.volume; }) {
    add(*content_.transfer_function, task);
    if (content_.mask) {
      labels_.emplace(content_.mask->labels().volume());
      for (const LabelMask::Choice& choice : content_.mask->choices()) {
        add(*choice.transfer_function, task);
      }
    }
    visit_isosurfaces(classes_, records_, 0, look(), task);
  }

  std::unique_ptr<LayerStream> stream() const override;

  /// Returns the function of the label cell.
  int function_at(const int (&cell)[3]) const {
    const double label = labels_->value(cell);
    return std::isnan(label) ? 0 : content_.mask->choice_of(static_cast<std::int32_t>(label)) + 1;
  }
  const LabelAxes* labels() const { return labels_ ? &*labels_ : nullptr; }
  const MultichannelGrid& grid() const { return grid_; }
  const GridGradients& gradients() const { return gradients_; }

 private:
  void add(const TransferFunction& function, const LayerTask& task) {
    const TransferTablesStorage tables(function);
    const BlockClassesStorage classes(records_, tables.tables(),
                                      std::max(task.wanted.largest_color, 1.0), task.parallel);
    const auto count = static_cast<std::size_t>(records_.count());
    if (functions_.empty()) {
      classes_.assign(classes.view().block, classes.view().block + count);
    } else {
      skip_only_where_both_do(classes_, classes.view());
    }
    tables_.push_back({0, function.view<double>()});
    functions_.push_back(transfer_of(tables_.back()));
  }

  const VolumeContent& content_;
  Channels channels_;
  MultichannelGrid grid_;
  const BlockRecords& records_;
  GridGradients gradients_;
  std::vector<BlockClass> classes_;
  std::deque<ChannelTable<double>> tables_;  ///< addresses stay
  std::optional<LabelAxes> labels_;
};

/// The cells of a grid as stretches, cut at the cells of a mask.
class VolumeStream : public GridStream {
 public:
  VolumeStream(const VolumeSource& source, const Volume& volume, const BlockRecords& records,
               const BlockClass* classes)
      : GridStream(volume, source.grid().axis, records, classes, source.look().slices(), false),
        source_(source) {}

  Interval<double> start(const Ray<double>& ray) override {
    if (source_.labels() != nullptr) sides_.start(grid_from_world(), ray);
    return GridStream::start(ray);
  }
  void restrict_to_range(Interval<double> range) override {
    GridStream::restrict_to_range(range);
    labels_.reset();
  }

  bool next(LayerStretch& stretch) override {
    for (;;) {
      if (labels_) {
        StructuredWalk<double>::Step part;
        if (labels_->next(part)) {
          cut(part, stretch);
          return true;
        }
        labels_.reset();
      }
      StructuredWalk<double>::Step step;
      int block = 0;
      bool skipped = false;
      if (!next_cell(step, block, skipped)) return false;
      if (skipped || !make_multivariate_span(source_.grid(), step, span_)) continue;
      stretch.begin = begin_ = step.t_begin;
      stretch.end = end_ = step.t_end;
      stretch.position_error = grid_position_error(step.t_end);
      source_.gradients().fill(step, source_.grid().axis, planes(),
                               source_.labels() == nullptr ? stretch : whole_);
      if (source_.labels() == nullptr) {
        stretch.function = 0;
        stretch.data[0] = span_.data[0];
        return true;
      }
      labels_.emplace(source_.labels()->axis(), ray(), Interval<double>{begin_, end_});
    }
  }

 private:
  void cut(const StructuredWalk<double>::Step& part, LayerStretch& stretch) {
    const double length = end_ - begin_;
    stretch.begin = part.t_begin;
    stretch.end = part.t_end;
    stretch.function = source_.function_at(part.cell);
    stretch.position_error =
        std::max(2 * grid_position_error(part.t_end), sides_.position_error(part));
    sides_.for_each_other_cell(source_.labels()->axis(), part, [&](const int(&cell)[3]) {
      if (source_.function_at(cell) != stretch.function) {
        stretch.left_out = source_.most_extinction();
      }
    });
    const double from = (part.t_begin - begin_) / length, to = (part.t_end - begin_) / length;
    stretch.data[0] = restrict_to(span_.data[0], from, to);
    if (!source_.look().is_lit()) return;
    stretch.gradient_doubt = whole_.gradient_doubt;
    for (int a = 0; a < 3; ++a) stretch.gradient[a] = restrict_to(whole_.gradient[a], from, to);
    stretch.magnitude = restrict_to(whole_.magnitude, from, to);
  }

  const VolumeSource& source_;
  PlaneDoubt sides_;
  MultivariateSpan<double> span_;
  double begin_ = 0, end_ = 0;  ///< of the cell
  LayerStretch whole_;          ///< the gradients in it
  std::optional<StructuredWalk<double>> labels_;
};

std::unique_ptr<LayerStream> VolumeSource::stream() const {
  return std::make_unique<VolumeStream>(*this, *content_.volume, records_, classes_.data());
}

/// Several channels with a function of all of them.
class ChannelsSource : public LayerSource {
 public:
  explicit ChannelsSource(const LayerTask& task)
      : LayerSource(task.layer),
        channels_(*std::get<ChannelsContent>(task.layer.content).channels),
        grid_(multichannel_grid(channels_)),
        storage_(channels_, *std::get<ChannelsContent>(task.layer.content).transfer_function,
                 task.negligible_extinction, task.parallel),
        blocks_(storage_.view()),
        gradients_(look(), [&](int c) -> const Volume& { return *channels_[c].volume; }) {
    functions_.push_back(std::get<ChannelsContent>(task.layer.content).transfer_function->view());
    if (look().isosurfaces().empty()) return;
    const auto count = static_cast<std::size_t>(blocks_.records.count());
    classes_.assign(blocks_.classes.block, blocks_.classes.block + count);
    for (int c = 0; c < channels_.count(); ++c) {
      visit_isosurfaces(classes_, channels_[c].volume->block_records(task.parallel), c, look(),
                        task);
    }
  }

  std::unique_ptr<LayerStream> stream() const override;

  const MultichannelGrid& grid() const { return grid_; }
  const MultivariateBlocks& blocks() const { return blocks_; }
  const BlockClass* classes() const {
    return classes_.empty() ? blocks_.classes.block : classes_.data();
  }
  const GridGradients& gradients() const { return gradients_; }

 private:
  const Channels& channels_;
  MultichannelGrid grid_;
  MultivariateBlocksStorage storage_;
  MultivariateBlocks blocks_;
  std::vector<BlockClass> classes_;  ///< with those of isosurfaces; empty: those of blocks_
  GridGradients gradients_;
};

class ChannelsStream : public GridStream {
 public:
  ChannelsStream(const ChannelsSource& source, const Volume& volume)
      : GridStream(volume, source.grid().axis, source.blocks().records, source.classes(),
                   source.look().slices(), true),
        source_(source) {}

  bool next(LayerStretch& stretch) override {
    StructuredWalk<double>::Step step;
    int block = 0;
    bool skipped = false;
    while (next_cell(step, block, skipped)) {
      stretch.begin = step.t_begin;
      stretch.end = step.t_end;
      stretch.left_out = source_.blocks().left_out;
      stretch.position_error = grid_position_error(step.t_end);
      if (skipped) {
        stretch.function = -1;
        return true;
      }
      MultivariateSpan<double> span;
      if (!make_multivariate_span(source_.grid(), step, span)) continue;
      stretch.function = 0;
      stretch.primitives = source_.blocks().primitives[block];
      std::copy_n(span.data, source_.grid().channels, stretch.data);
      source_.gradients().fill(step, source_.grid().axis, planes(), stretch);
      if (const ChannelTransferFunction* const factor = source_.look().value_factor()) {
        stretch.magnitude = source_.look().factor_argument(span.data[factor->channel]);
      }
      return true;
    }
    return false;
  }

 private:
  const ChannelsSource& source_;
};

std::unique_ptr<LayerStream> ChannelsSource::stream() const {
  return std::make_unique<ChannelsStream>(*this, channels_.grid());
}

}  // namespace

std::unique_ptr<const LayerSource> make_volume_source(const LayerTask& task) {
  return std::make_unique<VolumeSource>(task);
}

std::unique_ptr<const LayerSource> make_channels_source(const LayerTask& task) {
  return std::make_unique<ChannelsSource>(task);
}

}  // namespace pellucid

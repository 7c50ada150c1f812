// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

#include "grid_gradient.h"
#include "grid_points.h"
#include "grid_stream.h"
#include "layers/plane_ambiguity.h"
#include "packet_setup.h"
#include "pellucid/render/integrate_multivariate_ray.h"
#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/scene/internal/label_axes.h"
#include "pellucid/scene/internal/multivariate_blocks_storage.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"

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
                       const LayerAppearance& look, const LayerTask& task) {
  const auto function = isosurface_support(look, channel, 0);
  if (!function) return;
  const TransferTablesStorage tables(*function);
  const BlockClassesStorage found(records, tables.tables(), 1, task.parallel);
  skip_only_where_both_do(classes, found.view());
}

/// Returns whether binary32 can count the cells along each axis.
bool fits_walks(const GridAxis<double> (&axis)[3]) {
  return std::ranges::all_of(axis, [](const auto& one) { return one.cells() < 1 << 23; });
}

/// The gradients of a grid that a layer's light and gradient opacity need.
class GridGradients {
 public:
  /// Makes the gradients that the layer needs. `volume_of(channel)` returns a volume.
  template <class VolumeOf>
  GridGradients(const LayerAppearance& look, const VolumeOf& volume_of) {
    if (const auto& shading = look.layer().shading) {
      gradient_.emplace(volume_of(shading->channel), shading->gradient);
    }
    if (const auto& factors = look.layer().gradient_opacity) {
      magnitude_.emplace(volume_of(factors->channel()), GradientKind::smooth);
    }
  }
  /// Fills in gradient, its error and magnitude of a stretch. `axis`: that of the walk.
  void fill(const StructuredWalk<double>::Step& step, const GridAxis<double> (&axis)[3],
            const PlaneAmbiguity& planes, LayerStretch& stretch) const {
    if (gradient_) {
      gradient_->along(step, stretch.gradient);
      stretch.gradient_error = gradient_->doubt(step, axis, planes, stretch.gradient);
    }
    if (magnitude_) stretch.magnitude = magnitude_->magnitude_along(step);
  }
  /// Computes what is needed at a place.
  void find(LayerPoint& point) const {
    if (gradient_) point.gradient = gradient_->at(point.place);
    if (magnitude_) point.factor_argument = magnitude_->magnitude_at(point.place);
  }
  /// Returns whether gradients are the same on both sides of a plane between cells.
  bool are_continuous() const { return !gradient_ || gradient_->kind() == GradientKind::smooth; }
  /// Returns whether the gradient of a step may be that of another cell.
  bool is_doubtful(const StructuredWalk<double>::Step& step, const GridAxis<double> (&axis)[3],
                   const PlaneAmbiguity& planes) const {
    return gradient_ && gradient_->is_doubtful(step, axis, planes);
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
      for (std::int32_t label = 0; label < common_labels; ++label) {
        function_of_.push_back(content_.mask->choice_of(label) + 1);
      }
    }
    visit_isosurfaces(classes_, records_, 0, look(), task);
    // Surfaces are looked for in the data. Lanes know gradients of uniform grids alone.
    in_cells_ = !look().has_surfaces() && fits_single(*content_.volume) &&
                suits_lanes(*content_.volume, most_extinction()) &&
                (!look().is_lit() || is_uniform(*content_.volume));
    in_runs_ = in_cells_ && fits_walks(grid_.axis);
  }

  std::unique_ptr<LayerStream> stream(bool by_cells) const override;
  std::unique_ptr<LayerPoints> sampled_points() const override;
  const Volume* cells(int /*variable*/) const noexcept override {
    return in_cells_ ? content_.volume.get() : nullptr;
  }

  /// Returns the function of the label cell.
  int function_at(const int (&cell)[3]) const {
    const double label = labels_->value(cell);
    if (label >= 0 && label < static_cast<double>(function_of_.size())) {
      return function_of_[static_cast<std::size_t>(label)];
    }
    return std::isnan(label) ? 0 : content_.mask->choice_of(static_cast<std::int32_t>(label)) + 1;
  }
  const LabelAxes* labels() const { return labels_ ? &*labels_ : nullptr; }
  const MultichannelGrid& grid() const { return grid_; }
  const GridGradients& gradients() const { return gradients_; }
  /// Returns whether stretches can be runs of cells.
  bool in_runs() const { return in_runs_; }

 private:
  /// Labels whose functions are looked up without a search.
  static constexpr std::int32_t common_labels = 1024;

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
  std::vector<int> function_of_;  ///< of labels from 0 on
  bool in_cells_ = false, in_runs_ = false;
};

/// The cells of a grid as stretches, cut at the cells of a mask.
class VolumeStream : public GridStream {
 public:
  VolumeStream(const VolumeSource& source, const Volume& volume, const BlockRecords& records,
               const BlockClass* classes, bool by_cells)
      : GridStream(volume, source.grid().axis, records, classes, source.look().slices(), false),
        source_(source),
        by_cells_(by_cells) {}

  Interval<double> start(const Ray<double>& ray) override {
    if (source_.labels() != nullptr) sides_.start(grid_from_world(), ray);
    const Interval<double> inside = GridStream::start(ray);
    in_runs_ =
        by_cells_ && source_.in_runs() && suits_runs(inside, source_.gradients().are_continuous());
    return inside;
  }
  void restrict_to_range(Interval<double> range) override {
    GridStream::restrict_to_range(range);
    labels_.reset();
    range_ = range;
    run_ = {0, 0};
    cut_to_ = in_runs_ ? 0 : step_.t_end;
  }

  bool next(LayerStretch& stretch) override {
    return in_runs_ ? next_of_run(stretch) : next_of_cell(stretch);
  }

 private:
  bool next_of_cell(LayerStretch& stretch) {
    while (!(cut_to_ < step_.t_end)) {
      int block = 0;
      bool skipped = false;
      if (!next_cell(step_, block, skipped)) {
        cut_to_ = step_.t_end;
        return false;
      }
      cut_to_ = step_.t_end;
      if (skipped) continue;
      by_cell_ =
          by_cells_ && !source_.gradients().is_doubtful(step_, source_.grid().axis, planes());
      if (!by_cell_) {
        if (!make_multivariate_span(source_.grid(), step_, span_)) continue;
        source_.gradients().fill(step_, source_.grid().axis, planes(), whole_);
      }
      if (source_.labels() != nullptr) {
        cut_to_ = step_.t_begin;
        come_to(step_.t_begin);
        break;
      }
      stretch.begin = step_.t_begin;
      stretch.end = step_.t_end;
      stretch.position_error = grid_position_error(step_.t_end);
      stretch.function = 0;
      tell(0, 1, stretch);
      return true;
    }
    cut(stretch);
    return true;
  }

  /// Tells runs of cells, or as much of them as has one function.
  bool next_of_run(LayerStretch& stretch) {
    if (!(cut_to_ < run_.end)) {
      if (!next_run(run_)) return false;
      cut_to_ = run_.begin;
    }
    if (source_.labels() == nullptr) {
      tell_run(run_, stretch);
      cut_to_ = run_.end;
      return true;
    }
    stretch.kind = LayerStretch::Kind::run;
    stretch.begin = cut_to_;
    come_to(cut_to_);
    StructuredWalk<double>::Step part = part_of_label(run_.end);
    bool is_one = tell_function(part, stretch);
    cut_to_ = part.t_end;
    while (is_one && cut_to_ < run_.end) {
      come_to(cut_to_);
      const StructuredWalk<double>::Step more = part_of_label(run_.end);
      is_one = source_.function_at(more.cell) == stretch.function &&
               has_one_function(more, stretch.function);
      if (!is_one) break;
      part.exit = more.exit;
      cut_to_ = part.t_end = more.t_end;
    }
    stretch.end = cut_to_;
    stretch.position_error = position_error(part);
    return true;
  }

  /// Returns the part of the label's cell from cut_to_ on, up to `end` at most.
  StructuredWalk<double>::Step part_of_label(double end) const {
    StructuredWalk<double>::Step part = label_;
    part.t_begin = cut_to_;
    part.t_end = std::min(label_.t_end, end);
    const double of_label = label_.t_end - label_.t_begin;
    const bool is_begun = part.t_begin > label_.t_begin, goes_on = part.t_end < label_.t_end;
    if (of_label > 0 && (is_begun || goes_on)) {
      const auto place = [&](double t) {
        return label_.entry + (label_.exit - label_.entry) * ((t - label_.t_begin) / of_label);
      };
      if (is_begun) part.entry = place(part.t_begin);
      if (goes_on) part.exit = place(part.t_end);
    }
    return part;
  }

  /// Returns whether all label cells that a part may be in have this function.
  bool has_one_function(const StructuredWalk<double>::Step& part, int function) const {
    bool is_one = true;
    sides_.for_each_other_cell(source_.labels()->axis(), part, [&](const int(&cell)[3]) {
      is_one = is_one && source_.function_at(cell) == function;
    });
    return is_one;
  }

  /// Tells the function of a part. Returns whether it has no other.
  bool tell_function(const StructuredWalk<double>::Step& part, LayerStretch& stretch) const {
    stretch.function = source_.function_at(part.cell);
    const bool is_one = has_one_function(part, stretch.function);
    if (!is_one) stretch.left_out = source_.most_extinction();
    return is_one;
  }
  /// Returns how far off the ends of a part may be together.
  double position_error(const StructuredWalk<double>::Step& part) const {
    return std::max(2 * grid_position_error(part.t_end), sides_.position_error(part));
  }

  /// Goes on to the label at t.
  void come_to(double t) {
    // Through few cells, or over a gap.
    for (int steps = 0; steps < 4 && labels_; ++steps) {
      if (label_.t_end > t) return;
      if (!labels_->next(label_)) break;
    }
    labels_.emplace(source_.labels()->axis(), ray(), Interval<double>{t, range_.end});
    if (labels_->next(label_)) return;
    // The grids end at the same places but for rounding.
    label_.t_end = std::numeric_limits<double>::infinity();
  }

  /// Tells the next part of a cell that has one label.
  void cut(LayerStretch& stretch) {
    const StructuredWalk<double>::Step part = part_of_label(step_.t_end);
    stretch.begin = part.t_begin;
    stretch.end = part.t_end;
    stretch.position_error = position_error(part);
    tell_function(part, stretch);
    const double length = step_.t_end - step_.t_begin;
    tell((part.t_begin - step_.t_begin) / length, (part.t_end - step_.t_begin) / length, stretch);
    cut_to_ = part.t_end;
    if (cut_to_ < step_.t_end) come_to(cut_to_);
  }

  /// Tells what is known of the share [from, to] of the cell.
  void tell(double from, double to, LayerStretch& stretch) const {
    if (by_cell_) {
      stretch.kind = LayerStretch::Kind::cell;
      stretch.cell = step_;
      return;
    }
    const bool whole = from <= 0 && to >= 1;
    stretch.data[0] = whole ? span_.data[0] : restrict_to(span_.data[0], from, to);
    if (!source_.look().is_lit()) return;
    stretch.gradient_error = whole_.gradient_error;
    for (int a = 0; a < 3; ++a) {
      stretch.gradient[a] = whole ? whole_.gradient[a] : restrict_to(whole_.gradient[a], from, to);
    }
    stretch.magnitude = whole ? whole_.magnitude : restrict_to(whole_.magnitude, from, to);
  }

  const VolumeSource& source_;
  bool by_cells_;
  PlaneAmbiguity sides_;
  // The cell.
  StructuredWalk<double>::Step step_{};
  bool by_cell_ = false;  ///< whether neither its data nor its gradients are known
  MultivariateSpan<double> span_;
  LayerStretch whole_;  ///< the gradients in it
  // Runs of cells.
  bool in_runs_ = false;
  Interval<double> run_{0, 0};
  // The mask.
  Interval<double> range_{0, 0};
  double cut_to_ = 0;  ///< the part of the cell, or of the run, up to here was told
  std::optional<StructuredWalk<double>> labels_;
  StructuredWalk<double>::Step label_{};  ///< at cut_to_
};

std::unique_ptr<LayerStream> VolumeSource::stream(bool by_cells) const {
  return std::make_unique<VolumeStream>(*this, *content_.volume, records_, classes_.data(),
                                        by_cells && in_cells_);
}

/// Points of a volume, of whose functions a mask may choose.
class VolumePoints : public GridPoints {
 public:
  VolumePoints(const VolumeSource& source, const Volume& volume, const BlockRecords& records,
               const BlockClass* classes)
      : GridPoints(volume, source.grid().axis, records, classes), source_(source) {}

  void find(double t, LayerPoint& point) override {
    point.place = place(t);
    point.function = source_.grid().sample_at(point.place, point.value) ? 0 : -1;
    if (point.function == 0 && source_.labels() != nullptr) {
      const Vec3<double> here = position(t);
      int cell[3];
      for (int a = 0; a < 3; ++a) cell[a] = find_cell(source_.labels()->axis()[a], here[a]);
      point.function = source_.function_at(cell);
    }
  }
  void find_gradients(LayerPoint& point) const override { source_.gradients().find(point); }

 private:
  const VolumeSource& source_;
};

std::unique_ptr<LayerPoints> VolumeSource::sampled_points() const {
  return std::make_unique<VolumePoints>(*this, *content_.volume, records_, classes_.data());
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
    // Of a factor stretches tell the argument.
    in_cells_ = !look().has_surfaces() && look().extinction_factor() == nullptr &&
                is_uniform(channels_.grid());
    for (int c = 0; c < channels_.count(); ++c) {
      in_cells_ = in_cells_ && fits_single(*channels_[c].volume) &&
                  suits_lanes(*channels_[c].volume, most_extinction());
    }
    // A cell is vacuum where any channel is, which lanes do not see that load a table's alone.
    in_cells_ = in_cells_ && (functions_[0].tables == 0 || !has_vacuum());
    // Which Gaussians matter differs from block to block.
    in_runs_ = in_cells_ && functions_[0].gaussians.count == 0 && blocks_.left_out == 0 &&
               fits_walks(grid_.axis);
    if (look().isosurfaces().empty()) return;
    const auto count = static_cast<std::size_t>(blocks_.records.count());
    classes_.assign(blocks_.classes.block, blocks_.classes.block + count);
    for (int c = 0; c < channels_.count(); ++c) {
      visit_isosurfaces(classes_, channels_[c].volume->block_records(task.parallel), c, look(),
                        task);
    }
  }

  std::unique_ptr<LayerStream> stream(bool by_cells) const override;
  std::unique_ptr<LayerPoints> sampled_points() const override;
  const Volume* cells(int variable) const noexcept override {
    return in_cells_ ? channels_[variable].volume.get() : nullptr;
  }

  const MultichannelGrid& grid() const { return grid_; }
  const MultivariateBlocks& blocks() const { return blocks_; }
  const BlockClass* classes() const {
    return classes_.empty() ? blocks_.classes.block : classes_.data();
  }
  const GridGradients& gradients() const { return gradients_; }
  /// Returns whether stretches can be runs of cells.
  bool in_runs() const { return in_runs_; }

 private:
  bool has_vacuum() const {
    for (int c = 0; c < channels_.count(); ++c) {
      if (channels_[c].volume->statistics().nan > 0) return true;
    }
    return false;
  }

  const Channels& channels_;
  MultichannelGrid grid_;
  MultivariateBlocksStorage storage_;
  MultivariateBlocks blocks_;
  std::vector<BlockClass> classes_;  ///< with those of isosurfaces; empty: those of blocks_
  GridGradients gradients_;
  bool in_cells_ = false, in_runs_ = false;
};

class ChannelsStream : public GridStream {
 public:
  ChannelsStream(const ChannelsSource& source, const Volume& volume, bool by_cells)
      : GridStream(volume, source.grid().axis, source.blocks().records, source.classes(),
                   source.look().slices(), true),
        source_(source),
        by_cells_(by_cells) {}

  Interval<double> start(const Ray<double>& ray) override {
    const Interval<double> inside = GridStream::start(ray);
    in_runs_ =
        by_cells_ && source_.in_runs() && suits_runs(inside, source_.gradients().are_continuous());
    return inside;
  }

  bool next(LayerStretch& stretch) override {
    if (in_runs_) {
      Interval<double> run{0, 0};
      if (!next_run(run)) return false;
      tell_run(run, stretch);
      return true;
    }
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
      stretch.primitives = source_.blocks().primitives[block];
      if (by_cells_ && !source_.gradients().is_doubtful(step, source_.grid().axis, planes())) {
        stretch.kind = LayerStretch::Kind::cell;
        stretch.function = 0;
        stretch.cell = step;
        return true;
      }
      MultivariateSpan<double> span;
      if (!make_multivariate_span(source_.grid(), step, span)) continue;
      stretch.function = 0;
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
  bool by_cells_, in_runs_ = false;
};

std::unique_ptr<LayerStream> ChannelsSource::stream(bool by_cells) const {
  return std::make_unique<ChannelsStream>(*this, channels_.grid(), by_cells && in_cells_);
}

class ChannelsPoints : public GridPoints {
 public:
  ChannelsPoints(const ChannelsSource& source, const Volume& volume)
      : GridPoints(volume, source.grid().axis, source.blocks().records, source.classes()),
        source_(source) {}

  void find(double t, LayerPoint& point) override {
    point.place = place(t);
    point.function = source_.grid().sample_at(point.place, point.value) ? 0 : -1;
  }
  void find_gradients(LayerPoint& point) const override {
    source_.gradients().find(point);
    if (const ChannelTransferFunction* const factor = source_.look().value_factor()) {
      point.factor_argument = source_.look().factor_argument(point.value[factor->channel]);
    }
  }

 private:
  const ChannelsSource& source_;
};

std::unique_ptr<LayerPoints> ChannelsSource::sampled_points() const {
  return std::make_unique<ChannelsPoints>(*this, channels_.grid());
}

}  // namespace

std::unique_ptr<const LayerSource> make_volume_source(const LayerTask& task) {
  return std::make_unique<VolumeSource>(task);
}

std::unique_ptr<const LayerSource> make_channels_source(const LayerTask& task) {
  return std::make_unique<ChannelsSource>(task);
}

}  // namespace pellucid

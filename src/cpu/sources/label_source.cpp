// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <unordered_map>

#include "grid_stream.h"
#include "layers/plane_ambiguity.h"
#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/scene/internal/label_axes.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"

namespace pellucid {
namespace {

/// A segmentation. Its one channel is the label, constant in the cell around each value; its
/// function is LabelTable::function().
class LabelSource : public LayerSource {
 public:
  explicit LabelSource(const LayerTask& task)
      : LayerSource(task.layer),
        content_(std::get<LabelContent>(task.layer.content)),
        axes_(content_.labels->volume()),
        records_(content_.labels->volume().block_records(task.parallel)) {
    const TransferTablesStorage tables(content_.table->function());
    // A block's range is that of the values at the corners of its cells, the nearest to any place
    // in it among them.
    classes_ = BlockClassesStorage(records_, tables.tables(),
                                   std::max(task.wanted.largest_color, 1.0), task.parallel);
    table_ = {0, content_.table->function().view<double>()};
    functions_.push_back(transfer_of(table_));
    for (const LabelStyle& style : content_.table->styles()) {
      if (style.extinction > 0) extinction_.emplace(style.label, style.extinction);
    }
  }

  std::unique_ptr<LayerStream> stream(bool by_cells) const override;

  const LabelAxes& axes() const { return axes_; }
  /// Returns a label's extinction; NaN is vacuum.
  double extinction(double label) const {
    if (std::isnan(label)) return 0;
    const auto found = extinction_.find(static_cast<std::int32_t>(label));
    return found == extinction_.end() ? 0 : found->second;
  }

 private:
  const LabelContent& content_;
  LabelAxes axes_;
  const BlockRecords& records_;
  BlockClassesStorage classes_;
  ChannelTable<double> table_;
  std::unordered_map<std::int32_t, double> extinction_;  ///< of labels that absorb
};

/// Runs of cells of one label.
class LabelStream : public GridStream {
 public:
  LabelStream(const LabelSource& source, const Volume& volume, const BlockRecords& records,
              const BlockClass* classes)
      : GridStream(volume, source.axes().axis(), records, classes, source.look().slices(), false),
        source_(source) {}

  Interval<double> start(const Ray<double>& ray) override {
    sides_.start(grid_from_world(), ray);
    return GridStream::start(ray);
  }
  void restrict_to_range(Interval<double> range) override {
    GridStream::restrict_to_range(range);
    has_ahead_ = false;
  }

  bool next(LayerStretch& stretch) override {
    if (!has_ahead_ && !find()) return false;
    stretch.begin = ahead_.t_begin;
    const double label = label_, doubt = doubt_;
    stretch.function = source_.extinction(label) > 0 ? 0 : -1;
    stretch.left_out = doubt;
    double position_error = 0;
    do {
      position_error = std::max(position_error, sides_.position_error(ahead_));
      stretch.end = ahead_.t_end;
      has_ahead_ = false;
    } while (find() && label_ == label && doubt_ == doubt && ahead_.t_begin == stretch.end);
    stretch.position_error = std::max(grid_position_error(stretch.end), position_error);
    for (double& b : stretch.data[0].b) b = label;
    return true;
  }

 private:
  /// Finds the next cell that is visible, or whose ray may be in one.
  bool find() {
    int block = 0;
    bool skipped = false;
    while (next_cell(ahead_, block, skipped)) {
      if (skipped) continue;
      label_ = source_.axes().value(ahead_.cell);
      doubt_ = doubt_in(ahead_);
      if (!(source_.extinction(label_) > 0 || doubt_ > 0)) continue;
      has_ahead_ = true;
      return true;
    }
    return false;
  }

  /// Returns the extinction of what the ray shows of a cell, and may show of another one in its
  /// place.
  double doubt_in(const StructuredWalk<double>::Step& step) const {
    double doubt = 0;
    sides_.for_each_other_cell(source_.axes().axis(), step, [&](const int(&cell)[3]) {
      const double other = source_.axes().value(cell);
      if (other == label_) return;
      doubt = std::max(doubt, source_.extinction(label_) + source_.extinction(other));
    });
    return doubt;
  }

  const LabelSource& source_;
  PlaneAmbiguity sides_;
  StructuredWalk<double>::Step ahead_{};
  double label_ = 0, doubt_ = 0;
  bool has_ahead_ = false;
};

std::unique_ptr<LayerStream> LabelSource::stream(bool /*by_cells*/) const {
  // Blocks say nothing of values beside NaN.
  const Volume& volume = content_.labels->volume();
  const bool known = volume.statistics().nan == 0;
  return std::make_unique<LabelStream>(*this, volume, records_,
                                       known ? classes_.view().block : nullptr);
}

}  // namespace

std::unique_ptr<const LayerSource> make_label_source(const LayerTask& task) {
  return std::make_unique<LabelSource>(task);
}

}  // namespace pellucid

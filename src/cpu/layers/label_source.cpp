// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <unordered_set>

#include "grid_stream.h"
#include "label_axes.h"
#include "pellucid/scene/block_classes_storage.h"
#include "pellucid/scene/transfer_tables_storage.h"

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
      if (style.extinction > 0) visible_.insert(style.label);
    }
  }

  std::unique_ptr<LayerStream> stream() const override;

  const LabelAxes& axes() const { return axes_; }
  /// Returns whether the label absorbs.
  bool is_visible(double label) const {
    return !std::isnan(label) && visible_.contains(static_cast<std::int32_t>(label));
  }

 private:
  const LabelContent& content_;
  LabelAxes axes_;
  const BlockRecords& records_;
  BlockClassesStorage classes_;
  ChannelTable<double> table_;
  std::unordered_set<std::int32_t> visible_;
};

/// Runs of cells of one label.
class LabelStream : public GridStream {
 public:
  LabelStream(const LabelSource& source, const Volume& volume, const BlockRecords& records,
              const BlockClass* classes)
      : GridStream(volume, source.axes().axis(), records, classes, source.look().slices(), false),
        source_(source) {}

  void restrict_to_range(Interval<double> range) override {
    GridStream::restrict_to_range(range);
    has_ahead_ = false;
  }

  bool next(LayerStretch& stretch) override {
    if (!has_ahead_ && !find()) return false;
    stretch.begin = ahead_.t_begin;
    stretch.function = 0;
    const double label = label_;
    do {
      stretch.end = ahead_.t_end;
      has_ahead_ = false;
    } while (find() && label_ == label && ahead_.t_begin == stretch.end);
    stretch.position_error = grid_position_error(stretch.end);
    for (double& b : stretch.data[0].b) b = label;
    return true;
  }

 private:
  /// Finds the next visible cell.
  bool find() {
    int block = 0;
    bool skipped = false;
    while (next_cell(ahead_, block, skipped)) {
      if (skipped) continue;
      label_ = source_.axes().value(ahead_.cell);
      if (!source_.is_visible(label_)) continue;
      has_ahead_ = true;
      return true;
    }
    return false;
  }

  const LabelSource& source_;
  StructuredWalk<double>::Step ahead_{};
  double label_ = 0;
  bool has_ahead_ = false;
};

std::unique_ptr<LayerStream> LabelSource::stream() const {
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

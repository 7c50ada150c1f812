// SPDX-License-Identifier: Apache-2.0
#include "layer_data.h"

#include <algorithm>
#include <cmath>

#include "grid/grid_field.h"
#include "mesh/mesh_field.h"

namespace pellucid::reference {

LayerData::LayerData(const Layer& layer, const std::vector<Clip>& of_scene) {
  for (const std::vector<Clip>* list : {&layer.clips, &of_scene}) {
    for (const Clip& clip : *list) clips_.push_back(&clip);
  }
  if (const auto* labels = std::get_if<LabelContent>(&layer.content)) {
    labels_.emplace(Grid::around_values(labels->labels->volume()));
    for (const LabelStyle& style : labels->table->styles()) {
      // One point: the same extinction and color everywhere.
      points_.push_back({{0, style.extinction, style.color}});
      functions_.emplace_back(points_.back());
      label_of_.push_back(style.label);
    }
    return;
  }
  if (const auto* mesh = std::get_if<MeshContent>(&layer.content)) {
    field_ = std::make_unique<MeshField>(*mesh->mesh, DerivedChannels(layer));
    if (mesh->multivariate() != nullptr) {
      functions_.emplace_back(*mesh->multivariate());
    } else {
      functions_.emplace_back(mesh->univariate()->points());
    }
    return;
  }
  std::vector<const Volume*> volumes;
  if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    for (const Channel& channel : *channels->channels) volumes.push_back(channel.volume.get());
    functions_.emplace_back(*channels->transfer_function);
  } else {
    const auto& content = std::get<VolumeContent>(layer.content);
    volumes.push_back(content.volume.get());
    functions_.emplace_back(content.transfer_function->points());
    if (content.mask) {
      labels_.emplace(Grid::around_values(content.mask->labels().volume()));
      for (const LabelMask::Choice& choice : content.mask->choices()) {
        functions_.emplace_back(choice.transfer_function->points());
        label_of_.push_back(choice.label);
      }
    }
  }
  field_ = std::make_unique<GridField>(volumes, DerivedChannels(layer));
}

const Mixture* LayerData::function_of(Real label) const {
  const bool of_mask = field_ != nullptr;
  if (!std::isnan(label)) {
    for (std::size_t i = 0; i < label_of_.size(); ++i) {
      if (label == label_of_[i]) return &functions_[of_mask ? i + 1 : i];
    }
  }
  return of_mask ? &functions_.front() : nullptr;
}

std::vector<LayerStretch> LayerData::stretches_of_labels(const RealRay& ray) const {
  std::vector<LayerStretch> list;
  for (const Crossing& crossing : labels_->crossings(ray)) {
    const Real label = labels_->value(crossing);
    const Mixture* const function = function_of(label);
    if (function == nullptr) continue;
    list.push_back({crossing.t_begin, crossing.t_end, {Chord::linear(label, label)}, function});
  }
  return list;
}

namespace {

/// Returns the part [begin, end] of a stretch.
LayerStretch part_of(const LayerStretch& whole, Real begin, Real end, const Mixture* function) {
  LayerStretch part{begin, end, {}, function};
  const Real length = whole.t_end - whole.t_begin;
  const Real from = (begin - whole.t_begin) / length, to = (end - whole.t_begin) / length;
  for (const Chord& chord : whole.chords) part.chords.push_back(chord.part(from, to));
  return part;
}

}  // namespace

void LayerData::cut_by_mask(const RealRay& ray, std::vector<LayerStretch>& list) const {
  const std::vector<Crossing> cells = labels_->crossings(ray);
  std::vector<LayerStretch> cut;
  auto cell = cells.begin();
  for (const LayerStretch& stretch : list) {
    while (cell != cells.end() && cell->t_end <= stretch.t_begin) ++cell;
    for (auto at = cell; at != cells.end() && at->t_begin < stretch.t_end; ++at) {
      const Real begin = std::max(stretch.t_begin, at->t_begin);
      const Real end = std::min(stretch.t_end, at->t_end);
      if (!(begin < end)) continue;
      cut.push_back(part_of(stretch, begin, end, function_of(labels_->value(*at))));
    }
  }
  list = std::move(cut);
}

std::vector<LayerStretch> LayerData::stretches(const RealRay& ray, std::uint64_t& cells,
                                               Real& overlap) const {
  std::vector<LayerStretch> list;
  if (!field_) {
    list = stretches_of_labels(ray);
    cells += list.size();
  } else {
    overlap += field_->visit(ray, [&](const Stretch& stretch) {
      ++cells;
      if (!stretch.chords.empty()) {
        list.push_back({stretch.t_begin, stretch.t_end, stretch.chords, &functions_.front()});
      }
      return true;
    });
    if (labels_) cut_by_mask(ray, list);
  }
  if (clips_.empty()) return list;
  std::vector<LayerStretch> kept;
  for (const RayPart& part : kept_parts(ray, clips_)) {
    for (const LayerStretch& stretch : list) {
      const Real begin = std::max(stretch.t_begin, part.begin);
      const Real end = std::min(stretch.t_end, part.end);
      if (begin < end) kept.push_back(part_of(stretch, begin, end, stretch.function));
    }
  }
  return kept;
}

}  // namespace pellucid::reference

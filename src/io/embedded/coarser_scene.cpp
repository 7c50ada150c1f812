// SPDX-License-Identifier: Apache-2.0
#include "coarser_scene.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

namespace pellucid {

namespace {

std::string size_text(const Volume& volume) {
  const auto [x, y, z] = volume.description().dimensions;
  return std::to_string(x) + " x " + std::to_string(y) + " x " + std::to_string(z);
}

}  // namespace

CoarserScene::CoarserScene(const SceneDescription& description, const Scene& scene) {
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    const LayerDescription& layer = description.layers[i];
    const LayerContent& content = scene.layers[i].content;
    // Fields that are built in are made where they are shown, in the size that the scene says.
    std::vector<Source> sources;
    if (const auto* const volume = std::get_if<VolumeContent>(&content)) {
      if (!layer.field.builtin.empty()) continue;
      sources.push_back({volume->volume.get(), Merging::mean});
      if (volume->mask) sources.push_back({&volume->mask->labels().volume(), Merging::most_common});
    } else if (const auto* const channels = std::get_if<ChannelsContent>(&content)) {
      if (layer.channels.empty() && !layer.field.builtin.empty()) continue;
      for (const Channel& channel : *channels->channels) {
        sources.push_back({channel.volume.get(), Merging::mean});
      }
    } else if (const auto* const labels = std::get_if<LabelContent>(&content)) {
      sources.push_back({&labels->labels->volume(), Merging::most_common});
    }
    if (sources.empty()) continue;
    add(layer.name.empty() ? "layer " + std::to_string(i + 1) : "layer \"" + layer.name + "\"",
        std::move(sources));
  }
}

void CoarserScene::add(std::string layer, std::vector<Source> sources) {
  Group group{std::move(sources), {std::move(layer)}};
  const auto shares_data = [&](const Group& other) {
    return std::ranges::any_of(other.sources, [&](const Source& a) {
      return std::ranges::any_of(group.sources, [&](const Source& b) {
        return bytes_of(*a.volume) == bytes_of(*b.volume);
      });
    });
  };
  for (auto other = groups_.begin(); other != groups_.end();) {
    if (!shares_data(*other)) {
      ++other;
      continue;
    }
    group.sources.insert(group.sources.begin(), other->sources.begin(), other->sources.end());
    group.layers.insert(group.layers.begin(), other->layers.begin(), other->layers.end());
    other = groups_.erase(other);
  }
  groups_.push_back(std::move(group));
}

const Volume& CoarserScene::now(const Source& source) const {
  const auto found = coarser_.find(bytes_of(*source.volume));
  return found == coarser_.end() ? *source.volume : *found->second;
}

std::size_t CoarserScene::bytes(const Group& group) const {
  std::size_t sum = 0;
  for (const Source& source : group.sources) {
    sum += std::visit([](const auto& values) { return values.size() * sizeof(values[0]); },
                      now(source).data());
  }
  return sum;
}

bool CoarserScene::halve(const Group& group) {
  CoarserVolumes next;
  for (const Source& source : group.sources) {
    const std::byte* const key = bytes_of(*source.volume);
    if (next.contains(key)) continue;
    // Labels of one layer may be values of another.
    const bool are_labels = std::ranges::any_of(group.sources, [&](const Source& other) {
      return bytes_of(*other.volume) == key && other.merging == Merging::most_common;
    });
    std::shared_ptr<const Volume> coarser =
        coarser_volume(now(source), are_labels ? Merging::most_common : Merging::mean);
    if (!coarser) return false;
    next.emplace(key, std::move(coarser));
  }
  for (auto& [key, volume] : next) coarser_[key] = std::move(volume);
  return true;
}

bool CoarserScene::step() {
  std::vector<const Group*> largest_first;
  for (const Group& group : groups_) largest_first.push_back(&group);
  std::stable_sort(largest_first.begin(), largest_first.end(),
                   [&](const Group* a, const Group* b) { return bytes(*a) > bytes(*b); });
  return std::any_of(largest_first.begin(), largest_first.end(),
                     [&](const Group* group) { return halve(*group); });
}

std::vector<std::string> CoarserScene::notes() const {
  std::vector<std::string> notes;
  for (const Group& group : groups_) {
    const Volume& before = *group.sources.front().volume;
    const Volume& after = now(group.sources.front());
    if (&before == &after) continue;
    for (const std::string& layer : group.layers) {
      notes.push_back(layer + ": " + size_text(after) + " of " + size_text(before) + " values");
    }
  }
  return notes;
}

ReducedPage reduced_page(const SceneDescription& description, const Scene& scene,
                         std::uint64_t most_bytes, PageThreads threads) {
  CoarserScene coarser(description, scene);
  std::uint64_t most_data = most_bytes;
  while (true) {
    EmbeddedScene embedded;
    try {
      embedded = embed_coarser(description, scene, coarser.volumes(), most_data);
    } catch (const TooManyBytes&) {
      // The page that is too large tells its size.
      if (!coarser.step()) most_data = std::numeric_limits<std::uint64_t>::max();
      continue;
    }
    for (const std::string& note : coarser.notes()) {
      embedded.note += (embedded.note.empty() ? "data reduced: " : ", ") + note;
    }
    if (!embedded.note.empty()) embedded.note += "; the picture is exact for these";
    ReducedPage made{page_of(embedded, threads), embedded.note};
    if (made.page.size() <= most_bytes || !coarser.step()) return made;
  }
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "coarser_volume.h"
#include "pellucid/io/embed_scene.h"
#include "pellucid/scene/error.h"

namespace pellucid {

/// Volumes that are embedded in the place of others, by the first byte of those.
using CoarserVolumes = std::map<const std::byte*, std::shared_ptr<const Volume>>;

const std::byte* bytes_of(const Volume& volume);

/// Error of data that have more bytes than they may.
class TooManyBytes : public Error {
 public:
  using Error::Error;
};

/// Returns what embed_scene() does, with coarser data. Throws TooManyBytes as soon as there are.
EmbeddedScene embed_coarser(const SceneDescription& description, const Scene& scene,
                            const CoarserVolumes& coarser, std::uint64_t most_bytes);

/// Data of a scene that are made coarser, step by step.
class CoarserScene {
 public:
  /// Takes a reference to the scene, which must outlive it.
  CoarserScene(const SceneDescription& description, const Scene& scene);

  /// Halves the resolution of the largest data that can be made coarser, along each axis, and of
  /// all that lies on their grid. Returns false if there are none.
  bool step();
  const CoarserVolumes& volumes() const noexcept { return coarser_; }
  /// Returns "layer 1: 64 x 64 x 32 of 128 x 128 x 64 values" of each layer that is coarser.
  std::vector<std::string> notes() const;

 private:
  struct Source {
    const Volume* volume;  ///< Volume as it was loaded
    Merging merging;
  };
  /// Layers whose data share a grid, or are the same.
  struct Group {
    std::vector<Source> sources;
    std::vector<std::string> layers;
  };

  void add(std::string layer, std::vector<Source> sources);
  const Volume& now(const Source& source) const;
  std::size_t bytes(const Group& group) const;
  bool halve(const Group& group);

  std::vector<Group> groups_;
  CoarserVolumes coarser_;
};

}  // namespace pellucid

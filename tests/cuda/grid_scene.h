// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "pellucid/cuda/device_scene.h"
#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/scene/internal/multivariate_blocks_storage.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"
#include "pellucid/scene/view_camera.h"
#include "tests/scenes/cameras.h"
#include "tests/scenes/makers.h"

namespace pellucid::scenes {

/// A volume as the functions of a card see it, made by hand.
class GridScene {
 public:
  GridScene(VolumePointer volume, TransferPointer function, double tolerance, int size,
            std::size_t camera = 1)
      : volume_(std::move(volume)),
        function_(std::move(function)),
        tables_(*function_),
        classes_(volume_->block_records(), tables_.tables(), 1) {
    const MultichannelGrid grid = multichannel_grid(Channels({{"value", "", volume_}}));
    scene_.lit.grid = {grid.data[0], grid.type[0], {grid.axis[0], grid.axis[1], grid.axis[2]}};
    scene_.lit.grid_from_world = volume_->grid_from_world();
    scene_.lit.blocks = {volume_->block_records(), classes_.view()};
    scene_.transfer = tables_.tables();
    scene_.wanted.tolerance = tolerance;
    scene_.limits.tolerance = tolerance;
    scene_.camera = make_camera_frame(three_cameras(*volume_)[camera].camera, {size, size});
  }

  DeviceScene& scene() { return scene_; }
  const Volume& volume() const { return *volume_; }

 private:
  VolumePointer volume_;
  TransferPointer function_;
  TransferTablesStorage tables_;
  BlockClassesStorage classes_;
  DeviceScene scene_;
};

}  // namespace pellucid::scenes

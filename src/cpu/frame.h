// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "packet_sampler.h"
#include "packet_tracer.h"
#include "pellucid/cpu/render.h"
#include "pellucid/render/integrate_ray.h"
#include "pellucid/scene/block_classes_storage.h"
#include "pellucid/scene/scene.h"
#include "pellucid/scene/transfer_tables_storage.h"
#include "preintegrated_storage.h"

namespace pellucid {

/// What every pixel of the frame shares.
struct Frame {
  /// `scene` must outlive the frame. The blocks of its volume are made on so many threads where the
  /// method needs them.
  Frame(const Scene& scene, const RenderOptions& options, int threads);

  const Scene& scene;
  CameraFrame<double> camera;
  bool depth;  ///< whether the depth of half opacity is asked for
  TransferTablesStorage transfer;
  RayTolerance wanted;
  BlockClassesStorage block_classes;
  std::optional<ClassifiedBlocks> blocks;       ///< none: the method has no use for them
  std::unique_ptr<const PacketTracer> packets;  ///< null: rays go one by one, or are sampled
  double step;                                  ///< of the sampling methods, world length
  std::unique_ptr<const PreintegratedStorage> preintegrated;  ///< null: another method
  std::unique_ptr<const PacketSamplerTracer> sampler;         ///< null: rays go one by one
  double reserved;  ///< of the tolerance: what the transfer function is off by
};

}  // namespace pellucid

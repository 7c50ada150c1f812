// SPDX-License-Identifier: Apache-2.0
//
// What goes between the renderer and its kernels.
#include <gtest/gtest.h>

#include <type_traits>

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/field/tetrahedra.h"
#include "pellucid/packet/bundle/culled_mixture.h"
#include "pellucid/packet/layers/lane_mixture.h"
#include "pellucid/packet/light.h"
#include "pellucid/packet/mesh_interface.h"
#include "pellucid/packet/sample/sampled_multivariate.h"
#include "pellucid/packet/sample/sampler_transfer.h"
#include "pellucid/packet/steps/resolved_gaussians.h"
#include "pellucid/packet/surfaces.h"
#include "pellucid/packet/view.h"
#include "pellucid/transfer/preintegrated.h"
#include "pellucid/traverse/block_classes.h"
#include "pellucid/traverse/block_record.h"
#include "pellucid/traverse/block_variation.h"

namespace pellucid {
namespace {

// The numbers of one side are those of the other: nothing but them is in an object.
#define PELLUCID_EXPECT_PLAIN(Name, Type)            \
  static_assert(std::is_standard_layout_v<Type>);    \
  static_assert(std::is_trivially_copyable_v<Type>); \
  static_assert(std::is_trivially_destructible_v<Type>);
PELLUCID_EACH_VIEW(PELLUCID_EXPECT_PLAIN)

static_assert(std::is_trivially_copyable_v<PellucidView<PellucidLight>>);
static_assert(std::is_trivially_copyable_v<PellucidPacketJob>);
static_assert(std::is_trivially_copyable_v<PellucidMeshJob>);

TEST(PacketViews, TakeTheAddressOfTheirTypeAlone) {
  const BinnedTransfer transfer;
  PellucidPacketJob job{};
  EXPECT_EQ(seen(job.transfer), nullptr);
  job.transfer = &transfer;
  EXPECT_EQ(seen(job.transfer), &transfer);
  job.light = static_cast<const PacketLight*>(nullptr);
  EXPECT_EQ(seen(job.light), nullptr);

  using View = PellucidView<PellucidBinnedTransfer>;
  static_assert(std::is_assignable_v<View&, const BinnedTransfer*>);
  static_assert(std::is_assignable_v<View&, BinnedTransfer*>);
  static_assert(!std::is_assignable_v<View&, const PacketLight*>);
  static_assert(!std::is_assignable_v<View&, const SamplerTransfer*>);
  static_assert(!std::is_assignable_v<View&, const float*>);
  static_assert(!std::is_assignable_v<View&, const void*>);
  static_assert(!std::is_assignable_v<View&, PellucidView<PellucidLight>>);
  static_assert(std::is_same_v<decltype(seen(job.light)), const PacketLight*>);
}

}  // namespace
}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "pellucid/scene/error.h"
#include "tests/scenes/compare.h"
#include "tests/scenes/real.h"

/// The exact method against the reference on scans.
namespace pellucid::scenes {
namespace {

class RealScenes : public testing::TestWithParam<RealData> {};

TEST_P(RealScenes, ExactMatchesTheReference) {
  const RealData& data = GetParam();
  if (const std::string why = why_missing(data.file); !why.empty()) GTEST_SKIP() << why;
  for (const NamedScene& named : real_scenes(data, {36, 30})) expect_exact(named);
}

INSTANTIATE_TEST_SUITE_P(Scans, RealScenes, testing::ValuesIn(real_data()),
                         [](const auto& scan) { return scan.param.name; });

}  // namespace
}  // namespace pellucid::scenes

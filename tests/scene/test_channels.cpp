// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/channels.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "expect_error.h"

namespace pellucid::test_channels {
namespace {

Volume::Description description() {
  Volume::Description d;
  d.dimensions = {4, 3, 2};
  d.placement.spacing = {1, 2, 0.5};
  d.placement.origin = {10, -20, 30};
  return d;
}

template <class Value = float>
Channel channel(const std::string& name, Volume::Description d = description()) {
  std::size_t count = 1;
  for (const int side : d.dimensions) count *= static_cast<std::size_t>(side);
  return {name, "",
          std::make_shared<const Volume>(std::move(d), VolumeData(std::vector<Value>(count)))};
}

void expect_refused(std::vector<Channel> list, std::initializer_list<const char*> parts) {
  expect_error([&] { const Channels channels(std::move(list)); }, parts);
}

/// The second of two channels whose description is changed.
template <class Change>
Channel changed(Change&& change) {
  Volume::Description d = description();
  change(d);
  return channel("b", d);
}

TEST(Channels, KeepTheirOrderNamesAndTypes) {
  const Channels channels({channel<std::uint8_t>("t1"), channel<double>("t2"), channel("flair")});
  EXPECT_EQ(channels.count(), 3);
  EXPECT_EQ(channels[1].name, "t2");
  EXPECT_EQ(channels.find("flair"), 2);
  EXPECT_EQ(channels.find("t1"), 0);
  EXPECT_EQ(channels.find("T1"), std::nullopt);
  EXPECT_EQ(channels.find(""), std::nullopt);
  EXPECT_EQ(&channels.grid(), channels[0].volume.get());
  EXPECT_TRUE(std::holds_alternative<DataArray<std::uint8_t>>(channels[0].volume->data()));
  EXPECT_TRUE(std::holds_alternative<DataArray<double>>(channels[1].volume->data()));
  std::string names;
  for (const Channel& c : channels) names += c.name + " ";
  EXPECT_EQ(names, "t1 t2 flair ");
}

TEST(Channels, AreFromOneToEight) {
  std::vector<Channel> list;
  expect_refused(list, {"channels: there is none", "from 1 to 8"});
  for (int i = 0; i < 8; ++i) {
    list.push_back(channel("c" + std::to_string(i)));
    EXPECT_EQ(Channels(list).count(), i + 1);
  }
  list.push_back(channel("c8"));
  expect_refused(list, {"channels: there are 9", "at most 8", "leave some out"});
}

TEST(Channels, HaveNamesOfTheirOwnAndVolumes) {
  expect_refused({channel("a"), channel("")}, {"channels: number 1 has no name"});
  expect_refused({channel("a"), channel("b"), channel("a")}, {"\"a\" stands twice"});
  expect_refused({channel("a"), {"b", "", nullptr}}, {"\"b\" has no volume"});
}

TEST(Channels, LieOnOneGrid) {
  const auto refuse = [](Channel second, std::initializer_list<const char*> parts) {
    expect_refused({channel("a"), std::move(second)}, parts);
  };
  refuse(
      changed([](auto& d) {
        d.dimensions = {4, 2, 3};
      }),
      {"channel \"b\" and channel \"a\" are not on one grid: 4 x 2 x 3 and 4 x 3 x 2", "resample"});
  refuse(changed([](auto& d) { d.centering = Centering::cell; }),
         {"one is point-centred, the other cell-centred"});
  refuse(changed([](auto& d) {
           d.coordinates[1] = {0, 1, 4};
         }),
         {"coordinates of their axes differ"});
  refuse(changed([](auto& d) {
           d.name = "b.nii";
           d.placement.origin.x += 7;
         }),
         {"channel \"b\" (b.nii)", "not at one place", "up to 14 voxels apart", "origin"});
}

// The shortest edge, the voxel, is 0.5 long, the longest side of the grid 4 (y): 0.0005 is what the
// corners may be apart.
TEST(Channels, AgreeToAThousandthOfACell) {
  const auto shifted = [](double by) {
    return changed([by](auto& d) { d.placement.origin.y += by; });
  };
  EXPECT_NO_THROW(Channels({channel("a"), shifted(0.49e-3)}));
  expect_refused({channel("a"), shifted(0.51e-3)}, {"not at one place"});
  const auto stretched = [](double by) {
    return changed([by](auto& d) { d.placement.spacing.y += by; });
  };
  // Over the whole grid: two cells along y.
  EXPECT_NO_THROW(Channels({channel("a"), stretched(0.24e-3)}));
  expect_refused({channel("a"), stretched(0.26e-3)}, {"not at one place"});
  // The first one's grid counts, not the one before.
  expect_refused({channel("a"), shifted(0.4e-3),
                  [&] {
                    Channel c = shifted(0.8e-3);
                    c.name = "c";
                    return c;
                  }()},
                 {"channel \"c\" and channel \"a\""});
}

}  // namespace
}  // namespace pellucid::test_channels

// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/channel_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "pellucid/scene/derived_channels.h"
#include "tests/scene/expect_error.h"

namespace pellucid::test_channel_source {
namespace {

using Kind = DerivedSource::Kind;

ChannelSource builtin(const std::string& name, const std::string& field = "shells",
                      int points = 9) {
  FieldSource source;
  source.builtin = field;
  source.points = points;
  return {name, "", source};
}

ChannelSource derived(const std::string& name, Kind kind, const std::string& of, double sigma = 0) {
  return {name, "", DerivedSource{kind, of, sigma}};
}

void expect_refused(const char* text, std::initializer_list<const char*> parts) {
  expect_error([&] { parse_channel_source(text); }, parts);
}

TEST(ChannelSource, ReadsFieldsAndWhatIsMadeOfThem) {
  const ChannelSource file = parse_channel_source("t1=a=b/T1:1.nii.gz");
  EXPECT_EQ(file.name, "t1");
  EXPECT_EQ(std::get<FieldSource>(file.source).file, "a=b/T1:1.nii.gz");
  const ChannelSource field = parse_channel_source("b=builtin:ramp:7");
  EXPECT_EQ(std::get<FieldSource>(field.source).builtin, "ramp");
  EXPECT_EQ(std::get<FieldSource>(field.source).points, 7);
  const auto component = [](const char* text) {
    return std::get<FieldSource>(parse_channel_source(text).source);
  };
  EXPECT_EQ(component("u=V1.nii.gz[2]").file, "V1.nii.gz");
  EXPECT_EQ(component("u=V1.nii.gz[2]").options.component, 2);
  EXPECT_EQ(component("u=V1.nii.gz").options.component, std::nullopt);
  EXPECT_EQ(component("u=V[-1]").file, "V[-1]");
  EXPECT_EQ(component("u=V[x]").file, "V[x]");
  EXPECT_EQ(component("u=[0].npy").file, "[0].npy");
  const auto made = [](const char* text) {
    return std::get<DerivedSource>(parse_channel_source(text).source);
  };
  EXPECT_EQ(made("edge=gradient_magnitude:t1").kind, Kind::gradient_magnitude);
  EXPECT_EQ(made("edge=gradient_magnitude:t1").channel, "t1");
  EXPECT_EQ(made("bend=second_derivative:t1").kind, Kind::second_derivative);
  EXPECT_EQ(made("soft=smoothed:t1:2.5e-1").kind, Kind::smoothed);
  EXPECT_EQ(made("soft=smoothed:t1:2.5e-1").channel, "t1");
  EXPECT_EQ(made("soft=smoothed:t1:2.5e-1").sigma, 0.25);
}

TEST(ChannelSource, SaysWhatIsWrong) {
  expect_refused("", {"expected NAME=SOURCE"});
  expect_refused("T1.nii.gz", {"channel T1.nii.gz: expected NAME=SOURCE", "as in t1=T1.nii.gz"});
  expect_refused("=T1.nii.gz", {"\"\" is no name of a channel"});
  expect_refused("a b=T1.nii.gz", {"\"a b\" is no name of a channel", "without spaces"});
  expect_refused("t1=", {"name of the field is empty"});
  expect_refused("t1=builtin:shels", {"did you mean \"shells\"?"});
  expect_refused("t1=builtin:shells[1]", {"a built-in field has no components"});
  expect_refused("e=gradient_magnitude", {"does not say of which channel"});
  expect_refused("e=gradient_magnitude:", {"does not say of which channel"});
  expect_refused("e=gradient_magnitude:t1:3", {"\"3\" stands behind the channel; remove it"});
  for (const char* text :
       {"s=smoothed:t1", "s=smoothed:t1:", "s=smoothed:t1:0", "s=smoothed:t1:-1",
        "s=smoothed:t1:nan", "s=smoothed:t1:inf", "s=smoothed:t1:2mm", "s=smoothed:t1:1e999"}) {
    expect_refused(text, {"is no standard deviation", "smoothed:CHANNEL:2.5"});
  }
}

TEST(ChannelSource, NamesLeaveTheSignsOfTheCommandLineFree) {
  for (const char* good : {"t1", "T1-post", "a.b", "a/b", "x_y", "\xcf\x81", "[1]"}) {
    EXPECT_TRUE(is_channel_name(good)) << good;
  }
  for (const char* bad : {"", " ", "a b", "a,b", "a:b", "a;b", "a=b", "a~b", "a\tb", "a\x7f"}) {
    EXPECT_FALSE(is_channel_name(bad)) << bad;
  }
  EXPECT_TRUE(is_channel_name(std::string(64, 'a')));
  EXPECT_FALSE(is_channel_name(std::string(65, 'a')));
}

TEST(ChannelSource, ListsAreCheckedBeforeAnythingIsRead) {
  std::vector<ChannelSource> list;
  expect_error([&] { check_channel_sources(list); }, {"there are 0", "from 1 to 8"});
  for (int i = 0; i < 9; ++i) list.push_back(builtin(std::to_string(i)));
  expect_error([&] { check_channel_sources(list); }, {"there are 9", "from 1 to 8"});
  list.pop_back();
  EXPECT_NO_THROW(check_channel_sources(list));
  FieldSource missing;
  missing.file = "/nowhere/a.nii.gz";
  const auto refuse = [&](ChannelSource second, std::initializer_list<const char*> parts) {
    expect_error([&] { load_channels({{"a", "", missing}, second}); }, parts);
  };
  refuse(builtin("a"), {"the name \"a\" stands twice"});
  refuse(builtin("a b"), {"\"a b\" is no name of a channel"});
  refuse(derived("b", Kind::smoothed, "b", 1),
         {"\"b\" is made of a channel \"b\"", "not before it"});
  refuse(derived("b", Kind::smoothed, "c", 1), {"\"c\", which is not before it"});
  refuse(builtin("b"), {"/nowhere/a.nii.gz"});
}

const std::vector<float>& values(const Channel& channel) {
  static std::vector<float> list;
  const auto& data = std::get<DataArray<float>>(channel.volume->data());
  list.assign(data.data(), data.data() + data.size());
  return list;
}

TEST(ChannelSource, LoadsEachAndComputesTheDerived) {
  std::vector<ChannelSource> list{builtin("a"), derived("edge", Kind::gradient_magnitude, "a"),
                                  derived("soft", Kind::smoothed, "edge", 0.3),
                                  derived("bend", Kind::second_derivative, "a")};
  list[1].unit = "1/mm";
  const Channels channels = load_channels(list);
  ASSERT_EQ(channels.count(), 4);
  EXPECT_EQ(channels[1].name, "edge");
  EXPECT_EQ(channels[1].unit, "1/mm");
  const Volume& a = *channels[0].volume;
  const auto expect_same = [&](int i, const Volume& expected) {
    EXPECT_EQ(values(channels[i]), values({"", "", std::make_shared<const Volume>(expected)}));
  };
  expect_same(1, gradient_magnitude(a));
  expect_same(2, smoothed(gradient_magnitude(a), 0.3));
  expect_same(3, second_derivative(a));
}

TEST(ChannelSource, GridsThatDifferAreRefused) {
  expect_error(
      [] {
        load_channels({builtin("a"), builtin("b", "ramp", 8)});
      },
      {"channel \"b\"", "channel \"a\"", "not on one grid"});
}

}  // namespace
}  // namespace pellucid::test_channel_source

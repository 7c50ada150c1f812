// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pellucid/io/transfer_function_description.h"
#include "tests/scene/expect_error.h"

namespace pellucid::test_gaussian_text {
namespace {

using Names = std::vector<std::string>;
using Numbers = std::vector<double>;

const Numbers& widths(const GaussianPrimitive& g) {
  return std::get<GaussianWidths>(*g.shape).widths;
}

void expect_refused(const char* text, std::initializer_list<const char*> parts) {
  expect_error([&] { parse_gaussian(text); }, parts);
}

TEST(GaussianText, IsReadWholly) {
  const GaussianPrimitive g =
      parse_gaussian("t1=80~10, edge=-2e1~0.5; extinction 0.25; color 1,0.5,0");
  EXPECT_EQ(g.channels, (std::vector<ChannelRef>{"t1", "edge"}));
  EXPECT_EQ(g.center, (Numbers{80, -20}));
  EXPECT_EQ(widths(g), (Numbers{10, 0.5}));
  EXPECT_TRUE(std::get<GaussianWidths>(*g.shape).axes.empty());
  EXPECT_EQ(g.extinction, 0.25);
  EXPECT_EQ(g.color, (Rgb<double>{1, 0.5, 0}));
}

TEST(GaussianText, ToleratesSpacesUnitsOrderAndPlusMinus) {
  const Names same{
      "  t1 = 80 HU ~ 10 HU ,edge=+20\xc2\xb1"
      "5 HU/mm ; color=1, 1, 1;extinction=2/mm ;",
      "t1=80~10,edge=20~5;extinction 2",
      "t1=80.0\xc2\xb1"
      "1e1,edge=20~5;\textinction\t2"};
  for (const std::string& text : same) {
    SCOPED_TRACE(text);
    const GaussianPrimitive g = parse_gaussian(text);
    EXPECT_EQ(g.channels, (std::vector<ChannelRef>{"t1", "edge"}));
    EXPECT_EQ(g.center, (Numbers{80, 20}));
    EXPECT_EQ(widths(g), (Numbers{10, 5}));
    EXPECT_EQ(g.extinction, 2);
    EXPECT_EQ(g.color, (Rgb<double>{1, 1, 1}));
  }
}

TEST(GaussianText, NamesMayBeLeftOut) {
  const GaussianPrimitive g = parse_gaussian("80~10, 20~5; extinction 1");
  EXPECT_TRUE(g.channels.empty());
  EXPECT_EQ(g.center, (Numbers{80, 20}));
}

// IEC 61966-2-1: 0x40 is 0.0512694..., below 0.04045 it is linear.
TEST(GaussianText, HexColorsAreSrgb) {
  const auto color = [](const char* text) {
    return parse_gaussian(std::string("1~1; extinction 1; color ") + text).color;
  };
  EXPECT_EQ(color("#ff00FF"), (Rgb<double>{1, 0, 1}));
  EXPECT_NEAR(color("#40bc0a").r, 0.05126945837404324, 1e-15);
  EXPECT_NEAR(color("#40bc0a").g, 0.5028864580325687, 1e-15);
  EXPECT_NEAR(color("#40bc0a").b, 10 / 255.0 / 12.92, 1e-15);
}

TEST(GaussianText, SaysWhatIsWrong) {
  expect_refused("", {"Gaussian \"\"", "has no width"});
  expect_refused("t1=80; extinction 1", {"\"80\" has no width", "as in 80~10"});
  expect_refused("t1=80~10", {"no extinction", "; extinction 0.5"});
  expect_refused("t1=80~10, 20~5; extinction 1", {"name all or none"});
  expect_refused("t1=80~10, t1=20~5; extinction 1", {"channel \"t1\" stands twice"});
  expect_refused("a b=80~10; extinction 1", {"\"a b\" is no name of a channel"});
  expect_refused("=80~10; extinction 1", {"\"\" is no name of a channel"});
  for (const char* width : {"0", "-1", "1e-38"}) {
    expect_refused(("80~" + std::string(width) + "; extinction 1").c_str(),
                   {"a width is not positive"});
  }
  for (const char* number :
       {"x",  "",    "nan", "inf", "1e38", "-1e38", "1e999", "1.2.3", "1..", "0x10",
        "1e", "1 2", "1-2", "--1", "+-1",  "++1",   "-+1",   "1%",    "1 %", "mm2"}) {
    expect_refused((std::string(number) + "~1; extinction 1").c_str(),
                   {"a centre is \"", "must be a number up to 2.1e37"});
    expect_refused(("1~" + std::string(number) + "; extinction 1").c_str(), {"a width is \""});
    expect_refused(("1~1; extinction " + std::string(number)).c_str(), {"the extinction is \""});
    expect_refused(("1~1; extinction 1; color 1,1," + std::string(number)).c_str(),
                   {"a part of the color is \""});
  }
  expect_refused("80,5~10; extinction 1", {"\"80\" has no width"});
  expect_refused("1~1; extinction -1", {"extinction is negative"});
  expect_refused("1~1; extinction 1; color 0,-1,0", {"color is negative"});
  for (const char* color :
       {"", "white", "#fff", "#ggcc99", "#ffcc999", "1,1", "1,1,1,1", "# ffcc9"}) {
    expect_refused(("1~1; extinction 1; color " + std::string(color)).c_str(),
                   {"the color is \"", "#RRGGBB in sRGB", "linear R,G,B"});
  }
  expect_refused("1~1; extinction 1; extinction 2", {"\"extinction 2\" is not understood", "once"});
  expect_refused("1~1; extinction 1; opacity 2", {"\"opacity 2\" is not understood"});
  expect_refused("1~1;; extinction 1", {"\"\" is not understood"});
}

}  // namespace
}  // namespace pellucid::test_gaussian_text

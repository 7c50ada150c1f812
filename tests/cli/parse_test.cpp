// SPDX-License-Identifier: Apache-2.0
#include "arguments/parse.h"

#include <gtest/gtest.h>

namespace {

using pellucid::DirectionalLight;
using pellucid::HeadLight;
using pellucid::Isosurface;
using pellucid::Light;
using pellucid::PointLight;
using pellucid::Rgb;
using pellucid::Shading;
using pellucid::Slice;
using pellucid::Vec3;
using namespace pellucid::cli;

TEST(Parse, Size) {
  EXPECT_EQ(parse_size("--size", "640x480").width, 640);
  EXPECT_EQ(parse_size("--size", "640x480").height, 480);
  EXPECT_EQ(parse_size("--size", "64").height, 64);
  EXPECT_EQ(parse_size("--size", "65536x1").width, 65536);
  for (const char* bad : {"", "x", "0x5", "5x0", "-3", "640x", "x480", "1x2x3", "64.5", "65537",
                          "640 x480", "99999999999999999999"}) {
    EXPECT_THROW(parse_size("--size", bad), UsageError) << bad;
  }
}

TEST(Parse, Triple) {
  EXPECT_EQ(parse_triple("--origin", "-1,2.5,+3e2"), (std::array<double, 3>{-1, 2.5, 300}));
  for (const char* bad :
       {"", "1,2", "1,2,3,4", "1,,3", "a,b,c", "1,2,nan", "1,2,inf", "1,2,3 ", "+-1,2,3"}) {
    EXPECT_THROW(parse_triple("--origin", bad), UsageError) << bad;
  }
}

TEST(Parse, Dimensions) {
  EXPECT_EQ(parse_dimensions("--dimensions", "1,2,3"), (std::array<int, 3>{1, 2, 3}));
  for (const char* bad : {"0,1,1", "-4,4,4", "1.5,2,3", "4,4", "4,4,99999999999"}) {
    EXPECT_THROW(parse_dimensions("--dimensions", bad), UsageError) << bad;
  }
}

TEST(Parse, Color) {
  EXPECT_EQ(parse_color("--background", "white"), (Rgb<double>{1, 1, 1}));
  EXPECT_EQ(parse_color("--background", "black"), (Rgb<double>{0, 0, 0}));
  EXPECT_EQ(parse_color("--background", "0.25,0,2"), (Rgb<double>{0.25, 0, 2}));
  EXPECT_EQ(parse_color("--background", "#ff00FF"), (Rgb<double>{1, 0, 1}));
  for (const char* bad : {"grey", "1,1", "-0.1,0,0", "0,0,inf", "#fff", "#12345g", "#-12345"}) {
    EXPECT_THROW(parse_color("--background", bad), UsageError) << bad;
  }
}

TEST(Parse, Shading) {
  const Shading shading = parse_shading("--shading", "0.1,0.5,0.25");
  EXPECT_EQ(shading.ambient, 0.1);
  EXPECT_EQ(shading.diffuse, 0.5);
  EXPECT_EQ(shading.specular, 0.25);
  EXPECT_EQ(shading.power, Shading{}.power);
  EXPECT_EQ(parse_shading("--shading", "0,0,0,50").power, 50);
  for (const char* bad : {"yes", "", "1", "1,1", "1,1,1,0.5", "-1,1,1", "1,1,1,1,1", "1,nan,1"}) {
    EXPECT_THROW(parse_shading("--shading", bad), UsageError) << bad;
  }
}

TEST(Parse, Light) {
  EXPECT_TRUE(std::holds_alternative<HeadLight>(parse_light("--light", "head").kind));
  EXPECT_EQ(parse_light("--light", "head:0,0.5,2").color, (Rgb<double>{0, 0.5, 2}));
  const Light sun = parse_light("--light", "directional:0,1,-1:black");
  EXPECT_EQ(std::get<DirectionalLight>(sun.kind).direction, (Vec3<double>{0, 1, -1}));
  EXPECT_EQ(sun.color, (Rgb<double>{0, 0, 0}));
  EXPECT_EQ(std::get<PointLight>(parse_light("--light", "point:1,2,3").kind).position,
            (Vec3<double>{1, 2, 3}));
  for (const char* bad : {"", "spot", "spot:1,2,3", "directional", "directional:0,0,0", "point:1,2",
                          "point:1,2,3:pink", "head:white:1", "point:1,2,3:white:1"}) {
    EXPECT_THROW(parse_light("--light", bad), UsageError) << bad;
  }
}

TEST(Parse, Isosurface) {
  EXPECT_EQ(parse_isosurface("--iso", "-300"), (Isosurface{-300}));
  EXPECT_EQ(parse_isosurface("--iso", "0.5:1,0,0:0.25"), (Isosurface{0.5, 0.25, {1, 0, 0}}));
  EXPECT_EQ(parse_isosurface("--iso", "0.5::0.25"), (Isosurface{0.5, 0.25}));
  for (const char* bad : {"", "bone", "1:pink", "1:white:2", "1:white:-1", "1:white:0.5:1", "inf",
                          "nan", "1:white:"}) {
    EXPECT_THROW(parse_isosurface("--iso", bad), UsageError) << bad;
  }
}

TEST(Parse, Slice) {
  const Slice y = parse_slice("--slice", "y=-2.5:0.5");
  EXPECT_EQ(y.point, (Vec3<double>{0, -2.5, 0}));
  EXPECT_EQ(y.normal, (Vec3<double>{0, 1, 0}));
  EXPECT_EQ(y.opacity, 0.5);
  const Slice oblique = parse_slice("--slice", "1,2,3,0,-1,1");
  EXPECT_EQ(oblique.point, (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(oblique.normal, (Vec3<double>{0, -1, 1}));
  EXPECT_EQ(oblique.opacity, 1);
  for (const char* bad : {"", "z", "w=1", "z=", "z=a", "z=1:2", "z=1:", "z=1:1:1", "1,2,3",
                          "1,2,3,0,0,0", "1,2,3,0,0,inf", "x=nan"}) {
    EXPECT_THROW(parse_slice("--slice", bad), UsageError) << bad;
  }
}

TEST(Parse, Tolerance) {
  EXPECT_EQ(parse_tolerance("--tolerance", "0.001"), 0.001);
  EXPECT_EQ(parse_tolerance("--tolerance", "1e-4"), 1e-4);
  EXPECT_EQ(parse_tolerance("--tolerance", "1/512"), 1.0 / 512);
  EXPECT_EQ(parse_tolerance("--tolerance", "0.5/255"), 0.5 / 255);
  EXPECT_EQ(parse_tolerance("--tolerance", "+1e-300"), 1e-300);
  EXPECT_EQ(parse_tolerance("--tolerance", "1e300"), 1e300);
  for (const char* bad : {"",
                          "nan",
                          "inf",
                          "-inf",
                          "0",
                          "-0",
                          "-1",
                          "1/0",
                          "0/1",
                          "-1/-2",
                          "1/-2",
                          "1/",
                          "/2",
                          "1/2/3",
                          "1//2",
                          "1/nan",
                          "1/inf",
                          "inf/inf",
                          "1e400",
                          "1e-400",
                          "1 ",
                          "1 /2",
                          "0.001mm",
                          "1,5e-3",
                          "1e-200/1e200",
                          "1e300/1e-300",
                          "0x1p-9",
                          "1/512/"}) {
    EXPECT_THROW(parse_tolerance("--tolerance", bad), UsageError) << bad;
  }
}

TEST(Parse, ToleranceInPercentIsAShare) {
  const auto parse = [](const char* text) { return parse_picture_tolerance("--tolerance", text); };
  EXPECT_FALSE(parse("1/512").is_share);
  EXPECT_EQ(parse("1/512").value, 1.0 / 512);
  EXPECT_TRUE(parse("1%").is_share);
  EXPECT_EQ(parse("1%").value, 0.01);
  EXPECT_EQ(parse("0.5 %").value, 0.005);
  EXPECT_EQ(parse("100%").value, 1);
  for (const char* bad :
       {"%", " %", "0%", "-1%", "101%", "nan%", "inf%", "1/2%", "1,2%", "1%%", "x%", "1e-400%"}) {
    EXPECT_THROW(parse(bad), UsageError) << bad;
  }
}

TEST(Parse, MessagesAreOneLine) {
  EXPECT_EQ(one_line("two\nlines\r\n\there\n"), "two lines here");
  EXPECT_EQ(one_line("\x1b[31mred"), "[31mred");
  EXPECT_EQ(one_line("volumen größe"), "volumen größe");
}

TEST(Parse, RangesOfValuesAndPercentages) {
  using pellucid::RangeEnd;
  using pellucid::RangeEnds;
  const auto parse = [](const char* text) { return parse_value_range("--range", text); };
  EXPECT_EQ(parse("-10:2.5"), (RangeEnds{{{-10, false}, {2.5, false}}}));
  EXPECT_EQ(parse("1e3,2e3"), (RangeEnds{{{1000, false}, {2000, false}}}));
  EXPECT_EQ(parse("2%:98.5%"), (RangeEnds{{{2, true}, {98.5, true}}}));
  // Which of the two is the larger is known with the data.
  EXPECT_EQ(parse("90%:3"), (RangeEnds{{{90, true}, {3, false}}}));
  for (const char* text : {"", "1", ":", "1:", ":1", "1:1", "2:1", "a:b", "1:2:3", "1,2,3",
                           "-1%:5%", "5%:101%", "%:1", "nan:1", "0:inf", "1 : 2x"}) {
    EXPECT_THROW(parse(text), UsageError) << text;
  }
}

}  // namespace

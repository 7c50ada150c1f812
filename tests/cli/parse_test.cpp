// SPDX-License-Identifier: Apache-2.0
#include "parse.h"

#include <gtest/gtest.h>

namespace {

using pellucid::Rgb;
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
  for (const char* bad : {"grey", "1,1", "-0.1,0,0", "0,0,inf", "#fff"}) {
    EXPECT_THROW(parse_color("--background", bad), UsageError) << bad;
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

}  // namespace

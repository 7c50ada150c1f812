// SPDX-License-Identifier: Apache-2.0
#include "view/command.h"

#include <gtest/gtest.h>

#include <string>

#include "pellucid/scene/error.h"

namespace pellucid::view::command_test {
namespace {

template <class Kind>
Kind parsed(std::string_view message) {
  return std::get<Kind>(parse_command(message));
}

void expect_refused(std::string_view message, std::string_view why) {
  try {
    parse_command(message);
    FAIL() << "was taken: " << message.substr(0, 100);
  } catch (const Error& error) {
    const std::string_view what = error.what();
    EXPECT_NE(what.find(why), what.npos) << what;
    EXPECT_LT(what.size(), 400U);
    for (const char c : what) EXPECT_GE(c, ' ') << what;
  }
}

TEST(ParseCommand, ReadsMoves) {
  const auto size = parsed<Resize>(R"({"type": "size", "width": 640, "height": 480})");
  EXPECT_EQ(size.width, 640);
  EXPECT_EQ(size.height, 480);
  EXPECT_EQ(parsed<Turn>(R"({"type": "turn", "x": 0.5, "y": -0.25})").y, -0.25);
  EXPECT_EQ(parsed<Zoom>(R"({"type": "zoom", "factor": 2})").factor, 2);
  EXPECT_EQ(parsed<LookFrom>(R"({"type": "look_from", "side": "left"})").side, "left");
  EXPECT_EQ(parsed<SetProjection>(R"({"type": "projection", "name": "orthographic"})").projection,
            Projection::orthographic);
  parsed<Undo>(R"({"type": "undo"})");
  parsed<CancelFit>(R"({"type": "cancel"})");
}

TEST(ParseCommand, ReadsEdits) {
  const auto edit = parsed<Edit>(
      R"({"type": "edit", "layer": 1, "key": "visible", "value": false, "gesture": 7})");
  EXPECT_EQ(edit.layer, 1U);
  EXPECT_EQ(edit.key, "visible");
  EXPECT_EQ(edit.value, Json(false));
  EXPECT_EQ(edit.gesture, 7);
  EXPECT_FALSE(
      parsed<Edit>(R"({"type": "edit", "key": "clip", "value": null, "gesture": 7})").layer);
}

TEST(ParseCommand, ReadsWhatIsOpened) {
  EXPECT_EQ(parsed<ListFolder>(R"({"type": "list_folder", "folder": ""})").folder, "");
  EXPECT_EQ(parsed<OpenFile>(R"({"type": "open", "input": "a.nrrd"})").input, "a.nrrd");
  EXPECT_EQ(parsed<OpenUpload>(R"({"type": "open_upload", "set": 7, "name": "a"})").set, 7);
  expect_refused(R"({"type": "open", "input": ""})", "input has 0 bytes");
  expect_refused(R"({"type": "open", "input": "a\u0000b"})", "input has a byte 0");
}

TEST(ParseCommand, ReadsRangesOfHistograms) {
  const auto ask = parsed<AskHistogram>(
      R"({"type": "histogram", "layer": 0, "channels": ["a", "b"], "ranges": [[0, 1], [2, 3]]})");
  ASSERT_EQ(ask.ranges.size(), 2U);
  EXPECT_EQ(ask.ranges[1].upper, 3);
  EXPECT_FALSE(ask.all);
  for (const char* ranges : {"[]", "[[0, 1], [2, 3]]", "[[1, 1]]", "[[0]]", "[[0, \"1\"]]", "7"}) {
    expect_refused(std::string(R"({"type": "histogram", "layer": 0, "channels": ["a"], )") +
                       "\"ranges\": " + ranges + "}",
                   "ranges");
  }
}

TEST(ParseCommand, ReadsSlicesAndPositions) {
  const auto slice = parsed<AskSlice>(
      R"({"type": "slice", "axis": 1, "position": -2.5, "from": [0, 9], "to": [8, 1],
      "columns": 640, "rows": 480, "layer": 2, "channel": 3})");
  EXPECT_EQ(slice.plane.axis, 1);
  EXPECT_EQ(slice.plane.position, -2.5);
  EXPECT_EQ(slice.plane.from[1], 9);
  EXPECT_EQ(slice.plane.to[1], 1);
  EXPECT_EQ(slice.plane.columns, 640);
  EXPECT_EQ(slice.layer, 2U);
  EXPECT_EQ(slice.channel, 3);
  EXPECT_EQ(parsed<Locate>(R"({"type": "locate", "position": [1, 2, 3]})").position.z, 3);
  EXPECT_TRUE(parsed<Probe>(R"({"type": "probe", "x": 0, "y": 1, "picks": true})").picks);
  EXPECT_FALSE(parsed<Probe>(R"({"type": "probe", "x": 0, "y": 1})").picks);
}

TEST(ParseCommand, RefusesWrongSlices) {
  const auto slice = [](const char* key, const char* value) {
    Json json = Json::parse(R"({"type": "slice", "axis": 1, "position": 0, "from": [0, 0],
        "to": [1, 1], "columns": 4, "rows": 4})");
    json[key] = Json::parse(value);
    return json.dump();
  };
  EXPECT_FALSE(parsed<AskSlice>(slice("axis", "0")).layer);
  expect_refused(slice("axis", "3"), "axis is 3");
  expect_refused(slice("axis", "0.5"), "not a whole number");
  expect_refused(slice("position", "null"), "position is not a number");
  expect_refused(slice("position", "1e31"), "position is 1e+31");
  expect_refused(slice("from", "[0]"), "from is not a list of 2 numbers");
  expect_refused(slice("from", "[0, \"1\"]"), "from is not a list of 2 numbers");
  expect_refused(slice("to", "[1e300, 1]"), "to is not a list of 2 numbers");
  expect_refused(slice("to", "[0, 1]"), "to has a number of from");
  expect_refused(slice("columns", "0"), "columns is 0");
  expect_refused(slice("rows", "4097"), "rows is 4097");
  expect_refused(slice("channel", "0"), "channel is not a member");
  expect_refused(slice("layer", "-1"), "layer is -1");
  expect_refused(slice("layer", "0"), "channel is missing");
  expect_refused(R"({"type": "locate", "position": [1, 2]})", "3 numbers");
  expect_refused(R"({"type": "locate", "position": {"x": 1}})", "3 numbers");
  expect_refused(R"({"type": "probe", "x": 0, "y": 1, "picks": 1})", "neither true nor false");
}

TEST(ParseCommand, RefusesWhatIsNotAMessage) {
  expect_refused("", "not JSON");
  expect_refused("{", "not JSON");
  expect_refused("\xff\xfe", "not JSON");
  expect_refused("[]", "not an object");
  expect_refused("7", "not an object");
  expect_refused("{}", "type is missing");
  expect_refused(R"({"type": 7})", "type is not a text");
  expect_refused(R"({"type": "steal"})", "type is not known");
  expect_refused("{\"type\": \"\\u0000\\n\"}", "type is not known");
}

TEST(ParseCommand, RefusesWrongMembers) {
  expect_refused(R"({"type": "turn", "x": 0.5})", "y is missing");
  expect_refused(R"({"type": "turn", "x": "0.5", "y": 0})", "x is not a number");
  expect_refused(R"({"type": "turn", "x": 1e300, "y": 0})", "x is 1e+300");
  expect_refused(R"({"type": "zoom", "factor": 0})", "factor is 0");
  expect_refused(R"({"type": "zoom", "factor": 1e999})", "not JSON");
  expect_refused(R"({"type": "size", "width": 0, "height": 10})", "width is 0");
  expect_refused(R"({"type": "size", "width": 8193, "height": 10})", "width is 8193");
  expect_refused(R"({"type": "size", "width": 10.5, "height": 10})", "not a whole number");
  expect_refused(R"({"type": "size", "width": 99999999999999999999, "height": 10})", "width is");
  expect_refused(R"({"type": "tolerance", "value": 0})", "value is 0");
  expect_refused(R"({"type": "undo", "steps": 2})", "steps is not a member");
  expect_refused(R"({"type": "look_from", "side": "inside"})", "must be one of front");
  expect_refused(R"({"type": "probe", "x": 1.01, "y": 0})", "x is 1.01");
  expect_refused(R"({"type": "edit", "layer": -1, "key": "a", "value": 0, "gesture": 1})", "layer");
  expect_refused(R"({"type": "histogram", "layer": 0, "channels": []})", "1 to 2 texts");
  expect_refused(R"({"type": "histogram", "layer": 0, "channels": ["a", 7]})", "list of texts");
  expect_refused(R"({"type": "error_map", "shown": 1})", "neither true nor false");
}

TEST(ParseCommand, RefusesWhatIsTooDeepOrTooLong) {
  const auto nested = [](int depth) {
    return R"({"type": "edit", "key": "clip", "gesture": 1, "value": )" +
           std::string(static_cast<std::size_t>(depth), '[') +
           std::string(static_cast<std::size_t>(depth), ']') + "}";
  };
  parsed<Edit>(nested(10));
  expect_refused(nested(20), "nested");
  expect_refused(nested(100000), "nested");
  expect_refused(std::string(largest_message + 1, ' '), "too long");
  const auto with_members = [](int count) {
    std::string text = R"({"type": "undo")";
    for (int i = 0; i < count; ++i) text += ", \"" + std::to_string(i) + "\": 0";
    return text + "}";
  };
  expect_refused(with_members(10), "0 is not a member");
  expect_refused(with_members(150000), "more than 1024 members");
}

}  // namespace
}  // namespace pellucid::view::command_test

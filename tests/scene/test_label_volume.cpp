// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/label_volume.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "expect_error.h"

namespace pellucid::test_label_volume {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class Value>
std::shared_ptr<const Volume> row(std::vector<Value> values, const std::string& name = "row") {
  Volume::Description d;
  d.dimensions = {static_cast<int>(values.size()), 1, 1};
  d.centering = Centering::cell;
  d.name = name;
  return std::make_shared<const Volume>(d, VolumeData(std::move(values)));
}

template <class Value>
std::vector<std::int32_t> labels_of(std::vector<Value> values) {
  return LabelVolume(row(std::move(values))).labels();
}

template <class Value>
std::string refusal(std::vector<Value> values, const std::string& name = "row") {
  return error_message([&] { LabelVolume(row(std::move(values), name)); });
}

std::shared_ptr<const TransferFunction> haze() {
  return std::make_shared<const TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 1, {1, 1, 1}}});
}

using Labels = std::vector<std::int32_t>;

TEST(LabelVolume, TakesWholeNumbersOfEveryType) {
  EXPECT_EQ(labels_of<std::uint8_t>({255, 0, 255, 7}), (Labels{0, 7, 255}));
  EXPECT_EQ(labels_of<std::int8_t>({-128, 127, -1}), (Labels{-128, -1, 127}));
  EXPECT_EQ(labels_of<std::uint16_t>({65535, 1}), (Labels{1, 65535}));
  EXPECT_EQ(labels_of<std::int16_t>({-32768, 1}), (Labels{-32768, 1}));
  EXPECT_EQ(labels_of<std::uint32_t>({16777216, 0}), (Labels{0, 16777216}));
  EXPECT_EQ(labels_of<std::int32_t>({-16777216, 16777216}), (Labels{-16777216, 16777216}));
  EXPECT_EQ(labels_of<float>({-0.0F, 3, -2, 3}), (Labels{-2, 0, 3}));
  EXPECT_EQ(labels_of<double>({1e7, -1e7}), (Labels{-10000000, 10000000}));
}

TEST(LabelVolume, RefusesOtherNumbers) {
  const std::string range =
      ", but labels are whole numbers from -16777216 to 16777216; show it as a field";
  EXPECT_EQ(refusal<float>({0, 1, 2.5F}), "row: holds the value 2.5" + range);
  EXPECT_EQ(refusal<double>({-1e-300}), "row: holds the value -1e-300" + range);
  EXPECT_EQ(refusal<std::uint32_t>({1, 16777217}), "row: holds the value 16777217" + range);
  EXPECT_EQ(refusal<std::int32_t>({-16777217}), "row: holds the value -16777217" + range);
  EXPECT_EQ(refusal<double>({0.5}, ""), "labels: holds the value 0.5" + range);
  EXPECT_EQ(error_message([] { LabelVolume(nullptr); }), "labels: there is no volume; give one");
}

TEST(LabelVolume, NanIsNoLabel) {
  EXPECT_EQ(labels_of<double>({nan, 4, nan, nan, 4}), (Labels{4}));
  EXPECT_EQ(labels_of<float>({std::numeric_limits<float>::quiet_NaN()}), Labels{});
}

TEST(LabelVolume, SharesTheVolumeAndMovesWithIt) {
  const auto volume = row<std::uint8_t>({3, 1, 3});
  const LabelVolume labels(volume);
  EXPECT_EQ(labels.shared_volume(), volume);
  Affine<double> to;
  to.matrix = {{{0, 2, 0}, {-4, 0, 0}, {0, 0, 0.5}}};
  to.translation = {1, 2, 3};
  const LabelVolume moved = labels.moved(to);
  EXPECT_EQ(moved.labels(), labels.labels());
  EXPECT_EQ(std::get<0>(moved.volume().data()).data(), std::get<0>(volume->data()).data());
  const auto before = volume->world_corners(), after = moved.volume().world_corners();
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(after[i], to.point(before[i])) << i;
  EXPECT_EQ(volume->world_corners(), before);
}

TEST(LabelTable, KeepsStylesByAscendingLabel) {
  const LabelTable table({{9, "c", {0, 0, 1}, 1}, {-3, "a", {1, 0, 0}, 2}, {0, "b", {}, 0}});
  ASSERT_EQ(table.styles().size(), 3U);
  EXPECT_EQ(table.styles()[0].name, "a");
  EXPECT_EQ(table.styles()[1].name, "b");
  EXPECT_EQ(table.styles()[2].name, "c");
  EXPECT_EQ(table.styles()[2].label, 9);
  EXPECT_EQ(table.styles()[2].color, (Rgb<double>{0, 0, 1}));
}

TEST(LabelTable, TheFunctionIsTheStyleAtALabelAndVacuumHalfWay) {
  // 4 and 5 are neighbors; 8 stands alone; 7 is transparent.
  const std::vector<LabelStyle> styles{{5, "", {0, 1, 0}, 2},         {4, "", {1, 0, 0}, 3},
                                       {8, "", {0.5, 0.25, 4}, 1e6},  {-2, "", {0, 0, 1}, 0.125},
                                       {-16777216, "", {1, 1, 0}, 7}, {16777216, "", {0, 1, 1}, 6},
                                       {7, "", {1, 1, 1}, 0}};
  const LabelTable table(styles);
  const PiecewiseLinear<double> function = table.function().view<double>();
  for (const LabelStyle& style : styles) {
    const double label = style.label;
    const Material<double> at = function.evaluate(label);
    EXPECT_EQ(at.extinction, style.extinction) << label;
    EXPECT_EQ(at.color, style.color) << label;
    for (const double half : {label - 0.5, label + 0.5}) {
      EXPECT_EQ(function.evaluate(half).extinction, 0) << half;
    }
    // The feet are straight and of one color.
    const Material<double> quarter = function.evaluate(label + 0.25);
    EXPECT_EQ(quarter.extinction, style.extinction / 2) << label;
    if (style.extinction == 0) continue;
    EXPECT_EQ(quarter.color, style.color) << label;
  }
  for (const double other : {-1e8, -3.0, -1.0, 0.0, 3.0, 6.0, 9.0, 1e8}) {
    EXPECT_EQ(function.evaluate(other).extinction, 0) << other;
  }
  EXPECT_EQ(table.function().largest_color(), 4);
  EXPECT_EQ(table.function().approximation_error(1), 0);
}

TEST(LabelTable, RefusesWhatIsNoLook) {
  const auto refusal_of = [](std::vector<LabelStyle> styles) {
    return error_message([&] { LabelTable(std::move(styles)); });
  };
  const std::string number = ", but must be a number from 0 to 2.1267646664908054e+37";
  EXPECT_EQ(refusal_of({}), "labels: no label has a color; give at least one");
  EXPECT_EQ(refusal_of({{1, "a", {}, 1}, {2, "", {}, 1}, {1, "b", {}, 2}}),
            "label 1: is there twice; remove one of them");
  EXPECT_EQ(refusal_of({{16777217, "", {}, 1}}),
            "label 16777217: labels are whole numbers from -16777216 to 16777216");
  EXPECT_EQ(refusal_of({{-16777217, "", {}, 1}}),
            "label -16777217: labels are whole numbers from -16777216 to 16777216");
  EXPECT_EQ(refusal_of({{1, "", {}, -1}}), "label 1: extinction is -1" + number);
  EXPECT_EQ(refusal_of({{1, "", {}, nan}}), "label 1: extinction is nan" + number);
  EXPECT_EQ(refusal_of({{1, "", {}, 1e38}}), "label 1: extinction is 1e+38" + number);
  EXPECT_EQ(refusal_of({{2, "", {-0.5, 0, 0}, 1}}), "label 2: color is -0.5" + number);
  EXPECT_EQ(refusal_of({{2, "", {0, infinity, 0}, 1}}), "label 2: color is inf" + number);
  EXPECT_EQ(refusal_of({{2, "", {0, 0, 1e38}, 1}}), "label 2: color is 1e+38" + number);
}

TEST(LabelMask, ChoosesAFunctionByLabel) {
  const auto labels = std::make_shared<const LabelVolume>(row<std::uint8_t>({0, 3, 5}));
  const auto first = haze(), second = haze();
  // A choice may be of a label that does not occur.
  const LabelMask mask(labels, {{3, first}, {-7, second}});
  EXPECT_EQ(&mask.labels(), labels.get());
  EXPECT_EQ(mask.choice_of(3), 0);
  EXPECT_EQ(mask.choice_of(-7), 1);
  EXPECT_EQ(mask.choice_of(5), -1);
  EXPECT_EQ(mask.choices()[0].transfer_function, first);
  EXPECT_EQ(mask.choices()[1].transfer_function, second);
  EXPECT_EQ(LabelMask(labels, {}).choice_of(0), -1);
}

TEST(LabelMask, RefusesIncompleteChoices) {
  const auto labels = std::make_shared<const LabelVolume>(row<std::uint8_t>({0, 3, 5}));
  EXPECT_EQ(error_message([&] {
              LabelMask(nullptr, {{3, haze()}});
            }),
            "mask: there are no labels; give a segmentation");
  EXPECT_EQ(error_message([&] {
              LabelMask(labels, {{3, haze()}, {5, nullptr}});
            }),
            "mask: label 5 has no transfer function; give one");
  EXPECT_EQ(error_message([&] {
              LabelMask(labels, {{3, haze()}, {5, haze()}, {3, haze()}});
            }),
            "mask: label 3 is there twice; remove one of them");
}

}  // namespace
}  // namespace pellucid::test_label_volume

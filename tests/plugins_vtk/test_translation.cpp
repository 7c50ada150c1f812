// SPDX-License-Identifier: Apache-2.0
//
// Numbers of VTK's objects, without objects: what the plug-in and the Python package translate by.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pellucid/math/constants.h"
#include "pellucid/scene/error.h"
#include "vtk_scene/functions.h"
#include "vtk_scene/hidden_places.h"
#include "vtk_scene/look.h"
#include "vtk_scene/placement.h"
#include "vtk_scene/view.h"

namespace pellucid::test {
namespace {

using namespace vtk_scene;  // NOLINT(google-build-using-namespace)

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr RampRange data_range = std::array<double, 2>{2, 10};

FunctionSettings function_of(std::vector<imported::ShapedNode> nodes) {
  FunctionSettings function;
  function.shape.nodes = std::move(nodes);
  return function;
}

struct Reader {
  KeptCurves kept;
  Notes notes;
  FunctionReader reader{1e-3, kept, notes};
};

TEST(VtkTranslation, AFunctionWithoutNodesIsARampInItsOwnColorSpace) {
  Reader r;
  EXPECT_EQ(r.reader.opacities(function_of({}), 1, data_range).points,
            (Curve{{2, {0, 0, 0}}, {10, {0.5, 0.5, 0.5}}}));
  EXPECT_EQ(r.reader.opacities(function_of({}), 1, {}).points, (Curve{{0, {0, 0, 0}}}));
  FunctionSettings lab;
  lab.shape.is_color = true;
  lab.shape.space = 2;
  const double middle = value_at(r.reader.colors(lab, data_range).points, 6).r;
  EXPECT_NEAR(middle, 0.4663, 1e-3);  // in RGB 0.5
}

TEST(VtkTranslation, NodesThatAreNoNumbersAreLeftOut) {
  Reader r;
  const auto one = function_of({{0, {0.1, 0.1, 0.1}}, {nan, {1, 1, 1}}, {4, {0.3, 0.3, 0.3}, nan}});
  EXPECT_EQ(r.reader.opacities(one, 1, data_range).points, (Curve{{0, {0.1, 0.1, 0.1}}}));
  EXPECT_EQ(r.notes.lines().size(), 1U);
  // A function that has nodes is no empty one.
  const auto none = function_of({{0, {nan, nan, nan}}});
  EXPECT_EQ(r.reader.opacities(none, 1, data_range).points, (Curve{{0, {0, 0, 0}}}));
}

TEST(VtkTranslation, NumbersOfNodesHaveLimits) {
  Reader r;
  const auto far = function_of({{-inf, {0, 0, 0}}, {0, {inf, inf, inf}}, {1e300, {0, 0, 0}}});
  const Curve curve = r.reader.opacities(far, inf, {}).points;
  EXPECT_EQ(curve.front().x, -2e37);
  EXPECT_EQ(curve.back().x, 2e37);
  EXPECT_EQ(value_at(curve, 0).r, 2e37);
}

TEST(VtkTranslation, WhereVtkHasNoNumberTheCurveIsShown) {
  Reader r;
  ComponentSettings look;
  look.opacity = function_of({{0, {0, 0, 0}, 0.3, 0.6}, {10, {1, 1, 1}}});
  look.opacity.own = [](double, double, int) { return std::vector<Rgb<double>>{{nan, nan, nan}}; };
  const FittedCurve curve = r.reader.opacities(look.opacity, 1, {});
  for (const double x : {1.0, 2.5, 6.0}) {
    EXPECT_EQ(r.reader.opacity_at(look.opacity, {}, x), value_at(curve.points, x).r);
  }
  look.opacity.own = [](double x, double, int) { return std::vector<Rgb<double>>{{x, x, x}}; };
  EXPECT_EQ(r.reader.opacity_at(look.opacity, {}, 0.25), 0.25);
  EXPECT_EQ(r.reader.opacity_at(look.opacity, {}, -3), 0);
}

CameraSettings camera() {
  CameraSettings made;
  made.position = {0, 0, 10};
  made.up = {0, 1, 0};
  made.direction = {0, 0, -1};
  made.projection = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.5, -5, 0, 0, -1, 0};
  return made;
}

ViewSettings view() {
  ViewSettings made;
  made.camera = camera();
  made.width = made.height = 64;
  return made;
}

TEST(VtkTranslation, AProjectionIsACamera) {
  Notes notes;
  const View made = view_of(view(), notes);
  EXPECT_DOUBLE_EQ(made.camera.vertical_angle, 90);
  EXPECT_DOUBLE_EQ(made.depths.near, 2);
  EXPECT_DOUBLE_EQ(made.depths.far, 10);
  EXPECT_FALSE(made.is_cut());
  EXPECT_EQ(depth_clips(made, {-1, 1, -1, 1, -1, 9}).size(), 2U);
  EXPECT_EQ(depth_clips(made, {-1, 1, -1, 1, 1, 7}).size(), 0U);
  ViewSettings moved = view();
  moved.camera.projection[2] = 0.25;
  EXPECT_TRUE(view_of(moved, notes).is_cut());
  EXPECT_TRUE(notes.lines().empty());
}

TEST(VtkTranslation, ProjectionsThatAreNoneAreRefused) {
  Notes notes;
  ViewSettings behind = view();
  behind.camera.projection[11] = 5;
  EXPECT_THROW(view_of(behind, notes), Error);
  ViewSettings sheared = view();
  sheared.camera.shear = {0.1, 0};
  EXPECT_THROW(view_of(sheared, notes), Error);
  ViewSettings turned = view();
  turned.camera.model = Matrix{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_THROW(view_of(turned, notes), Error);
}

TEST(VtkTranslation, LightsThatAreOnAreThoseOfTheScene) {
  Notes notes;
  RendererLights lights;
  EXPECT_EQ(lights_of(lights, camera(), true, notes).size(), 1U);
  lights.are_automatic = false;
  EXPECT_TRUE(lights_of(lights, camera(), true, notes).empty());
  // One that is on, and no light of a scene, keeps VTK's own away.
  lights.are_automatic = true;
  LightSettings odd;
  odd.position = {nan, 0, 0};
  lights.shining = {odd};
  EXPECT_TRUE(lights_of(lights, camera(), true, notes).empty());
  EXPECT_EQ(notes.lines().size(), 1U);
  lights.shining[0].position = {1, 0, 0};
  lights.shining[0].intensity = -2;
  EXPECT_EQ(lights_of(lights, camera(), true, notes).at(0).color, (Rgb<double>{0, 0, 0}));
}

TEST(VtkTranslation, ALineOnTheHeadLightComesWithOne) {
  Notes notes;
  CameraSettings parallel = camera();
  parallel.is_parallel = true;
  RendererLights lights;
  lights.shining = {LightSettings{}};
  lights.shining[0].position = {1, 0, 0};
  lights_of(lights, parallel, true, notes);
  EXPECT_TRUE(notes.lines().empty());
  lights.shining[0].is_head = true;
  const std::vector<Light> made = lights_of(lights, parallel, true, notes);
  EXPECT_EQ(made.at(0).kind,
            (std::variant<HeadLight, DirectionalLight, PointLight>(PointLight{parallel.position})));
  EXPECT_EQ(notes.lines().size(), 1U);
}

TEST(VtkTranslation, MarksAreOfPointsOrOfCells) {
  // 2 x 1 x 1 cells.
  const std::vector<unsigned char> cells{hidden_cell, 0};
  std::vector<unsigned char> points(12);
  const auto hidden = [&](bool of_cells) {
    return hidden_places(points, cells, {2, 1, 1}, of_cells, "grid");
  };
  EXPECT_EQ(hidden(true), (std::vector<bool>{true, false}));
  // The points that the second cell has, too, are seen.
  EXPECT_EQ(hidden(false), (std::vector<bool>{true, false, false, true, false, false, true, false,
                                              false, true, false, false}));
  points[2] = hidden_point;
  EXPECT_EQ(hidden(true), (std::vector<bool>{true, true}));
  points.resize(11);
  EXPECT_THROW(hidden(true), Error);
}

TEST(VtkTranslation, AFaceBesideGhostsBelongsToTheCellsAboveIt) {
  // Of 4 x 2 x 2 cells of size 1 the middle ones along x are its own.
  std::vector<unsigned char> flags;
  for (int i = 0; i < 16; ++i) flags.push_back(i % 4 == 1 || i % 4 == 2 ? 0 : duplicate_cell);
  const std::array<int, 3> sides{4, 2, 2};
  const GhostCells ghosts{own_cells(flags, sides), sides, [](const std::array<int, 3>& at) {
                            return Vec3<double>{1.0 * at[0], 1.0 * at[1], 1.0 * at[2]};
                          }};
  const auto clips = clips_at_ghosts(ghosts, {}, "grid");
  ASSERT_TRUE(clips && clips->size() == 2);
  const auto& low = std::get<ClipPlane>((*clips)[0].shape);
  const auto& high = std::get<ClipPlane>((*clips)[1].shape);
  EXPECT_EQ(low.point.x, 1 - 0x1p-20);
  EXPECT_EQ(high.point.x, 3 - 0x1p-20);
  EXPECT_GT(low.normal.x, 0);
  EXPECT_LT(high.normal.x, 0);
  flags[0] = 0;
  EXPECT_THROW(clips_at_ghosts({own_cells(flags, sides), sides, ghosts.point}, {}, "grid"), Error);
  EXPECT_FALSE(clips_at_ghosts(
      {own_cells(std::vector<unsigned char>(16, 1), sides), sides, ghosts.point}, {}, "grid"));
}

TEST(VtkTranslation, SpacingsBelow0TurnTheirAxis) {
  ImageSettings image;
  image.origin = {1, 2, 3};
  image.spacing = {-2, 1, 1};
  image.first = {3, 0, 0};
  const GridPlacement placement = placement_of(image, true);
  EXPECT_EQ(placement.spacing, (Vec3<double>{2, 1, 1}));
  EXPECT_EQ(placement.direction.column[0], (Vec3<double>{-1, 0, 0}));
  EXPECT_EQ(placement.origin, (Vec3<double>{-6, 2.5, 3.5}));
}

}  // namespace
}  // namespace pellucid::test

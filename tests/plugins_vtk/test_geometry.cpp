// SPDX-License-Identifier: Apache-2.0
//
// Volumes among geometry, in parts of windows, and several of them.
#include <gtest/gtest.h>
#include <vtkActor.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkFloatArray.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkMatrix4x4.h>
#include <vtkMultiVolume.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>
#include <vtkUniformGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <array>
#include <limits>
#include <string>

#include "mapper_core.h"
#include "pellucid/cpu/render.h"
#include "pellucid/math/constants.h"
#include "tests/plugins_vtk/stage.h"
#include "vtkPellucidFactory.h"
#include "vtkPellucidVolumeMapper.h"

namespace pellucid::test {
namespace {

constexpr double half_a_step = 0.5 / 255;
constexpr double rounding = 1.0 / 32767;

std::array<double, 3> beside_middle(vtkVolume& volume, double along_x) {
  const double* const middle = volume.GetCenter();
  return {middle[0] + along_x, middle[1], middle[2]};
}

/// A red ball without light.
vtkSmartPointer<vtkActor> red_ball(const std::array<double, 3>& center, double radius) {
  vtkNew<vtkSphereSource> source;
  source->SetCenter(center[0], center[1], center[2]);
  source->SetRadius(radius);
  source->SetThetaResolution(200);
  source->SetPhiResolution(200);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetColor(1, 0, 0);
  return actor;
}

/// Where the ray meets the ball first; infinite: nowhere.
double distance_to_ball(const Ray<double>& ray, const Vec3<double>& center, double radius) {
  const Vec3<double> offset = ray.origin - center;
  const double b = dot(offset, ray.direction), c = dot(offset, offset) - radius * radius;
  const double root = b * b - c;
  if (root < 0) return std::numeric_limits<double>::infinity();
  return -b - std::sqrt(root);
}

/// The scene with a ball that no depth buffer has seen: its depths are those of a true ball.
Image truth_with_ball(Scene scene, const Vec3<double>& center, double radius) {
  scene.integration.tolerance = 1e-5;
  auto geometry = std::make_shared<Image>();
  geometry->width = scene.size.width;
  geometry->height = scene.size.height;
  const CameraFrame<double> frame = make_camera_frame(scene.camera, scene.size);
  for (int y = 0; y < scene.size.height; ++y) {
    for (int x = 0; x < scene.size.width; ++x) {
      const double t = distance_to_ball(frame.ray(x, y), center, radius);
      const bool hit = std::isfinite(t);
      geometry->pixels.push_back({hit ? 1.0F : 0.0F, 0, 0, hit ? 1.0F : 0.0F});
      geometry->depth.push_back(static_cast<float>(t));
    }
  }
  scene.backdrop = geometry;
  return render(scene).image;
}

struct BallCase {
  const char* name;
  double azimuth, elevation;
  bool parallel;
  double view_angle = 30;
};

void PrintTo(const BallCase& ball, std::ostream* to) {
  *to << ball.name;
}

class VtkDepth : public testing::TestWithParam<BallCase> {};

TEST_P(VtkDepth, ABallHalfInTheVolumeIsSeenThroughIt) {
  Stage stage(128, 96);
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(ball_image());
  vtkVolume* const volume = stage.add(mapper, soft_property(4));
  const std::array<double, 3> center = beside_middle(*volume, 10);
  const double radius = 9;
  stage.renderer->AddActor(red_ball(center, radius));
  stage.camera->SetParallelProjection(GetParam().parallel ? 1 : 0);
  stage.camera->SetViewAngle(GetParam().view_angle);
  stage.look(GetParam().azimuth, GetParam().elevation);
  const Image shown = stage.picture();
  EXPECT_EQ(stage.gl_errors(), "");
  const Scene scene = mapper->GetCore().scene_of(*mapper, {}, *stage.renderer, *volume);
  const Vec3<double> middle{center[0], center[1], center[2]};
  const Image truth = truth_with_ball(scene, middle, radius);
  // Pixels at the silhouette see the facets, not the ball.
  const CameraFrame<double> frame = make_camera_frame(scene.camera, scene.size);
  const auto apart = [&](int x, int y) {
    const Ray<double> ray = frame.ray(x, y);
    const Vec3<double> to = middle - ray.origin;
    const double along = dot(to, ray.direction);
    const double across = std::sqrt(dot(to, to) - along * along);
    return std::abs(across / radius - 1) > 0.1;
  };
  // The ball is one of facets, up to 1.2e-4 of its radius inside; depths have 24 bits.
  const double facets = 2e-3;
  EXPECT_LE(largest_difference(shown, truth, apart),
            half_a_step + mapper->GetTolerance() + rounding + facets);
  // Rays end at the ball, measured along them.
  plugin::Notes notes;
  const auto geometry =
      plugin::geometry_of(*stage.renderer, plugin::view_of(*stage.renderer, notes));
  EXPECT_TRUE(notes.lines().empty());
  ASSERT_NE(geometry, nullptr);
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 128; ++x) {
      const double end = double{geometry->depth[static_cast<std::size_t>(128 * y + x)]};
      const double wanted = distance_to_ball(frame.ray(x, y), middle, radius);
      if (!apart(x, y)) continue;
      EXPECT_EQ(std::isinf(end), std::isinf(wanted)) << x << ' ' << y;
      if (std::isfinite(end) && std::isfinite(wanted)) {
        EXPECT_NEAR(end, wanted, 0.01) << x << ' ' << y;
      }
    }
  }
  // It is no test if the ball is not seen, or the volume is not in front of it.
  double most_red = 0, hidden_red = 1;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 128; ++x) {
      const double t = distance_to_ball(frame.ray(x, y), middle, radius);
      if (std::isinf(t)) continue;
      most_red = std::max(most_red, double{shown.at(x, y)[0]} - double{shown.at(x, y)[1]});
      hidden_red = std::min(hidden_red, double{shown.at(x, y)[0]} - double{shown.at(x, y)[1]});
    }
  }
  EXPECT_GT(most_red, 0.5);
  EXPECT_LT(hidden_red, GetParam().azimuth < 0 ? 0.75 : 0.99);
}

INSTANTIATE_TEST_SUITE_P(Sides, VtkDepth,
                         testing::Values(BallCase{"front", 60, 20, false},
                                         BallCase{"back", -75, 10, false},
                                         BallCase{"parallel_front", 60, 20, true},
                                         BallCase{"parallel_back", -75, 10, true},
                                         BallCase{"wide", -20, -15, false, 110}),
                         [](const auto& made) { return std::string(made.param.name); });

TEST(VtkGeometry, AMultisampledWindowHasTheSamePicture) {
  Image pictures[2];
  for (const int samples : {0, 8}) {
    Stage stage;
    stage.window->SetMultiSamples(samples);
    vtkNew<vtkPellucidVolumeMapper> mapper;
    mapper->SetInputData(ball_image());
    const auto center = beside_middle(*stage.add(mapper, soft_property(4)), 10);
    stage.renderer->AddActor(red_ball(center, 9));
    stage.look();
    pictures[samples / 8] = stage.picture();
    EXPECT_EQ(stage.gl_errors(), "");
  }
  // But for the silhouette of the ball.
  int differ = 0;
  for (std::size_t i = 0; i < pictures[0].pixels.size(); ++i) {
    double off = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      off = std::max(off,
                     std::abs(double{pictures[0].pixels[i][c]} - double{pictures[1].pixels[i][c]}));
    }
    if (off > 2.1 / 255) ++differ;
  }
  EXPECT_LE(differ, 200);
}

TEST(VtkGeometry, TranslucentGeometryIsSaidToLieBehind) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(ball_image());
  const auto center = beside_middle(*stage.add(mapper, soft_property()), 0);
  const auto ball = red_ball(center, 9);
  ball->GetProperty()->SetOpacity(0.5);
  stage.renderer->AddActor(ball);
  stage.look();
  const Messages messages;
  stage.picture();
  stage.picture();
  const std::string said = messages.text();
  const auto at = said.find("translucent geometry lies behind");
  ASSERT_NE(at, std::string::npos) << said;
  EXPECT_EQ(said.find("translucent geometry lies behind", at + 1), std::string::npos);
}

TEST(VtkGeometry, ARendererFillsItsHalfOfTheWindow) {
  Stage stage(120, 64);
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(ball_image());
  vtkVolume* const volume = stage.add(mapper, soft_property());
  stage.renderer->SetViewport(0.5, 0.25, 1, 1);
  stage.look();
  const Image shown = stage.picture();
  Scene scene = mapper->GetCore().scene_of(*mapper, {}, *stage.renderer, *volume);
  ASSERT_EQ(scene.size.width, 60);
  ASSERT_EQ(scene.size.height, 48);
  scene.integration.tolerance = 1e-5;
  const Image part = render(scene).image;
  Image truth;
  truth.width = 120;
  truth.height = 64;
  truth.pixels.resize(120 * 64);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 60; ++x) truth.at(60 + x, y) = part.at(x, y);
  }
  EXPECT_LE(largest_difference(shown, truth), half_a_step + mapper->GetTolerance() + rounding);
}

TEST(VtkGeometry, VolumesAreDrawnOneOverTheOther) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> first, second;
  first->SetInputData(ball_image());
  second->SetInputData(ball_image());
  vtkVolume* const one = stage.add(first, soft_property());
  vtkVolume* const two = stage.add(second, soft_property(5));
  two->SetPosition(30, 0, 0);
  stage.look();
  const Image shown = stage.picture();
  Scene scene = first->GetCore().scene_of(*first, {}, *stage.renderer, *one);
  scene.integration.tolerance = 1e-5;
  const Image below = render(scene).image;
  scene = second->GetCore().scene_of(*second, {}, *stage.renderer, *two);
  scene.integration.tolerance = 1e-5;
  Image truth = render(scene).image;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    const float clear = 1 - truth.pixels[i][3];
    for (std::size_t c = 0; c < 4; ++c) truth.pixels[i][c] += clear * below.pixels[i][c];
  }
  // Two pictures are rounded to 8 bits.
  EXPECT_LE(largest_difference(shown, truth), 2 * (half_a_step + first->GetTolerance() + rounding));
}

TEST(VtkGeometry, TheVolumesOfAMultiVolumeMix) {
  vtkPellucidFactory::Use();
  vtkNew<vtkGPUVolumeRayCastMapper> mapper;
  vtkPellucidFactory::Use(false);
  Stage stage;
  vtkNew<vtkMultiVolume> several;
  several->SetMapper(mapper);
  vtkNew<vtkVolume> parts[2];
  for (int i = 0; i < 2; ++i) {
    mapper->SetInputDataObject(i, ball_image());
    parts[i]->SetProperty(soft_property(i + 2));
    parts[i]->SetPosition(8 * i, 0, 0);
    several->SetVolume(parts[i], i);
  }
  stage.renderer->AddVolume(several);
  stage.look();
  const Messages messages;
  const Image shown = stage.picture();
  EXPECT_EQ(messages.text(), "");
  // The two layers as a scene of their own.
  Scene scene;
  for (int i = 0; i < 2; ++i) {
    vtkNew<vtkPellucidVolumeMapper> one;
    one->SetInputData(ball_image());
    parts[i]->SetMapper(one);
    const Scene made = one->GetCore().scene_of(*one, {}, *stage.renderer, *parts[i]);
    std::vector<Layer> layers = scene.layers;
    layers.push_back(made.layers.at(0));
    scene = made;
    scene.layers = layers;
  }
  scene.integration.tolerance = 2e-4;
  EXPECT_LE(largest_difference(shown, render(scene).image),
            half_a_step + default_tolerance + rounding + 2 * default_tolerance / 8 + 2e-4);
}

struct TileCase {
  const char* name;
  int width, height;
  double viewport[4];
  bool with_ball = false;
  int most = 3;  ///< tiles along each axis
};

void PrintTo(const TileCase& tiles, std::ostream* to) {
  *to << tiles.name;
}

class VtkTiles : public testing::TestWithParam<TileCase> {};

/// Tiles of a picture twice and three times as large make the picture of a larger window.
TEST_P(VtkTiles, MakeALargePicture) {
  const TileCase& tiles = GetParam();
  for (int scale = 2; scale <= tiles.most; ++scale) {
    Stage stage(tiles.width, tiles.height), large(tiles.width * scale, tiles.height * scale);
    for (Stage* const each : {&stage, &large}) {
      vtkNew<vtkPellucidVolumeMapper> mapper;
      mapper->SetInputData(ball_image());
      const auto center = beside_middle(*each->add(mapper, soft_property(4)), 10);
      if (tiles.with_ball) each->renderer->AddActor(red_ball(center, 9));
      const double* const v = tiles.viewport;
      each->renderer->SetViewport(v[0], v[1], v[2], v[3]);
      each->look();
    }
    const Image truth = large.picture();
    stage.window->Render();
    vtkNew<vtkWindowToImageFilter> filter;
    filter->SetInput(stage.window);
    filter->SetScale(scale);
    filter->ReadFrontBufferOff();
    const Messages messages;
    filter->Update();
    EXPECT_EQ(messages.text(), "");
    vtkImageData* const made = filter->GetOutput();
    ASSERT_EQ(made->GetDimensions()[0], tiles.width * scale);
    // Outside of the renderer VTK leaves what former tiles have drawn.
    const int* const origin = large.renderer->GetOrigin();
    const int* const size = large.renderer->GetSize();
    int differ = 0, seen = 0;
    for (int y = truth.height - origin[1] - size[1]; y < truth.height - origin[1]; ++y) {
      for (int x = origin[0]; x < origin[0] + size[0]; ++x) {
        double off = 0;
        for (int c = 0; c < 3; ++c) {
          const double value = made->GetScalarComponentAsDouble(x, truth.height - 1 - y, 0, c);
          off = std::max(
              off, std::abs(value / 255 - double{truth.at(x, y)[static_cast<std::size_t>(c)]}));
        }
        if (off > 2.1 / 255) ++differ;
        if (truth.at(x, y)[0] > 0.1F) ++seen;
      }
    }
    // Pixels at the ball's silhouette may differ.
    EXPECT_LE(differ, tiles.with_ball ? 40 * scale : 0) << scale;
    EXPECT_GT(seen, 100 * scale);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Parts, VtkTiles,
    testing::Values(TileCase{"whole", 48, 40, {0, 0, 1, 1}},
                    TileCase{"with_a_ball", 48, 40, {0, 0, 1, 1}, true},
                    TileCase{"quarter", 80, 64, {0.5, 0.25, 1, 1}},
                    // Parts of 39 rows of 78: half a pixel from the middle of a pixel.
                    TileCase{"odd", 50, 52, {0.1, 0.125, 0.9, 0.875}, false, 2},
                    TileCase{"odd_with_a_ball", 50, 52, {0.1, 0.125, 0.9, 0.875}, true, 2},
                    TileCase{"odd_columns", 50, 40, {0.1, 0, 0.9, 1}}),
    [](const auto& made) { return std::string(made.param.name); });

TEST(VtkGeometry, AWindowCenterBetweenPixelsIsTakenToHalfOfOneAndSaid) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(ball_image());
  stage.add(mapper, soft_property(4));
  stage.look();
  stage.camera->SetWindowCenter(5.0 / 96, 3.0 / 64);
  Image half;
  {
    const Messages messages;
    half = stage.picture();
    EXPECT_EQ(messages.text(), "");
  }
  stage.camera->SetWindowCenter(5.2 / 96, 2.9 / 64);
  const Messages messages;
  EXPECT_EQ(largest_difference(stage.picture(), half), 0);
  EXPECT_NE(messages.text().find("nearest half of a pixel"), std::string::npos);
  stage.camera->SetWindowCenter(0, 0);
  EXPECT_GT(largest_difference(stage.picture(), half), 0.01);
}

/// Part of an image, with ghost cells beyond the own ones, of indices along x.
vtkSmartPointer<vtkImageData> part_of(vtkImageData* whole, int first, int last, int own_first,
                                      int own_last) {
  auto part = vtkSmartPointer<vtkImageData>::New();
  part->DeepCopy(whole);
  int extent[6];
  part->GetExtent(extent);
  extent[0] = first;
  extent[1] = last;
  part->Crop(extent);
  extent[0] = own_first;
  extent[1] = own_last;
  part->GenerateGhostArray(extent);
  return part;
}

/// Gives an image rough values in its cells in place of those at points.
void give_to_cells(vtkImageData& image) {
  vtkNew<vtkFloatArray> values;
  for (vtkIdType i = 0; i < image.GetNumberOfCells(); ++i) {
    values->InsertNextValue(static_cast<float>(20 + (i * 7919) % 80));
  }
  image.GetCellData()->SetScalars(values);
  image.GetPointData()->SetScalars(nullptr);
}

/// Two parts of an image, each with a layer of ghosts of the other, as the volumes of one.
class VtkGhosts : public testing::TestWithParam<bool> {};

TEST_P(VtkGhosts, PartsWithGhostsAreTheWhole) {
  const bool of_cells = GetParam();
  const auto image = ball_image();
  if (of_cells) give_to_cells(*image);
  const auto property = soft_property(4);
  property->SetShade(of_cells ? 0 : 1);
  const auto turn = [](vtkVolume& volume) {
    volume.SetOrientation(20, 30, 40);
    volume.SetScale(1.25);
    volume.SetPosition(3, 4, 5);
  };
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(image);
  if (of_cells) mapper->SetScalarModeToUseCellData();
  vtkVolume* const volume = stage.add(mapper, property);
  turn(*volume);
  stage.look();
  const Image whole = stage.picture();
  const auto shown = [&](bool with_ghosts) {
    const auto left = part_of(image, 0, 13, 0, 12), right = part_of(image, 11, 23, 12, 23);
    vtkNew<vtkVolume> both[2];
    vtkPellucidFactory::Use();
    vtkNew<vtkGPUVolumeRayCastMapper> several_mapper;
    vtkPellucidFactory::Use(false);
    vtkNew<vtkMultiVolume> several;
    several->SetMapper(several_mapper);
    for (int i = 0; i < 2; ++i) {
      const auto part = i == 0 ? left : right;
      if (!with_ghosts) part->GetCellData()->RemoveArray("vtkGhostType");
      several_mapper->SetInputDataObject(i, part);
      both[i]->SetProperty(property);
      turn(*both[i]);
      several->SetVolume(both[i], i);
    }
    if (of_cells) several_mapper->SetScalarModeToUseCellData();
    stage.renderer->RemoveAllViewProps();
    stage.renderer->AddVolume(several);
    const Image picture = stage.picture();
    stage.renderer->RemoveAllViewProps();
    return picture;
  };
  const Messages messages;
  EXPECT_LE(largest_difference(shown(true), whole),
            2 * (half_a_step + default_tolerance + rounding));
  EXPECT_EQ(messages.text(), "");
  EXPECT_GT(largest_difference(shown(false), whole), 0.03);
}

INSTANTIATE_TEST_SUITE_P(Data, VtkGhosts, testing::Bool(),
                         [](const auto& made) { return made.param ? "cells" : "lit_points"; });

TEST(VtkGhostCells, AGridOfGhostsAloneShowsNothing) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(part_of(ball_image(), 0, 6, 6, 6));
  stage.add(mapper, soft_property(4));
  stage.look();
  const Messages messages;
  const Image picture = stage.picture();
  EXPECT_EQ(messages.text(), "");
  for (const std::array<float, 4>& pixel : picture.pixels) ASSERT_EQ(pixel[0], 0);
  EXPECT_TRUE(mapper->GetExact());
  EXPECT_EQ(mapper->GetLargestError(), 0);
}

TEST(VtkGhostCells, OwnCellsThatFillNoBoxAreRefused) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  const auto image = part_of(ball_image(), 0, 23, 0, 12);
  image->GetCellGhostArray()->SetValue(5, vtkDataSetAttributes::DUPLICATECELL);
  mapper->SetInputData(image);
  stage.add(mapper, soft_property(4));
  stage.look();
  const Messages messages;
  stage.picture();
  EXPECT_NE(messages.text().find("do not fill a box"), std::string::npos) << messages.text();
}

/// Cells or points of an image that its flags hide, and what is then left of it.
struct HiddenCase {
  const char* name;
  bool hides_points;
  bool of_cells;
};

void PrintTo(const HiddenCase& shown, std::ostream* to) {
  *to << shown.name;
}

class VtkHidden : public testing::TestWithParam<HiddenCase> {};

/// Everything up to the sixth cell along x.
TEST_P(VtkHidden, PlacesAreVacuum) {
  const HiddenCase& shown = GetParam();
  const auto image = ball_image();
  if (shown.of_cells) give_to_cells(*image);
  const auto hidden = vtkSmartPointer<vtkUniformGrid>::New();
  hidden->DeepCopy(image);
  int sides[3];
  image->GetDimensions(sides);
  const vtkIdType across = shown.hides_points ? sides[0] : sides[0] - 1;
  const vtkIdType count =
      shown.hides_points ? hidden->GetNumberOfPoints() : hidden->GetNumberOfCells();
  for (vtkIdType i = 0; i < count; ++i) {
    if (i % across > 5) continue;
    if (shown.hides_points) hidden->BlankPoint(i);
    if (!shown.hides_points) hidden->BlankCell(i);
  }
  // Point 5 hides the cells around it, the last of which is cell 5.
  const double left = shown.of_cells ? 6.5 : 6;
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(image);
  if (shown.of_cells) mapper->SetScalarModeToUseCellData();
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(3 + left, 0, 0);
  plane->SetNormal(1, 0, 0);
  mapper->AddClippingPlane(plane);
  stage.add(mapper, soft_property(4));
  stage.look();
  const Image expected = stage.picture();
  mapper->RemoveAllClippingPlanes();
  const Messages messages;
  EXPECT_GT(largest_difference(stage.picture(), expected), 0.03);
  mapper->SetInputData(hidden);
  EXPECT_LE(largest_difference(stage.picture(), expected), 2 * (half_a_step + default_tolerance));
  vtkUnsignedCharArray* const flags =
      shown.hides_points ? hidden->GetPointGhostArray() : hidden->GetCellGhostArray();
  flags->FillValue(0);
  flags->Modified();
  EXPECT_GT(largest_difference(stage.picture(), expected), 0.03);
  EXPECT_EQ(messages.text(), "");
}

INSTANTIATE_TEST_SUITE_P(Data, VtkHidden,
                         testing::Values(HiddenCase{"points", true, false},
                                         HiddenCase{"cells_of_points", false, false},
                                         HiddenCase{"points_of_cells", true, true},
                                         HiddenCase{"cells", false, true}),
                         [](const auto& made) { return std::string(made.param.name); });

TEST(VtkHiddenCells, BetweenOthersAreRefusedWithValuesAtPoints) {
  Stage stage;
  vtkNew<vtkPellucidVolumeMapper> mapper;
  vtkNew<vtkUniformGrid> grid;
  grid->DeepCopy(ball_image());
  grid->BlankCell(grid->GetNumberOfCells() / 2);
  mapper->SetInputData(grid);
  stage.add(mapper, soft_property(4));
  stage.look();
  const Messages messages;
  stage.picture();
  EXPECT_NE(messages.text().find("hides cells between others"), std::string::npos)
      << messages.text();
}

/// A camera of which an explicit matrix is known to be the same.
struct LensCase {
  const char* name;
  bool parallel;
  double center_x = 0, center_y = 0;
  bool no_end = false;  ///< the far plane is infinitely far
};

void PrintTo(const LensCase& lens, std::ostream* to) {
  *to << lens.name;
}

class VtkExplicitProjection : public testing::TestWithParam<LensCase> {};

TEST_P(VtkExplicitProjection, ShowsWhatTheSameCameraShows) {
  const LensCase& lens = GetParam();
  Stage stage(96, 64);
  vtkNew<vtkPellucidVolumeMapper> mapper;
  mapper->SetInputData(ball_image());
  vtkVolume* const volume = stage.add(mapper, soft_property(4));
  stage.renderer->AddActor(red_ball(beside_middle(*volume, 10), 9));
  stage.camera->SetParallelProjection(lens.parallel ? 1 : 0);
  stage.look(40, 10);
  // In whole pixels: 12 and 8.
  stage.camera->SetWindowCenter(lens.center_x, lens.center_y);
  const Image by_angle = stage.picture();

  double near, far;
  stage.camera->GetClippingRange(near, far);
  const double aspect = 96.0 / 64;
  const double half = std::tan(stage.camera->GetViewAngle() * pi<double> / 360);
  const double scale = stage.camera->GetParallelScale();
  vtkNew<vtkMatrix4x4> matrix;
  matrix->Zero();
  if (lens.parallel) {
    // An orthographic frustum, whose matrix is written out.
    matrix->SetElement(0, 0, 1 / (scale * aspect));
    matrix->SetElement(1, 1, 1 / scale);
    matrix->SetElement(0, 3, -lens.center_x);
    matrix->SetElement(1, 3, -lens.center_y);
    matrix->SetElement(2, 2, -2 / (far - near));
    matrix->SetElement(2, 3, -(far + near) / (far - near));
    matrix->SetElement(3, 3, 1);
  } else {
    matrix->SetElement(0, 0, 1 / (half * aspect));
    matrix->SetElement(1, 1, 1 / half);
    matrix->SetElement(0, 2, lens.center_x);
    matrix->SetElement(1, 2, lens.center_y);
    matrix->SetElement(2, 2, lens.no_end ? -1 : -(far + near) / (far - near));
    matrix->SetElement(2, 3, lens.no_end ? -2 * near : -2 * far * near / (far - near));
    matrix->SetElement(3, 2, -1);
  }
  stage.camera->SetExplicitProjectionTransformMatrix(matrix);
  stage.camera->UseExplicitProjectionTransformMatrixOn();
  // None of these counts now.
  stage.camera->SetViewAngle(77);
  stage.camera->SetParallelScale(123);
  stage.camera->SetClippingRange(near + 0.4 * (far - near), near + 0.5 * (far - near));
  stage.camera->SetWindowCenter(0.3, 0.3);
  const Messages messages;
  const Image by_matrix = stage.picture();
  EXPECT_EQ(messages.text(), "");
  EXPECT_EQ(stage.gl_errors(), "");
  // Rays end at the red ball's facets by depths of 24 bits, which differ without a far plane.
  EXPECT_LE(largest_difference(by_matrix, by_angle), 1.01 / 255);
  double most = 0;
  for (const std::array<float, 4>& pixel : by_matrix.pixels)
    most = std::max(most, double{pixel[0]});
  EXPECT_GT(most, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Lenses, VtkExplicitProjection,
                         testing::Values(LensCase{"perspective", false},
                                         LensCase{"aside", false, 0.25, -0.25},
                                         LensCase{"without_a_far_plane", false, 0, 0, true},
                                         LensCase{"parallel", true},
                                         LensCase{"parallel_aside", true, 0.25, -0.25}),
                         [](const auto& made) { return std::string(made.param.name); });

}  // namespace
}  // namespace pellucid::test

// SPDX-License-Identifier: Apache-2.0
//
// Fields of one's own: what they show is what a grid with the same data shows, and a promise that
// is broken is one clear error.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "pellucid/cpu/renderer.h"
#include "pellucid/scene/error.h"
#include "tests/scenes/grid_source.h"
#include "tests/scenes/makers.h"

namespace pellucid::test_stretch_source {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using Points = scenes::Points;

scenes::VolumePointer wave(double turn, std::array<int, 3> dimensions = {9, 11, 8}) {
  return scenes::sampled(
      dimensions,
      [turn](double x, double y, double z) {
        return 100 + 90 * std::sin(3 * x + turn * y) * std::cos(2 * z - turn);
      },
      "wave");
}

Points hills() {
  return {{60, 0, {1, 0.2, 0}}, {100, 2, {0, 1, 0.3}},   {110, 0, {1, 1, 1}},
          {150, 0, {1, 1, 1}},  {150, 0.6, {0, 0.4, 1}}, {190, 2, {1, 1, 0}}};
}

Layer layer(double turn = 1, Points points = hills()) {
  return {VolumeContent{wave(turn), scenes::transfer(std::move(points)), nullptr}};
}

Scene seen(std::vector<Layer> layers) {
  Scene scene;
  scene.layers = std::move(layers);
  scene.camera.position = {2.1, 1.7, 3.3};
  scene.camera.focal_point = {0.1, 0, 0};
  scene.camera.vertical_angle = 36;
  scene.size = {14, 14};
  return scene;
}

Image frame(const Scene& scene, std::optional<InstructionSet> set, int threads = 1) {
  RenderOptions options;
  options.outputs.error = true;
  options.machine.threads = threads;
  options.machine.instruction_set = set;
  return render(scene, options).image;
}

/// Expects the same picture, one ray at a time and in packets.
void expect_alike(Scene own, Scene of_grids) {
  of_grids.integration.tolerance = 1e-6;
  const Image truth = frame(of_grids, InstructionSet::scalar);
  double largest = 0;
  for (const double tolerance : {1e-6, 1e-3}) {
    for (const bool one_by_one : {true, false}) {
      own.integration.tolerance = tolerance;
      const auto set = one_by_one ? std::optional(InstructionSet::scalar) : std::nullopt;
      const Image image = frame(own, set);
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const double said = double{image.error[i]} + double{truth.error[i]};
        EXPECT_LE(image.error[i], 1.01 * tolerance);
        for (std::size_t c = 0; c < 4; ++c) {
          ASSERT_NEAR(image.pixels[i][c], truth.pixels[i][c], said + 1e-7) << tolerance << ' ' << i;
          largest = std::max(largest, double{truth.pixels[i][c]});
        }
      }
    }
  }
  EXPECT_GT(largest, 0.2);
}

void expect_alike(const std::vector<Layer>& layers, const std::vector<Clip>& clips = {}) {
  Scene of_grids = seen(layers), own = of_grids;
  own.layers.front() = scenes::as_source(own.layers.front());
  own.clips = of_grids.clips = clips;
  expect_alike(own, of_grids);
}

Shading light() {
  return {0.3, 0.7, 0.3, 8, GradientKind::smooth, 0.02};
}

TEST(StretchSources, ShowWhatGridsShow) {
  expect_alike({layer()});
}

TEST(StretchSources, HaveLight) {
  Layer lit = layer();
  lit.shading = light();
  expect_alike({lit});
  lit.shading->gradient = GradientKind::field;
  expect_alike({lit});
}

TEST(StretchSources, HaveGradientOpacity) {
  Layer lit = layer();
  lit.shading = light();
  lit.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{5, 0}, {20, 0.7}, {60, 1.5}},
      GradientOpacity::Unit::voxel);
  expect_alike({lit});
}

TEST(StretchSources, HaveIsosurfacesAndSlices) {
  Layer lit = layer(1, {{100, 0, {1, 1, 1}}, {190, 1, {1, 0, 0}}});
  lit.shading = light();
  lit.isosurfaces = {{70, 0.5, {1, 0.5, 0}}, {130, 0.4, {0, 0.5, 1}}};
  lit.slices = {{{0.1, 0, 0}, {1, 0.2, 0.3}, 0.6}};
  expect_alike({lit});
}

TEST(StretchSources, AreClippedAndOverlap) {
  Layer other = layer(2);
  other.transform.translation = {0.4, 0.3, -0.5};
  Layer lit = layer();
  lit.shading = light();
  lit.clips = {{ClipSphere{{0, 0, 0.2}, 0.9}}};
  expect_alike({lit, other}, {{ClipPlane{{0, 0.1, 0}, {0.1, 1, 0.2}}}});
}

TEST(StretchSources, AreMoved) {
  Layer moved = layer();
  moved.shading = light();
  moved.shading->flatness.reset();
  moved.shading->flat_gradient = 20;
  Affine<double>& to = moved.transform;
  to.matrix = {{{0.8, 0.3, 0.1}, {-0.4, 0.9, 0.2}, {0, 0.1, 1.1}}};  // with a shear
  to.translation = {0.2, -0.1, 0.3};
  Scene of_grids = seen({moved}), own = of_grids;
  Layer in_place = moved;
  in_place.transform = {};
  own.layers[0] = scenes::as_source(in_place);
  own.layers[0].transform = moved.transform;
  expect_alike(own, of_grids);
  // A turn about an axis, with a scale: gradient opacity goes with it.
  to.matrix = {{{0, 0.7, 0}, {-0.7, 0, 0}, {0, 0, 0.7}}};
  moved.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{5, 0}, {20, 0.7}, {60, 1.5}},
      GradientOpacity::Unit::world);
  of_grids = own = seen({moved});
  in_place = moved;
  in_place.transform = {};
  own.layers[0] = scenes::as_source(in_place);
  own.layers[0].transform = moved.transform;
  expect_alike(own, of_grids);
}

TEST(StretchSources, HaveSeveralVariables) {
  const auto channels = std::make_shared<const Channels>(
      std::vector<Channel>{{"a", "", wave(1)}, {"b", "", wave(2)}});
  GaussianPrimitive primitive;
  primitive.channels = {0, 1};
  primitive.center = {100, 120};
  primitive.matrix = {{0.03, 0.01}, {0, 0.02}};
  primitive.extinction = 3;
  primitive.color = {1, 0.6, 0.2};
  const auto function =
      std::make_shared<const MultivariateTransferFunction>(2, std::vector{primitive});
  expect_alike({Layer{ChannelsContent{channels, function}}});
}

/// One stretch of every ray through [-1, 1]³, until a test says otherwise.
class Faulty : public StretchSource {
 public:
  using Next = std::function<bool(FieldStretch&, int)>;

  explicit Faulty(Next next, std::function<void(const char*)> called = {})
      : StretchSource(described()), next_(std::move(next)), called_(std::move(called)) {}

  std::unique_ptr<StretchStream> stream(const StretchDemand&) const override {
    call("stream");
    if (returns_none) return nullptr;
    return std::make_unique<Stream>(*this);
  }

  static Description described() {
    Description description;
    description.name = "glass";
    description.bounds = {{-1, -1, -1}, {1, 1, 1}};
    description.variables = {{"density", 0, 10}};
    description.voxel_size = 0.1;
    description.has_gradient = description.has_magnitude = true;
    return description;
  }
  /// Fills a stretch between two places.
  static void fill(FieldStretch& stretch, double begin, double end) {
    stretch.begin = begin;
    stretch.end = end;
    stretch.data[0] = {{1, 2, 3, 4}};
    for (auto& component : stretch.gradient) component = {{1, 1, 1, 1}};
    stretch.magnitude = {{2, 2, 2, 2}};
  }

  bool returns_none = false;
  Interval<double> interval{3, 5};

 private:
  class Stream : public StretchStream {
   public:
    explicit Stream(const Faulty& of) : of_(of) {}
    Interval<double> start(const Ray<double>&) override {
      of_.call("start");
      return of_.interval;
    }
    void restrict_to_range(Interval<double>) override {
      of_.call("restrict");
      n_ = 0;
    }
    bool next(FieldStretch& stretch) override {
      of_.call("next");
      return of_.next_(stretch, n_++);
    }

   private:
    const Faulty& of_;
    int n_ = 0;
  };

  void call(const char* what) const {
    if (called_) called_(what);
  }

  const Next next_;
  const std::function<void(const char*)> called_;
};

Scene of_source(std::shared_ptr<const StretchSource> source) {
  Layer layer{
      SourceContent{std::move(source), scenes::transfer({{0, 0, {1, 1, 1}}, {4, 1, {1, 0.5, 0}}})}};
  layer.name = "window";
  layer.shading = Shading{};
  layer.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::vector<GradientOpacity::Point>{{0, 0.5}, {10, 1}}, GradientOpacity::Unit::world);
  Scene scene = seen({layer});
  scene.camera.position = {0, 0, 4};
  scene.camera.focal_point = {};
  scene.camera.vertical_angle = 16;
  return scene;
}

std::string error_of(const Scene& scene, std::optional<InstructionSet> set, int threads) {
  try {
    frame(scene, set, threads);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

/// Expects an Error that says this, whatever the threads and the way.
void expect_error(const Scene& scene, const std::string& text) {
  for (const bool one_by_one : {true, false}) {
    const auto set = one_by_one ? std::optional(InstructionSet::scalar) : std::nullopt;
    for (const int threads : {1, 4}) {
      const std::string error = error_of(scene, set, threads);
      EXPECT_NE(error.find(text), std::string::npos) << error;
      EXPECT_NE(error.find("layer \"window\": its stretch source \"glass\""), std::string::npos)
          << error;
      EXPECT_EQ(error.find('\n'), std::string::npos);
    }
  }
}

void expect_fault(const Faulty::Next& next, const std::string& text) {
  SCOPED_TRACE(text);
  expect_error(of_source(std::make_shared<const Faulty>(next)), text);
}

/// One stretch that a test changes.
void expect_fault_of(const std::function<void(FieldStretch&)>& change, const std::string& text) {
  expect_fault(
      [&](FieldStretch& stretch, int n) {
        Faulty::fill(stretch, 3.2, 4.8);
        change(stretch);
        return n < 1;
      },
      text);
}

TEST(StretchSources, AreTakenIfTheyKeepTheirPromises) {
  const auto source = std::make_shared<const Faulty>([](FieldStretch& stretch, int n) {
    // One without length, one that reaches out of the box by rounding, a gap.
    Faulty::fill(stretch, n == 0 ? 3.2 : n == 1 ? 3.2 : 4, n == 0 ? 3.2 : n == 1 ? 3.6 : 4.8);
    return n < 3;
  });
  Scene scene = of_source(source);
  const Image image = frame(scene, std::nullopt, 4);
  EXPECT_GT(image.at(7, 7)[3], 0.1f);
  const auto nothing = std::make_shared<const Faulty>([](FieldStretch&, int) { return false; });
  EXPECT_EQ(frame(of_source(nothing), std::nullopt).at(7, 7)[3], 0.0f);
  const auto missed = std::make_shared<Faulty>([](FieldStretch&, int) { return true; });
  missed->interval = {infinity, -infinity};
  EXPECT_EQ(frame(of_source(missed), std::nullopt).at(7, 7)[3], 0.0f);
}

TEST(StretchSources, AreRefusedIfTheyBreakThem) {
  expect_fault_of([](FieldStretch& s) { s.begin = nan; }, "let both be finite");
  expect_fault_of([](FieldStretch& s) { s.end = infinity; }, "let both be finite");
  expect_fault_of([](FieldStretch& s) { s.end = 3.1; },
                  "from 3.2 to 3.1; let it end behind its begin");
  expect_fault_of([](FieldStretch& s) { s.begin = 1; }, "let the bounds hold the whole field");
  expect_fault_of([](FieldStretch& s) { s.end = 7; }, "let the bounds hold the whole field");
  expect_fault_of([](FieldStretch& s) { s.position_error = -1; }, "position_error = -1");
  expect_fault_of([](FieldStretch& s) { s.position_error = nan; }, "position_error = nan");
  expect_fault_of([](FieldStretch& s) { s.value_error[0] = infinity; }, "value_error = inf");
  expect_fault_of([](FieldStretch& s) { s.data[0].b[1] = nan; },
                  "data of density that are not finite");
  expect_fault_of([](FieldStretch& s) { s.data[0].b[2] = -infinity; },
                  "data of density that are not finite");
  expect_fault_of([](FieldStretch& s) { s.data[0].b[3] = 11; },
                  "the value 11 of density, which goes from 0 to 10");
  expect_fault_of([](FieldStretch& s) { s.gradient[1].b[0] = nan; },
                  "a gradient that is not finite");
  expect_fault_of([](FieldStretch& s) { s.gradient_error = -1; }, "gradient_error = -1");
  expect_fault_of([](FieldStretch& s) { s.magnitude.b[0] = -1; }, "a magnitude that is negative");
  expect_fault(
      [](FieldStretch& stretch, int n) {
        Faulty::fill(stretch, n == 0 ? 4 : 3.5, n == 0 ? 4.5 : 3.8);
        return n < 2;
      },
      "tell them front to back");
  expect_fault(
      [](FieldStretch& stretch, int) {
        Faulty::fill(stretch, 3.5, 3.5);
        return true;
      },
      "more than 4194304 stretches; let next() return false behind the last one");
}

TEST(StretchSources, MayThrow) {
  for (const std::string where : {"stream", "start", "restrict", "next"}) {
    SCOPED_TRACE(where);
    const auto next = [](FieldStretch& stretch, int n) {
      Faulty::fill(stretch, 3.2, 4.8);
      return n < 1;
    };
    const auto throwing = [&](const auto& what) {
      return of_source(std::make_shared<const Faulty>(next, [where, what](const char* called) {
        if (where == called) throw what;
      }));
    };
    expect_error(throwing(std::runtime_error("the disk is full")), "fails: the disk is full");
    expect_error(throwing(Error("no such file")), "fails: no such file");
    expect_error(throwing(7), "fails with an exception that is no std::exception");
    // In frames that are started, too; the renderer goes on with others.
    Renderer renderer(4);
    EXPECT_THROW(renderer.start(throwing(std::runtime_error("disk"))).wait(), Error);
    EXPECT_GT(renderer.render(seen({layer()})).image.at(7, 7)[3], 0.0f);
  }
  const auto none = std::make_shared<Faulty>([](FieldStretch&, int) { return false; });
  none->returns_none = true;
  expect_error(of_source(none), "returns no stream");
  none->returns_none = false;
  none->interval = {nan, 3};
  expect_error(of_source(none), "an interval that is not a number");
}

std::string error_of(StretchSource::Description description) {
  class Any : public StretchSource {
   public:
    explicit Any(Description d) : StretchSource(std::move(d)) {}
    std::unique_ptr<StretchStream> stream(const StretchDemand&) const override { return nullptr; }
  };
  try {
    Any any(std::move(description));
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(StretchSources, DescribeThemselvesRightly) {
  EXPECT_EQ(error_of(Faulty::described()), "none");
  const auto refused = [](const auto& change) {
    StretchSource::Description description = Faulty::described();
    change(description);
    return error_of(description);
  };
  using D = StretchSource::Description;
  EXPECT_EQ(refused([](D& d) { d.bounds.upper.y = -1; }),
            "glass: the bounds go from (-1, -1, -1) to (1, -1, 1), but must be finite and ascend "
            "along each axis");
  EXPECT_NE(refused([](D& d) { d.bounds.lower.x = nan; }), "none");
  EXPECT_NE(refused([](D& d) { d.bounds.upper.z = infinity; }), "none");
  EXPECT_EQ(refused([](D& d) { d.variables.clear(); }),
            "glass: there are 0 variables, but there must be from 1 to 8");
  EXPECT_NE(refused([](D& d) { d.variables.resize(9, d.variables[0]); }), "none");
  EXPECT_EQ(refused([](D& d) { d.variables[0].name.clear(); }),
            "glass: a variable has no name; give it one");
  EXPECT_EQ(refused([](D& d) { d.variables[0].minimum = 11; }),
            "glass: the variable density goes from 11 to 10, but must go up, within ±2.1e37");
  EXPECT_NE(refused([](D& d) { d.variables[0].maximum = nan; }), "none");
  EXPECT_NE(refused([](D& d) { d.variables[0].maximum = 1e38; }), "none");
  EXPECT_NE(refused([](D& d) { d.voxel_size = 0; }), "none");
  EXPECT_NE(refused([](D& d) { d.voxel_size = infinity; }), "none");
}

std::string refused(Scene scene) {
  return error_of(scene, std::nullopt, 1);
}

/// What does not take them says so.
TEST(StretchSources, AreNotForEverything) {
  const auto one = [](const auto& change) {
    StretchSource::Description description = Faulty::described();
    description.has_gradient = description.has_magnitude = false;
    class Plain : public StretchSource {
     public:
      explicit Plain(Description d) : StretchSource(std::move(d)) {}
      std::unique_ptr<StretchStream> stream(const StretchDemand&) const override { return nullptr; }
    };
    Scene scene = of_source(std::make_shared<const Plain>(description));
    scene.layers[0].shading.reset();
    scene.layers[0].gradient_opacity.reset();
    change(scene);
    return refused(scene);
  };
  EXPECT_EQ(
      one([](Scene& s) { s.layers[0].shading = Shading{}; }),
      "layer \"window\": has a shading, but its source has no gradient; leave the shading out");
  EXPECT_EQ(one([](Scene& s) {
              s.layers[0].gradient_opacity = std::make_shared<const GradientOpacity>(
                  std::vector<GradientOpacity::Point>{{0, 0.5}, {10, 1}},
                  GradientOpacity::Unit::world);
            }),
            "layer \"window\": has a gradient opacity, but its source has no magnitude; leave the "
            "opacity "
            "out");
  EXPECT_EQ(one([](Scene& s) { s.layers[0].projection = LayerProjection::maximum; }),
            "layer \"window\": the projection maximum is of grids and meshes, but the layer has a "
            "stretch "
            "source; leave it out");
  EXPECT_EQ(one([](Scene& s) { s.integration.method = Method::homogeneous; }),
            "integration: the method homogeneous is for the cells of a mesh, but the scene has "
            "other data; take midpoint, trapezoid or linear there");
  EXPECT_EQ(
      one([](Scene& s) { std::get<SourceContent>(s.layers[0].content).source = nullptr; }),
      "layer \"window\": a source and a transfer function are needed; set both before rendering");
  EXPECT_EQ(
      one([](Scene& s) {
        std::get<SourceContent>(s.layers[0].content).transfer_function =
            std::shared_ptr<const TransferFunction>();
      }),
      "layer \"window\": a source and a transfer function are needed; set both before rendering");
  Scene sheared =
      of_source(std::make_shared<const Faulty>([](FieldStretch&, int) { return false; }));
  sheared.layers[0].transform.matrix.column[0] = {1, 0.5, 0};
  EXPECT_EQ(refused(sheared),
            "layer \"window\": has a gradient opacity, and its transform changes the angles of its "
            "source; "
            "turn, move or scale it alike along all axes");

  // A device leaves it to the CPU, and says so.
  Scene scene = of_source(std::make_shared<const Faulty>([](FieldStretch& stretch, int n) {
    Faulty::fill(stretch, 3.2, 4.8);
    return n < 1;
  }));
  RenderOptions options;
  options.machine.device = Device::emulated;
  const auto [image, report] = render(scene, options);
  EXPECT_GT(image.at(7, 7)[3], 0.1f);
  EXPECT_EQ(report.device, "rendered by the CPU: devices cannot do stretch sources yet");
}

}  // namespace
}  // namespace pellucid::test_stretch_source

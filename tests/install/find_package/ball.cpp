// SPDX-License-Identifier: Apache-2.0
#include <pellucid/cpu/render.h>
#include <pellucid/io/image_files.h>
#include <pellucid/scene/defaults.h>
#include <pellucid/scene/error.h>
#include <pellucid/scene/stretch_source.h>

#include <cmath>
#include <cstdio>
#include <memory>

using pellucid::Vec3;

// The field 1 - |p|² in the ball of radius 1. Along a ray it is one quadratic.
class Ball : public pellucid::StretchSource {
 public:
  Ball() : StretchSource(described()) {}

  std::unique_ptr<pellucid::StretchStream> stream(
      const pellucid::StretchDemand& demand) const override {
    return std::make_unique<Stream>(demand.gradient >= 0);
  }

 private:
  static Description described() {
    Description d;
    d.name = "ball";
    d.bounds = {{-1, -1, -1}, {1, 1, 1}};
    d.variables = {{"density", 0, 1}};
    d.voxel_size = 0.1;
    d.has_gradient = true;
    return d;
  }

  class Stream : public pellucid::StretchStream {
   public:
    explicit Stream(bool has_gradient) : has_gradient_(has_gradient) {}

    pellucid::Interval<double> start(const pellucid::Ray<double>& ray) override {
      ray_ = ray;
      const double middle = -dot(ray.origin, ray.direction);
      const Vec3<double> nearest = ray.at(middle);
      const double square = 1 - dot(nearest, nearest);
      if (!(square > 0)) return {1, 0};  // it misses the ball
      const double half = std::sqrt(square);
      inside_ = {middle - half, middle + half};
      // Points have errors of some roundings, the ends larger ones where the ray grazes the ball.
      point_error_ = 0x1p-50 * (length(ray.origin) + std::abs(inside_.end));
      end_error_ = std::fmin(4 * point_error_ / half, std::sqrt(4 * point_error_)) + point_error_;
      return inside_;
    }
    void restrict_to_range(pellucid::Interval<double>) override { is_told_ = false; }
    bool next(pellucid::FieldStretch& stretch) override {
      if (is_told_) return false;
      is_told_ = true;
      const Vec3<double> a = ray_.at(inside_.begin), b = ray_.at(inside_.end);
      // The polar form 1 - p·q of the field gives the coefficients of the quadratic.
      const double first = 1 - dot(a, a), between = 1 - dot(a, b), last = 1 - dot(b, b);
      stretch.begin = inside_.begin;
      stretch.end = inside_.end;
      stretch.position_error = 2 * end_error_;
      stretch.data[0] = {{first, (first + 2 * between) / 3, (2 * between + last) / 3, last}};
      stretch.value_error[0] = 8 * point_error_;
      if (has_gradient_) {
        for (int axis = 0; axis < 3; ++axis) {
          const pellucid::LinearBernstein<double> slope{{-2 * a[axis], -2 * b[axis]}};
          stretch.gradient[axis] = as_cubic(slope);
        }
      }
      return true;
    }

   private:
    bool has_gradient_, is_told_ = false;
    pellucid::Ray<double> ray_{};
    pellucid::Interval<double> inside_{};
    double point_error_ = 0, end_error_ = 0;
  };
};

int main() {
  try {
    const auto function = std::make_shared<const pellucid::TransferFunction>(
        std::vector<pellucid::TransferFunction::Point>{
            {0.2, 0, {0.2, 0.4, 1}}, {0.6, 2, {1, 0.6, 0.2}}, {1, 0.5, {1, 1, 0.8}}});
    pellucid::Layer layer{pellucid::SourceContent{std::make_shared<const Ball>(), function}};
    layer.shading = pellucid::Shading{};
    const pellucid::Scene scene(layer, {96, 96});
    const auto [image, report] = pellucid::render(scene);
    std::printf("the middle pixel has the opacity %.3f\n", double{image.at(48, 48)[3]});
    std::printf("largest error %.2g of %.2g\n", report.largest_error, scene.integration.tolerance);
    pellucid::write_png(image, "ball.png");
  } catch (const pellucid::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

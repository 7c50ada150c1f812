// SPDX-License-Identifier: Apache-2.0
#include "pixel_interpolator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "pellucid/error/random_errors.h"
#include "pellucid/traverse/block_code.h"

namespace pellucid {
namespace {

constexpr int largest_stride = 16;
/// From one side of the image to the other, of pixels of the first level.
constexpr int min_cells = 8;
/// At smaller tolerances few pixels pass, and those that they are taken from cost more.
constexpr double min_tolerance = 4e-4;
/// Pixels of a level that are tried: every third each way. If less than a quarter of them is found,
/// tracing the others to smaller tolerances costs more than it saves.
constexpr int apart_of_tried = 3;
constexpr double least_found = 0.25;
/// Least share of the screen that is clear: with less, tracing to smaller tolerances costs more
/// than it saves.
constexpr double min_clear_share = 1.0 / 16;

/// The cubic through four pixels, in the middle between the second and the third.
constexpr std::array<float, 4> weight{-1.0f / 16, 9.0f / 16, 9.0f / 16, -1.0f / 16};
constexpr float sum_of_weights = 1.25f;
/// Error of the cubic by rounding in float, as a share of its largest pixel: sixteen products and
/// their sum.
constexpr double rounding_of_cubic = 32 * 0x1p-24;

/// Fractions of the tolerance that pixels of a level may use, because others are interpolated from
/// them.
struct Shares {
  double of_rays, in_between;
};
constexpr Shares shares_of(int stride) noexcept {
  return stride == 1 ? Shares{1, 1} : stride == 2 ? Shares{0.55, 0.85} : Shares{0.3, 0.5};
}
// The error that a pixel inherits leaves something for itself.
static_assert(shares_of(2).in_between < shares_of(1).in_between &&
              shares_of(4).in_between < shares_of(2).in_between);

/// Largest error of pixels from which others are interpolated: the part of it that differs between
/// neighboring rays is in the differences that stand for the cubic's error, many times over.
constexpr double most_of_rays = 2.5e-3;

/// Returns whether rays so many pixels apart show all that is between them; `waves`: 1 / the
/// longest step from ray to ray.
bool are_near(int pixels, double voxels_between_pixels, double waves) noexcept {
  return pixels * voxels_between_pixels * waves <= 1;
}

/// Pixels on `Columns` by `Rows` places of a lattice, one or four: the cubic through them, and the
/// most of what is known of them.
struct Around {
  std::array<float, 4> cubic{};
  float error = 0;  ///< inherited: see PixelInterpolator
  float neighbor_deviation = 0, waves = 0;
};

template <int Columns, int Rows, class Known>
Around around(const std::array<float, 4>* pixels, std::ptrdiff_t row_of_pixels, int apart,
              const Known* known, std::ptrdiff_t row_of_known, int known_apart) noexcept {
  const auto weight_of = [](int i, int count) {
    return count == 1 ? 1 : weight[static_cast<std::size_t>(i)];
  };
  Around a;
  float of_one = 0;
  for (int j = 0; j < Rows; ++j) {
    for (int i = 0; i < Columns; ++i) {
      const float w = weight_of(i, Columns) * weight_of(j, Rows), size_of_w = std::fabs(w);
      const std::array<float, 4>& value = pixels[j * row_of_pixels + i * apart];
      for (std::size_t c = 0; c < 4; ++c) a.cubic[c] += w * value[c];
      const Known& one = known[j * row_of_known + i * known_apart];
      const float error = size_of_w * one.error;
      a.error += error;
      of_one = std::max(of_one, error);
      a.neighbor_deviation = std::max(a.neighbor_deviation, one.neighbor_deviation);
      a.waves = std::max(a.waves, one.waves);
    }
  }
  constexpr float weights = (Columns == 1 ? 1 : sum_of_weights) * (Rows == 1 ? 1 : sum_of_weights);
  a.error = std::max(a.error / weights, of_one);
  return a;
}

/// Returns the largest number of cells per world length, in any direction: the largest singular
/// value of the map, for cells may be sheared.
double cells_by_length(const Volume& volume, Vec3<double> width) noexcept {
  const auto to_cells = [&](Vec3<double> world) {
    const Vec3<double> grid = volume.grid_from_world().vector(world);
    return Vec3<double>{grid.x / width.x, grid.y / width.y, grid.z / width.z};
  };
  const Vec3<double> x = to_cells({1, 0, 0}), y = to_cells({0, 1, 0}), z = to_cells({0, 0, 1});
  // Powers of the matrix of products: its trace lies between the largest and three times that.
  double m[3][3] = {{dot(x, x), dot(x, y), dot(x, z)},
                    {dot(y, x), dot(y, y), dot(y, z)},
                    {dot(z, x), dot(z, y), dot(z, z)}};
  double log_of_scale = 0, power = 1;
  for (int n = 0; n < 6; ++n) {
    const double trace = m[0][0] + m[1][1] + m[2][2];
    double square[3][3] = {};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) square[i][j] += m[i][k] * m[k][j] / (trace * trace);
      }
    }
    log_of_scale = 2 * (log_of_scale + std::log(trace));
    power *= 2;
    std::copy(&square[0][0], &square[0][0] + 9, &m[0][0]);
  }
  const double trace = m[0][0] + m[1][1] + m[2][2];
  return std::exp(0.5 * (log_of_scale + std::log(trace)) / power);
}

/// Returns the largest distance from pixel to pixel in the volume, in voxels.
double voxels_between_pixels(const CameraFrame<double>& camera, const Volume& volume,
                             const BlockRecords& records, double farthest) {
  const double across = 2 * std::sqrt(dot(camera.right, camera.right)) / camera.width,
               down = 2 * std::sqrt(dot(camera.up, camera.up)) / camera.height;
  return std::max(across, down) * farthest * cells_by_length(volume, records.mean_width);
}

}  // namespace

std::unique_ptr<PixelInterpolator> PixelInterpolator::make(const Frame& frame,
                                                           const ImageView& image) {
  const auto around = frame.tracer->interpolation_info();
  if (!around || frame.scene.backdrop || frame.tolerance < min_tolerance) return nullptr;
  if (frame.region && !frame.region->corners) return nullptr;
  const BlockRecords& records = around->blocks.records;
  const double voxels = voxels_between_pixels(
      frame.camera, around->volume, records, farthest_depth(frame.camera, around->volume, records));
  const int smaller_side = std::min(frame.scene.size.width, frame.scene.size.height);
  int stride = 1;
  while (2 * stride <= largest_stride && min_cells * 2 * stride <= smaller_side &&
         are_near(2 * stride, voxels, 1 / around->longest_step)) {
    stride *= 2;
  }
  if (stride < 2) return nullptr;
  ScreenMask mask(frame.camera, around->volume, around->blocks, stride,
                  frame.region ? &*frame.region->corners : nullptr);
  if (mask.clear_share() < min_clear_share) return nullptr;
  return std::unique_ptr<PixelInterpolator>(
      new PixelInterpolator(frame, image, stride, voxels, std::move(mask)));
}

PixelInterpolator::PixelInterpolator(const Frame& frame, const ImageView& image, int stride,
                                     double voxels, ScreenMask mask)
    : frame_(frame),
      image_(image),
      stride_(stride),
      voxels_(voxels),
      rounding_(rounding_of_cubic * std::max(frame.largest_color, 1.0)),
      mask_(std::move(mask)),
      columns_(static_cast<std::size_t>((frame.scene.size.width + 1) / 2)),
      known_(columns_ * static_cast<std::size_t>((frame.scene.size.height + 1) / 2)) {}

double PixelInterpolator::traced_tolerance_fraction(int stride) const noexcept {
  const double share = shares_of(stride).of_rays;
  return stride > 1 ? std::min(share, most_of_rays / frame_.tolerance) : share;
}

void PixelInterpolator::keep(int column, int row, const RayResult& result) noexcept {
  const bool known = result.neighbor_deviation >= 0;  // and no NaN
  known_[index(column, row)] = {
      float_above(result.error),
      known ? result.neighbor_deviation : std::numeric_limits<float>::infinity(),
      1 / result.longest_step};
}

void PixelInterpolator::finish_level(int stride, int threads) {
  finished_ = stride;
  cubic_errors_.emplace(image_, frame_.scene.size, stride, threads);
  if (stride < stride_) {
    const auto around = frame_.tracer->interpolation_info();
    mask_ = ScreenMask(frame_.camera, around->volume, around->blocks, stride,
                       frame_.region ? &*frame_.region->corners : nullptr);
  }
  const int next = stride / 2, apart = apart_of_tried * stride;
  int tried = 0, found = 0;
  for (int row = next; row < frame_.scene.size.height; row += apart) {
    for (int column = next; column < frame_.scene.size.width; column += apart) {
      RayResult result;
      const Cost cost = look(column, row, next, std::numeric_limits<double>::infinity(), result);
      if (!cost.known) continue;
      ++tried;
      // What this level does not hold is traced, and then the next one may: there the cubic errs a
      // sixteenth, beside what is inherited from rays.
      const double then = next > 1 ? traced_tolerance_fraction(next) * frame_.tolerance +
                                         cost.cubic / 16 + cost.uneven
                                   : cost.inherited + cost.cubic + cost.uneven;
      if (then <= shares_of(std::max(next / 2, 1)).in_between * frame_.tolerance) ++found;
    }
  }
  goes_on_ = found > 0 && found >= least_found * tried;
}

bool PixelInterpolator::find(int column, int row, int stride, RayResult& result) const noexcept {
  if (!goes_on_) return false;
  const double most = shares_of(stride).in_between * frame_.tolerance;
  const Cost cost = look(column, row, stride, most, result);
  result.error = cost.inherited + cost.cubic + cost.uneven;
  return cost.known && result.error <= most;
}

PixelInterpolator::Cost PixelInterpolator::look(int column, int row, int stride, double most,
                                                RayResult& result) const noexcept {
  // Of the lattice of the level before; all are powers of two.
  const int before = 2 * stride;
  const bool across = (column & stride) != 0, down = (row & stride) != 0;
  const int left = across ? column - stride : column, top = down ? row - stride : row;
  const ImageSize size = frame_.scene.size;
  const auto fits = [before](bool between, int at, int count) {
    return at - (between ? 2 : 1) * before >= 0 && at + (between ? 3 : 1) * before < count;
  };
  if (!fits(across, left, size.width) || !fits(down, top, size.height) ||
      mask_.marked(column, row)) {
    return {};
  }

  const auto at_column = [&](int i) { return left + i * before; };
  const auto at_row = [&](int j) { return top + j * before; };
  float of_columns = 0, of_rows = 0;
  if (across) {
    for (int j = -1; j <= (down ? 2 : 1); ++j) {
      of_columns = std::max(of_columns, cubic_errors_->across(left, at_row(j)));
    }
  }
  if (down) {
    for (int i = -1; i <= (across ? 2 : 1); ++i) {
      of_rows = std::max(of_rows, cubic_errors_->down(at_column(i), top));
    }
  }
  // First along the one, whose errors the other one's weights may add up, 1.25 of them: whichever.
  const float of_cubic =
      of_columns + of_rows + (sum_of_weights - 1) * std::min(of_columns, of_rows);
  if (!(static_cast<double>(of_cubic) <= most)) return {true, 0, static_cast<double>(of_cubic), 0};

  const int first_column = across ? at_column(-1) : left, first_row = down ? at_row(-1) : top;
  const auto look_around = [&](auto columns, auto rows) {
    return around<columns.value, rows.value>(image_.pixels + image_.index(first_column, first_row),
                                             static_cast<std::ptrdiff_t>(image_.width) * before,
                                             before, known_.data() + index(first_column, first_row),
                                             static_cast<std::ptrdiff_t>(columns_) * stride,
                                             stride);
  };
  using One = std::integral_constant<int, 1>;
  using Four = std::integral_constant<int, 4>;
  const Around a = !down     ? look_around(Four{}, One{})
                   : !across ? look_around(One{}, Four{})
                             : look_around(Four{}, Four{});
  // What is clear is traced for next to nothing, and known for sure then.
  if (!(a.cubic[3] > 0)) return {};
  if (!are_near(before, voxels_, static_cast<double>(a.waves))) {
    return {true, std::numeric_limits<double>::infinity(), 0, 0};
  }

  const auto positive = [&](std::size_t c) {
    return std::max(static_cast<double>(a.cubic[c]), 0.0);
  };
  result.radiance = {positive(0), positive(1), positive(2)};
  result.opacity = std::min(positive(3), 1.0);
  result.neighbor_deviation = a.neighbor_deviation;
  result.longest_step = 1 / a.waves;
  // Its own neighbor_deviation, and that of those which it is taken from: 1 and at most 0.64 of
  // variance.
  const double uneven =
      1.3 * RandomErrors<double>::deviations * static_cast<double>(a.neighbor_deviation);
  return {true, (1 + 0x1p-19) * static_cast<double>(a.error) + rounding_,
          static_cast<double>(of_cubic), uneven};
}

}  // namespace pellucid

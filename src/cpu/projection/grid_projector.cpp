// SPDX-License-Identifier: Apache-2.0
//
// Projections of a volume. In: a ray and the parts of it that clips keep. Out: one value with
// proved bounds. Extremes visit the blocks of 8³ cells that the ray crosses in the order of their
// records' bounds, and end when no block can be better; in a block, cells whose corners cannot be
// better are passed over. Means and sums, and all projections of data with vacuum, visit every cell
// in order.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "pellucid/field/trilinear.h"
#include "projection/axis_walk.h"
#include "projection/kept_parts.h"
#include "projection/layer_projector.h"
#include "projection/value_gatherer.h"

namespace pellucid {
namespace {

/// A block that a ray crosses.
struct CrossedBlock {
  double begin, end;  ///< world arc length
  int block;
};

struct GridWorkspace : ProjectionWorkspace {
  std::vector<CrossedBlock> blocks;
  std::vector<float> bounds;  ///< no value in the block is better
};

/// The part of a ray inside of the grid, and what rounding makes of it.
struct InsideGrid {
  Interval<double> range{1, 0};
  bool is_doubtful = false;   ///< rounding decides whether the ray meets the grid
  double position_error = 0;  ///< of both ends, world length
};

/// A ray in the grid's coordinates, with the largest errors of its positions.
struct GridRay {
  WalkRay walk;
  double error[3];  ///< of positions, in the axes' coordinates
  double rest = 0;  ///< length of which a walk by steps may be off in a block
  /// Sums over the axes, in cells: of the errors, and of the ways along the ray by world length.
  double cells_off = 0, cells_by_length = 0;
};

template <class Value>
class GridProjector : public LayerProjector {
 public:
  GridProjector(const ProjectorTask& task, const Volume& volume,
                const StructuredGrid<Value, double>& grid)
      : volume_(volume),
        projection_(*task.layer.projection),
        grid_(grid),
        records_(volume.block_records(task.parallel)),
        planes_(grid.axis),
        block_planes_(records_.axis, block_width),
        clips_(task.clips),
        has_vacuum_(volume.statistics().nan > 0) {
    for (std::size_t a = 0; a < 3; ++a) {
      const GridAxis<double>& axis = grid_.axis[a];
      const std::ptrdiff_t stride = stride_[a] = a == 0   ? 1
                                                 : a == 1 ? axis_values(0)
                                                          : axis_values(0) * axis_values(1);
      least_width_[a] = std::numeric_limits<double>::infinity();
      for (int i = 0; i <= axis.cells(); ++i) {
        offset_[a].push_back(stride * axis.value_index(i));
        if (i == 0) continue;
        inverse_width_[a].push_back(1 / (axis.plane(i) - axis.plane(i - 1)));
        const bool constant = axis.value_index(i) == axis.value_index(i - 1);
        if (!constant) {
          least_width_[a] = std::min(least_width_[a], axis.plane(i) - axis.plane(i - 1));
        }
      }
      for (int first = 0; first < axis.cells(); first += block_width) {
        bool regular = true;
        for (int i = first; i < std::min(first + block_width, axis.cells()); ++i) {
          regular = regular && axis.plane(i + 1) - axis.plane(i) == 1 &&
                    axis.value_index(i + 1) == axis.value_index(i) + 1;
        }
        regular_[a].push_back(regular);
      }
      reach_[a] = std::max(std::abs(axis.plane(0)), std::abs(axis.plane(axis.cells())));
    }
    for (int a = 0; a < 3; ++a) last_block_[a] = records_.axis[a].cells() - 1;
    const int count = records_.count();
    bounds_.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const BlockRecord& record = records_[i];
      bounds_.push_back(record.vacuum() == BlockVacuum::all
                            ? nothing
                            : static_cast<float>(bound_of(records_.range(i))));
    }
  }

  std::unique_ptr<ProjectionWorkspace> workspace() const override {
    return std::make_unique<GridWorkspace>();
  }

  RayValue project(const Ray<double>& ray, double end,
                   ProjectionWorkspace& workspace) const override {
    const VolumeStatistics& data = volume_.statistics();
    ValueGatherer gatherer(projection_, data.minimum, data.maximum);
    GridRay grid_ray = to_grid(ray, end);
    const InsideGrid inside = find_inside(grid_ray, end);
    if (inside.is_doubtful || !(inside.range.begin < inside.range.end)) {
      RayValue missed = gatherer.result({});
      missed.is_unknown = inside.is_doubtful;
      return missed;
    }
    const KeptParts parts(inside.range, clips_, ray);
    const double data_range = data.maximum - data.minimum;
    ValueGatherer::Errors errors;
    errors.data = data_range * grid_ray.cells_off;
    errors.slope = data_range * grid_ray.cells_by_length;
    grid_ray.rest = 64 * rounding_unit<double> * inside.range.end;
    errors.position = inside.position_error + parts.position_error() + grid_ray.rest;
    Cells cells{gatherer};
    if (gatherer.is_extreme() && !has_vacuum_) {
      auto& own = static_cast<GridWorkspace&>(workspace);
      if (gatherer.sign() > 0) {
        visit_best<true>(grid_ray, parts.kept(), own, cells);
      } else {
        visit_best<false>(grid_ray, parts.kept(), own, cells);
      }
    } else {
      for (const Interval<double>& part : parts.kept()) {
        visit_all(grid_ray, part, cells, errors);
      }
    }
    RayValue result = gatherer.result(errors);
    result.is_unknown =
        result.is_unknown || cells.is_unknown || (gatherer.is_extreme() && parts.is_doubtful());
    result.cells = cells.count;
    return result;
  }

 private:
  /// Largest error of positions, in cells, at which walks by steps are safe.
  static constexpr double tame = 1e-3;
  /// Below all floats: the bound of a block without data.
  static constexpr float nothing = -std::numeric_limits<float>::infinity();

  /// Cells that a ray has met so far.
  struct Cells {
    ValueGatherer& gatherer;
    long count = 0;
    bool is_unknown = false;
  };

  std::ptrdiff_t axis_values(int a) const { return grid_.axis[a].values; }

  /// Returns the best value of a block's range, times -1 for a minimum, as a float that is not
  /// worse.
  double bound_of(const BlockRange& range) const {
    const double best = projection_ == LayerProjection::minimum ? -range.min : range.max;
    return static_cast<double>(float_not_below(best));
  }
  static float float_not_below(double x) {
    const auto nearest = static_cast<float>(x);
    return static_cast<double>(nearest) >= x
               ? nearest
               : std::nextafter(nearest, std::numeric_limits<float>::infinity());
  }

  GridRay to_grid(const Ray<double>& ray, double end) const {
    const Affine<double>& map = volume_.grid_from_world();
    const Ray<double> in_grid = map.ray(ray);
    GridRay result{WalkRay(in_grid), {}, 0, 0, 0};
    // The ray's length inside of the grid is not known yet; it ends at the box's far side.
    double far = 0;
    for (int a = 0; a < 3; ++a) {
      far = std::max(far, std::abs(in_grid.origin[a]) + reach_[static_cast<std::size_t>(a)]);
    }
    const double speed = std::max({std::abs(in_grid.direction.x), std::abs(in_grid.direction.y),
                                   std::abs(in_grid.direction.z)});
    const double t = std::min(end, speed > 0 ? 4 * far / speed : 0.0);
    for (int a = 0; a < 3; ++a) {
      double size = std::abs(map.translation[a]) + reach_[static_cast<std::size_t>(a)];
      for (int b = 0; b < 3; ++b) {
        size += std::abs(map.matrix.column[b][a]) *
                (std::abs(ray.origin[b]) + t * std::abs(ray.direction[b]));
      }
      result.error[a] = 64 * rounding_unit<double> * size;
      const double width = least_width_[static_cast<std::size_t>(a)];
      result.cells_off += result.error[a] / width;
      result.cells_by_length += std::abs(in_grid.direction[a]) / width;
    }
    return result;
  }

  /// Intersects the grid's box, and boxes that are larger and smaller by the errors of positions.
  InsideGrid find_inside(const GridRay& ray, double end) const {
    Interval<double> nominal{0, end}, outer{0, end}, inner{0, end};
    for (int a = 0; a < 3; ++a) {
      const double origin = ray.walk.origin[a], error = ray.error[a];
      const double lower = planes_[a][0], upper = planes_[a][planes_.cells(a)];
      if (ray.walk.direction[a] == 0) {
        const auto stay = [&](double off, Interval<double>& t) {
          if (!(origin >= lower - off && origin <= upper + off)) t.end = -HUGE_VAL;
        };
        stay(0, nominal);
        stay(error, outer);
        stay(-error, inner);
        continue;
      }
      const double inverse = ray.walk.inverse[a], off = error * std::abs(inverse);
      double front = (lower - origin) * inverse, back = (upper - origin) * inverse;
      if (inverse < 0) std::swap(front, back);
      nominal = {std::max(nominal.begin, front), std::min(nominal.end, back)};
      outer = {std::max(outer.begin, front - off), std::min(outer.end, back + off)};
      inner = {std::max(inner.begin, front + off), std::min(inner.end, back - off)};
    }
    InsideGrid inside;
    inside.range = nominal;
    if (!(outer.begin < outer.end)) {
      inside.range = {1, 0};
      return inside;
    }
    inside.is_doubtful = !(inner.begin < inner.end) || !(nominal.begin < nominal.end);
    inside.position_error = (outer.end - outer.begin) - (inner.end - inner.begin);
    return inside;
  }

  /// Loads a cell's corners. Returns whether it has data.
  bool load(const int (&cell)[3], Value (&corner)[8]) const {
    const auto i = static_cast<std::size_t>(cell[0]), j = static_cast<std::size_t>(cell[1]),
               k = static_cast<std::size_t>(cell[2]);
    const std::ptrdiff_t x0 = offset_[0][i], x1 = offset_[0][i + 1];
    const std::ptrdiff_t y0 = offset_[1][j], y1 = offset_[1][j + 1];
    const std::ptrdiff_t z0 = offset_[2][k], z1 = offset_[2][k + 1];
    const Value *const row00 = grid_.data + y0 + z0, *const row10 = grid_.data + y1 + z0,
                       *const row01 = grid_.data + y0 + z1, *const row11 = grid_.data + y1 + z1;
    corner[0] = row00[x0];
    corner[1] = row00[x1];
    corner[2] = row10[x0];
    corner[3] = row10[x1];
    corner[4] = row01[x0];
    corner[5] = row01[x1];
    corner[6] = row11[x0];
    corner[7] = row11[x1];
    if constexpr (std::is_floating_point_v<Value>) {
      if (has_vacuum_) {
        return std::none_of(corner, corner + 8, [](Value v) { return std::isnan(v); });
      }
    }
    return true;
  }

  CubicBernstein<double> cubic(const GridRay& ray, const int (&cell)[3], const Value (&corner)[8],
                               double begin, double end) const {
    CellCorners<double> corners;
    for (int n = 0; n < 8; ++n) corners.value[n] = static_cast<double>(corner[n]);
    Vec3<double> entry, exit;
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(cell[a]);
      const double inverse = inverse_width_[static_cast<std::size_t>(a)][i];
      const double origin = ray.walk.origin[a] - planes_[a][i], direction = ray.walk.direction[a];
      entry[a] = clamp((origin + begin * direction) * inverse, 0.0, 1.0);
      exit[a] = clamp((origin + end * direction) * inverse, 0.0, 1.0);
    }
    return trilinear_cubic(corners, entry, exit);
  }

  // Extremes of data without vacuum.

  template <bool Largest>
  void visit_best(const GridRay& ray, const std::vector<Interval<double>>& parts,
                  GridWorkspace& workspace, Cells& cells) const {
    const std::size_t count = list_blocks(ray, parts, workspace);
    const std::vector<CrossedBlock>& blocks = workspace.blocks;
    float* const bounds = workspace.bounds.data();
    if (count == 0) return;
    // A few of the best bounds make most others not better; the rest is visited as it comes.
    constexpr int best_ones = 3;
    for (int n = 0; n < best_ones; ++n) {
      float* const best = std::max_element(bounds, bounds + count);
      if (!(static_cast<double>(*best) > cells.gatherer.best())) break;
      visit_block<Largest>(ray, blocks[static_cast<std::size_t>(best - bounds)],
                           static_cast<double>(*best), cells);
      *best = nothing;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const auto bound = static_cast<double>(bounds[i]);
      if (bound > cells.gatherer.best()) visit_block<Largest>(ray, blocks[i], bound, cells);
    }
    for (std::size_t i = 0; i < count && !cells.gatherer.is_at_floor(); ++i) {
      find_floor<Largest>(ray, blocks[i], cells);
    }
  }

  /// Lists the blocks that the parts of a ray cross, and their bounds. Returns their number.
  std::size_t list_blocks(const GridRay& ray, const std::vector<Interval<double>>& parts,
                          GridWorkspace& workspace) const {
    const int faces = block_planes_.cells(0) + block_planes_.cells(1) + block_planes_.cells(2) + 3;
    const auto most = static_cast<std::size_t>(faces);
    if (workspace.blocks.size() < most * parts.size()) {
      workspace.blocks.resize(most * parts.size());
      workspace.bounds.resize(most * parts.size());
    }
    std::size_t count = 0;
    for (const Interval<double>& part : parts) {
      AxisWalk walk(block_planes_, ray.walk, part, first_block_, last_block_);
      AxisWalk::Step step;
      while (walk.next(step)) {
        const std::size_t block = block_index(step.cell);
        workspace.bounds[count] = bounds_[block];
        workspace.blocks[count++] = {step.begin, step.end, static_cast<int>(block)};
      }
    }
    return count;
  }

  /// Looks for a cell whose corners are all the extreme, where that is the block's bound: the value
  /// of saturated data has no rounding, and does not leave the place of a jump.
  template <bool Largest>
  void find_floor(const GridRay& ray, const CrossedBlock& block, Cells& cells) const {
    const double best = cells.gatherer.best();
    if (static_cast<double>(bounds_[static_cast<std::size_t>(block.block)]) != best) return;
    int place[3];
    place_of(block.block, place);
    AxisWalk walk = walk_block(ray, {block.begin, block.end}, place);
    AxisWalk::Step step;
    while (walk.next(step)) {
      Value corner[8];
      load(step.cell, corner);
      const double worst = (Largest ? 1 : -1) * static_cast<double>(best_of<!Largest>(corner));
      if (worst != best) continue;
      cells.gatherer.set_floor(worst);
      return;
    }
  }

  void place_of(int block, int (&place)[3]) const {
    const int x = block_planes_.cells(0), y = block_planes_.cells(1);
    place[0] = block % x;
    place[1] = block / x % y;
    place[2] = block / x / y;
  }
  std::size_t block_index(const int (&block)[3]) const {
    return static_cast<std::size_t>(records_.index(block[0], block[1], block[2]));
  }
  /// Returns a walk through the cells of a block.
  AxisWalk walk_block(const GridRay& ray, Interval<double> range, const int (&block)[3]) const {
    int first[3], last[3];
    for (int a = 0; a < 3; ++a) {
      first[a] = block[a] * block_width;
      last[a] = std::min(first[a] + block_width, planes_.cells(a)) - 1;
    }
    return {planes_, ray.walk, range, first, last};
  }

  /// Returns the best corner.
  template <bool Largest>
  static Value best_of(const Value (&corner)[8]) {
    const auto better = [](Value a, Value b) { return (Largest ? a > b : a < b) ? a : b; };
    return better(better(better(corner[0], corner[1]), better(corner[2], corner[3])),
                  better(better(corner[4], corner[5]), better(corner[6], corner[7])));
  }

  template <bool Largest>
  void visit_block(const GridRay& ray, const CrossedBlock& block, double bound,
                   Cells& cells) const {
    int place[3];
    place_of(block.block, place);
    if (ray.cells_off < tame && regular_[0][static_cast<std::size_t>(place[0])] &&
        regular_[1][static_cast<std::size_t>(place[1])] &&
        regular_[2][static_cast<std::size_t>(place[2])]) {
      visit_regular_block<Largest>(ray, block, place, bound, cells);
      return;
    }
    AxisWalk walk = walk_block(ray, {block.begin, block.end}, place);
    AxisWalk::Step step;
    while (walk.next(step)) {
      ++cells.count;
      Value corner[8];
      load(step.cell, corner);
      if (visit_corners<Largest>(ray, step, corner, cells.gatherer.best(), cells) >= bound) return;
    }
  }

  /// Visits a cell by its corners. Returns the best value so far.
  template <bool Largest>
  double visit_corners(const GridRay& ray, const AxisWalk::Step& step, const Value (&corner)[8],
                       double best, Cells& cells) const {
    constexpr double sign = Largest ? 1 : -1;
    if (!(sign * static_cast<double>(best_of<Largest>(corner)) > best)) return best;
    const CubicBernstein<double> data = cubic(ray, step.cell, corner, step.begin, step.end);
    if (!((Largest ? data.hull_max() : -data.hull_min()) > best)) return best;
    cells.gatherer.add(data, step.end - step.begin);
    return cells.gatherer.best();
  }

  /// Visits a block of cells of width 1 likewise, whose values lie side by side, without branches
  /// from cell to cell. Positions of planes are sums of steps, off by 16 u, and a rest of the block
  /// that is shorter than GridRay::rest is left out: its data are continuous with those before.
  template <bool Largest>
  void visit_regular_block(const GridRay& ray, const CrossedBlock& block, const int (&place)[3],
                           double bound, Cells& cells) const {
    double next[3];
    std::ptrdiff_t move[3];
    int cell[3], turn[3];
    const Value* corner = grid_.data;
    for (int a = 0; a < 3; ++a) {
      const int first = place[a] * block_width,
                last = std::min(first + block_width, planes_.cells(a)) - 1;
      const double direction = ray.walk.direction[a];
      const double position = ray.walk.origin[a] + block.begin * direction;
      cell[a] = planes_.find(a, position, first, last);
      turn[a] = direction > 0 ? 1 : -1;
      const double plane = planes_[a][cell[a] + (direction > 0 ? 1 : 0)];
      next[a] = direction == 0 ? std::numeric_limits<double>::infinity()
                               : (plane - ray.walk.origin[a]) * ray.walk.inverse[a];
      move[a] = turn[a] * stride_[a];
      corner += offset_[static_cast<std::size_t>(a)][static_cast<std::size_t>(cell[a])];
    }
    const double step[3] = {std::abs(ray.walk.inverse[0]), std::abs(ray.walk.inverse[1]),
                            std::abs(ray.walk.inverse[2])};
    const double last = block.end - ray.rest;
    const std::ptrdiff_t y = stride_[1], z = stride_[2];
    double best = cells.gatherer.best(), t = block.begin;
    const auto advance = [&] {
      for (int a = 0; a < 3; ++a) {
        const bool reached = next[a] <= t;
        corner += reached ? move[a] : 0;
        cell[a] += reached ? turn[a] : 0;
        next[a] += reached ? step[a] : 0;
      }
    };
    const auto ahead = [&] { return std::min(next[0], std::min(next[1], next[2])); };
    if (ahead() <= t && ahead() < last) advance();
    for (;;) {
      const double until = ahead();
      const bool is_last = !(until < last);
      ++cells.count;
      const Value values[8] = {corner[0], corner[1],     corner[y],     corner[y + 1],
                               corner[z], corner[z + 1], corner[y + z], corner[y + z + 1]};
      if ((Largest ? 1 : -1) * static_cast<double>(best_of<Largest>(values)) > best) {
        best = visit_corners<Largest>(ray,
                                      {{cell[0], cell[1], cell[2]}, t, is_last ? block.end : until},
                                      values, best, cells);
        if (best >= bound) return;
      }
      if (is_last) return;
      t = until;
      advance();
    }
  }

  // All cells in order.

  void visit_all(const GridRay& ray, Interval<double> part, Cells& cells,
                 ValueGatherer::Errors& errors) const {
    AxisWalk blocks(block_planes_, ray.walk, part, first_block_, last_block_);
    AxisWalk::Step block;
    bool was_vacuum = true;
    while (blocks.next(block)) {
      AxisWalk walk = walk_block(ray, {block.begin, block.end}, block.cell);
      AxisWalk::Step step;
      const bool constant =
          !has_vacuum_ && records_[static_cast<int>(block_index(block.cell))].constant();
      if (constant && walk.next(step)) {
        ++cells.count;
        Value corner[8];
        load(step.cell, corner);
        cells.gatherer.add_constant(static_cast<double>(corner[0]), block.end - block.begin);
        continue;
      }
      while (walk.next(step)) {
        ++cells.count;
        visit_cell(ray, step, was_vacuum, cells, errors);
      }
    }
  }

  void visit_cell(const GridRay& ray, const AxisWalk::Step& step, bool& was_vacuum, Cells& cells,
                  ValueGatherer::Errors& errors) const {
    Value corner[8];
    const bool is_vacuum = !load(step.cell, corner);
    if (!has_vacuum_) {
      cells.gatherer.add(cubic(ray, step.cell, corner, step.begin, step.end),
                         step.end - step.begin);
      return;
    }
    const Touched touched = touched_planes(ray, step);
    // Rounding decides on which side of an edge or a face the ray is.
    if ((is_vacuum ? touched.edge || touched.along : touched.along) &&
        has_neighbor(step.cell, touched, is_vacuum)) {
      cells.is_unknown = true;
    }
    if (is_vacuum != was_vacuum) errors.position += touched.time_error;
    was_vacuum = is_vacuum;
    if (is_vacuum) return;
    const CubicBernstein<double> data = cubic(ray, step.cell, corner, step.begin, step.end);
    if (step.end - step.begin <= 4 * touched.time_error) {
      cells.gatherer.add_doubtful(data, step.end - step.begin);
      return;
    }
    cells.gatherer.add(data, step.end - step.begin);
    if (!cells.gatherer.is_extreme()) return;
    cells.gatherer.set_floor(cells.gatherer.sign() > 0
                                 ? static_cast<double>(best_of<false>(corner))
                                 : -static_cast<double>(best_of<true>(corner)));
  }

  /// Planes of a cell that a ray's step touches, within the error of positions.
  struct Touched {
    bool plane[3][2]{};     ///< by axis: the lower, the upper
    bool edge = false;      ///< planes of two axes at one end of the step
    bool along = false;     ///< a plane at both ends
    double time_error = 0;  ///< largest error of the position at which a plane is met
  };
  Touched touched_planes(const GridRay& ray, const AxisWalk::Step& step) const {
    Touched touched;
    int at_end[2] = {0, 0};
    const double t[2] = {step.begin, step.end};
    for (int a = 0; a < 3; ++a) {
      const double error = 2 * ray.error[a];
      bool at[2][2]{};  // by end, by plane
      for (int e = 0; e < 2; ++e) {
        const double position = ray.walk.origin[a] + t[e] * ray.walk.direction[a];
        for (int p = 0; p < 2; ++p) {
          at[e][p] = std::abs(position - planes_[a][step.cell[a] + p]) <= error;
          touched.plane[a][p] = touched.plane[a][p] || at[e][p];
        }
        if (at[e][0] || at[e][1]) {
          ++at_end[e];
          const double off = error * std::abs(ray.walk.inverse[a]);
          if (ray.walk.direction[a] != 0 && off < step.end - step.begin) {
            touched.time_error = std::max(touched.time_error, off);
          }
        }
      }
      touched.along = touched.along || (at[0][0] && at[1][0]) || (at[0][1] && at[1][1]);
    }
    touched.edge = at_end[0] > 1 || at_end[1] > 1;
    return touched;
  }

  /// Returns whether a cell across the touched planes has data, or has none.
  bool has_neighbor(const int (&cell)[3], const Touched& touched, bool with_data) const {
    int neighbor[3];
    for (int n = 0; n < 27; ++n) {
      const int step[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      bool is_there = true;
      for (int a = 0; a < 3; ++a) {
        neighbor[a] = cell[a] + step[a];
        is_there = is_there && neighbor[a] >= 0 && neighbor[a] < planes_.cells(a) &&
                   (step[a] == 0 || touched.plane[a][step[a] > 0 ? 1 : 0]);
      }
      Value corner[8];
      if (is_there && load(neighbor, corner) == with_data) return true;
    }
    return false;
  }

  const Volume& volume_;
  LayerProjection projection_;
  StructuredGrid<Value, double> grid_;
  const BlockRecords& records_;
  WalkPlanes planes_, block_planes_;
  int first_block_[3]{}, last_block_[3]{};
  std::vector<Clip> clips_;
  bool has_vacuum_;
  std::array<std::vector<std::ptrdiff_t>, 3> offset_;  ///< of the values on planes, by axis
  std::array<std::vector<double>, 3> inverse_width_;   ///< of cells, by axis
  std::ptrdiff_t stride_[3]{};                         ///< from value to value, by axis
  std::array<std::vector<bool>, 3> regular_;           ///< blocks of cells of width 1, by axis
  std::array<double, 3> least_width_{};                ///< of cells whose values differ along it
  std::array<double, 3> reach_{};                      ///< largest |coordinate| of the box
  std::vector<float> bounds_;                          ///< of blocks, times sign
};

/// Gives the lambda below its result. With a result that the lambda names (->), clang 14 leaves the
/// virtual members of GridProjector undefined.
template <class Value>
std::unique_ptr<const LayerProjector> make_projector(const ProjectorTask& task,
                                                     const Volume& volume,
                                                     const StructuredGrid<Value, double>& grid) {
  return std::make_unique<GridProjector<Value>>(task, volume, grid);
}

}  // namespace

std::unique_ptr<const LayerProjector> make_grid_projector(const ProjectorTask& task) {
  const Volume& volume = *std::get<VolumeContent>(task.layer.content).volume;
  return volume.visit([&](const auto& grid) { return make_projector(task, volume, grid); });
}

}  // namespace pellucid

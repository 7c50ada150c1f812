// SPDX-License-Identifier: Apache-2.0
#include "layer_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <variant>

#include "pellucid/field/sample.h"

namespace pellucid::view {

namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

/// Positions in a face of the grid are in the grid, however their coordinates were rounded: a share
/// of the box.
constexpr double share_of_slack = 1e-12;
/// The same for weights of a tetrahedron's corners.
constexpr double weight_slack = 1e-12;

/// Returns the weights of a tetrahedron's corners at a position, given relative to it; none outside
/// and of a tetrahedron without volume.
std::optional<std::array<double, 4>> corner_weights(const std::array<Vec3<double>, 4>& corners) {
  std::array<double, 4> weights;
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3<double>&a = corners[(i + 1) % 4], &b = corners[(i + 2) % 4],
          &c = corners[(i + 3) % 4];
    weights[i] = (i % 2 == 0 ? 1 : -1) * dot(a, cross(b, c));
    sum += weights[i];
  }
  if (sum == 0) return {};
  for (double& weight : weights) {
    weight /= sum;
    if (!(weight >= -weight_slack)) return {};
  }
  return weights;
}

std::array<Vec3<double>, 4> corners_of(const TetrahedralMesh& mesh, std::size_t tetrahedron) {
  std::array<Vec3<double>, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto point = mesh.tetrahedra()[tetrahedron][static_cast<int>(i)];
    corners[i] = mesh.points()[static_cast<std::size_t>(point)];
  }
  return corners;
}

std::array<Vec3<double>, 4> relative_to(std::array<Vec3<double>, 4> corners,
                                        const Vec3<double>& position) {
  for (Vec3<double>& corner : corners) corner = corner - position;
  return corners;
}

double value_in(const MeshChannels& mesh, int channel, std::size_t tetrahedron,
                const std::array<double, 4>& weights) {
  if (mesh[channel].centering == Centering::cell) return mesh.value(channel, tetrahedron);
  double value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto point = mesh.mesh().tetrahedra()[tetrahedron][static_cast<int>(i)];
    value += weights[i] * mesh.value(channel, static_cast<std::size_t>(point));
  }
  return value;
}

/// Returns whether a channel has a NaN at a corner of the tetrahedron, or in it.
bool is_vacuum_in(const MeshChannels& mesh, std::size_t tetrahedron) {
  if (mesh.vacuum_count() == 0) return false;
  for (int c = 0; c < mesh.count(); ++c) {
    if (std::isnan(value_in(mesh, c, tetrahedron, {0.25, 0.25, 0.25, 0.25}))) return true;
  }
  return false;
}

double sample(const Volume& volume, const Vec3<double>& in_grid) {
  return volume.visit([&](const auto& grid) { return sample_value<double>(grid, in_grid); });
}

/// Returns the first and one past the last of `count` middles, from `from` to `to`, that may be in
/// [lower, upper].
std::pair<int, int> middles_within(double from, double to, int count, double lower, double upper) {
  const double width = (to - from) / count;
  double first = (lower - from) / width, last = (upper - from) / width;
  if (first > last) std::swap(first, last);
  const auto clamped = [&](double i) { return static_cast<int>(std::clamp(i, 0.0, 1.0 * count)); };
  return {clamped(std::floor(first - 1)), clamped(std::ceil(last + 1))};
}

}  // namespace

Vec3<double> SlicePlane::at(int column, int row) const noexcept {
  const auto middle = [&](std::size_t end, int i, int count) {
    return from[end] + (to[end] - from[end]) * ((i + 0.5) / count);
  };
  Vec3<double> world{};
  world[axis] = position;
  world[column_axis()] = middle(0, column, columns);
  world[row_axis()] = middle(1, row, rows);
  return world;
}

LayerValues::LayerValues(const Layer& layer)
    : world_from_data_(layer.transform), data_from_world_(inverse(layer.transform)) {
  if (const auto* volume = std::get_if<VolumeContent>(&layer.content)) {
    channels_ = {volume->volume.get()};
    if (volume->mask) labels_ = std::make_unique<LabelAxes>(volume->mask->labels().volume());
  } else if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    for (const Channel& channel : *channels->channels) channels_.push_back(channel.volume.get());
  } else if (const auto* labels = std::get_if<LabelContent>(&layer.content)) {
    labels_ = std::make_unique<LabelAxes>(labels->labels->volume());
  } else if (const auto* mesh = std::get_if<MeshContent>(&layer.content)) {
    mesh_ = mesh->mesh.get();
  }
  const Volume* const grid = grid_of(layer);
  if (grid == nullptr) return;
  voxels_ = std::make_unique<LabelAxes>(*grid);
  grid_from_data_ = grid->grid_from_world();
  lower_ = grid->grid_lower();
  upper_ = grid->grid_upper();
  slack_ = (upper_ - lower_) * share_of_slack;
}

std::optional<Vec3<double>> LayerValues::in_grid(const Vec3<double>& world) const {
  if (!voxels_) return {};
  const Vec3<double> at = grid_from_data_.point(data_from_world_.point(world));
  for (int a = 0; a < 3; ++a) {
    if (!(at[a] >= lower_[a] - slack_[a] && at[a] <= upper_[a] + slack_[a])) return {};
  }
  return at;
}

/// Tells whether a channel has a NaN around a position.
bool LayerValues::is_vacuum(const Vec3<double>& in_grid) const {
  return std::ranges::any_of(channels_, [&](const Volume* volume) {
    return volume->statistics().nan > 0 && std::isnan(sample(*volume, in_grid));
  });
}

std::vector<double> LayerValues::at(const Vec3<double>& world) const {
  std::vector<double> values;
  if (mesh_ != nullptr) {
    const Vec3<double> position = data_from_world_.point(world);
    for (std::size_t t = 0; t < mesh_->mesh().tetrahedra().size(); ++t) {
      const auto weights = corner_weights(relative_to(corners_of(mesh_->mesh(), t), position));
      if (!weights) continue;
      if (is_vacuum_in(*mesh_, t)) return {};
      for (int c = 0; c < mesh_->count(); ++c) values.push_back(value_in(*mesh_, c, t, *weights));
      return values;
    }
    return {};
  }
  const auto position = in_grid(world);
  if (!position || is_vacuum(*position)) return {};
  for (const Volume* volume : channels_) values.push_back(sample(*volume, *position));
  return values;
}

void LayerValues::fill(int channel, const SlicePlane& plane, const ParallelFor& parallel,
                       std::span<float> values) const {
  std::ranges::fill(values, no_value);
  if (mesh_ != nullptr) {
    fill_mesh(channel, plane, parallel, values);
  } else if (!channels_.empty()) {
    fill_grid(channel, plane, parallel, values);
  }
}

void LayerValues::fill_grid(int channel, const SlicePlane& plane, const ParallelFor& parallel,
                            std::span<float> values) const {
  const Volume& volume = *channels_[static_cast<std::size_t>(channel)];
  volume.visit([&](const auto& grid) {
    parallel_or_serial(parallel)(plane.rows, [&](int first, int last) {
      for (int row = first; row < last; ++row) {
        for (int column = 0; column < plane.columns; ++column) {
          const auto position = in_grid(plane.at(column, row));
          if (!position || is_vacuum(*position)) continue;
          values[plane.index(column, row)] =
              static_cast<float>(sample_value<double>(grid, *position));
        }
      }
    });
  });
}

/// Writes each tetrahedron that the plane cuts. Threads share the rows.
void LayerValues::fill_mesh(int channel, const SlicePlane& plane, const ParallelFor& parallel,
                            std::span<float> values) const {
  const int u = plane.column_axis(), v = plane.row_axis();
  const auto fill_rows = [&](int first, int last, std::size_t t) {
    std::array<Vec3<double>, 4> corners = corners_of(mesh_->mesh(), t);
    for (Vec3<double>& corner : corners) corner = world_from_data_.point(corner);
    Vec3<double> lower = corners[0], upper = corners[0];
    for (const Vec3<double>& corner : corners) {
      for (int a = 0; a < 3; ++a) {
        lower[a] = std::min(lower[a], corner[a]);
        upper[a] = std::max(upper[a], corner[a]);
      }
    }
    if (!(plane.position >= lower[plane.axis] && plane.position <= upper[plane.axis])) return;
    const auto [left, right] =
        middles_within(plane.from[0], plane.to[0], plane.columns, lower[u], upper[u]);
    const auto [top, bottom] =
        middles_within(plane.from[1], plane.to[1], plane.rows, lower[v], upper[v]);
    if (left >= right || top >= bottom || is_vacuum_in(*mesh_, t)) return;
    for (int row = std::max(top, first); row < std::min(bottom, last); ++row) {
      for (int column = left; column < right; ++column) {
        const auto weights = corner_weights(relative_to(corners, plane.at(column, row)));
        if (!weights) continue;
        values[plane.index(column, row)] =
            static_cast<float>(value_in(*mesh_, channel, t, *weights));
      }
    }
  };
  parallel_or_serial(parallel)(plane.rows, [&](int first, int last) {
    for (std::size_t t = 0; t < mesh_->mesh().tetrahedra().size(); ++t) fill_rows(first, last, t);
  });
}

std::optional<std::int32_t> LayerValues::label_at(const Vec3<double>& world) const {
  const auto voxel = labels_ ? voxel_at(world) : std::nullopt;
  if (!voxel) return {};
  const double label = labels_->value({(*voxel)[0], (*voxel)[1], (*voxel)[2]});
  return std::isnan(label) ? std::nullopt : std::optional(static_cast<std::int32_t>(label));
}

void LayerValues::fill_labels(const SlicePlane& plane, const ParallelFor& parallel,
                              std::span<std::int32_t> labels) const {
  parallel_or_serial(parallel)(plane.rows, [&](int first, int last) {
    for (int row = first; row < last; ++row) {
      for (int column = 0; column < plane.columns; ++column) {
        labels[plane.index(column, row)] = label_at(plane.at(column, row)).value_or(no_label);
      }
    }
  });
}

std::optional<std::array<int, 3>> LayerValues::voxel_at(const Vec3<double>& world) const {
  const auto position = in_grid(world);
  if (!position) return {};
  std::array<int, 3> voxel;
  for (int a = 0; a < 3; ++a) {
    voxel[static_cast<std::size_t>(a)] = find_cell(voxels_->axis()[a], (*position)[a]);
  }
  return voxel;
}

std::array<SliceSteps, 3> slice_steps(const Layer& layer) {
  std::array<SliceSteps, 3> steps;
  const Volume* const grid = grid_of(layer);
  if (grid == nullptr) {
    for (SliceSteps& along : steps) along.step = voxel_of(moved_into_place(layer));
    return steps;
  }
  const auto& [dimensions, centering, placement, coordinates, name] = grid->description();
  const auto edge = [&](const Vec3<double>& in_grid) {
    return layer.transform.vector(grid->world_from_grid().vector(in_grid));
  };
  const Vec3<double> columns[3] = {edge({1, 0, 0}), edge({0, 1, 0}), edge({0, 0, 1})};
  for (int a = 0; a < 3; ++a) {
    // The axis of the grid that is closest to this one; the others are across it, or oblique.
    const auto cosine = [&](int g) { return std::abs(columns[g][a]) / length(columns[g]); };
    int closest = 0;
    for (const int g : {1, 2}) {
      if (cosine(g) > cosine(closest)) closest = g;
    }
    bool is_straight = true;
    for (const int g : {0, 1, 2}) is_straight = is_straight && (g == closest || cosine(g) < 1e-6);
    const auto g = static_cast<std::size_t>(closest);
    const int count = dimensions[g];
    const Vec3<double>& along = columns[closest];
    SliceSteps& wanted = steps[static_cast<std::size_t>(a)];
    const auto world_of = [&](double in_grid) {
      Vec3<double> position = grid->grid_lower();
      position[closest] = in_grid;
      return layer.transform.point(grid->world_from_grid().point(position))[a];
    };
    const double first = coordinates[g].empty() ? 0 : coordinates[g].front();
    const double last = coordinates[g].empty() ? count - 1 : coordinates[g].back();
    wanted.step = std::abs(along[a]) * (last - first) / std::max(count - 1, 1);
    if (!(wanted.step > 0)) wanted.step = std::abs(along[a]) > 0 ? std::abs(along[a]) : 1;
    if (!is_straight) continue;
    if (coordinates[g].empty()) {
      wanted.first = std::min(world_of(0), world_of(count - 1));
      wanted.count = count;
      continue;
    }
    for (int i = 0; i < count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const std::vector<double>& at = coordinates[g];
      wanted.positions.push_back(
          world_of(centering == Centering::cell ? std::midpoint(at[n], at[n + 1]) : at[n]));
    }
    std::ranges::sort(wanted.positions);
  }
  return steps;
}

}  // namespace pellucid::view

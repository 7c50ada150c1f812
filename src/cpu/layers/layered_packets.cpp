// SPDX-License-Identifier: Apache-2.0
#include "layered_packets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <utility>

#include "grid/grid_light.h"
#include "grid/packet_tracer.h"
#include "layer_merge.h"
#include "medium_parts.h"
#include "packet_setup.h"
#include "pellucid/render/multivariate_integrator.h"
#include "sample/sampled_multivariate_storage.h"

namespace pellucid {
namespace {

using Row = PellucidLayerRow;

bool is_one_table(const MultivariateTransfer<double>& function) {
  return function.gaussians.count == 0 && function.tables == 1 && function.channels == 1;
}

using Kernel = void (*)(PellucidLayeredJob*);

/// Null: there are no packets here.
Kernel find_kernel(std::optional<InstructionSet> wanted) {
  return PELLUCID_KERNEL_OF(packet_instruction_set(wanted), pellucid_integrate_layers);
}

/// Memory of a packet's state.
class AlignedBytes {
 public:
  explicit AlignedBytes(std::size_t size)
      : bytes_(static_cast<unsigned char*>(::operator new(size, alignment))) {}
  ~AlignedBytes() { ::operator delete(bytes_, alignment); }
  AlignedBytes(const AlignedBytes&) = delete;
  AlignedBytes& operator=(const AlignedBytes&) = delete;
  unsigned char* get() const { return bytes_; }

 private:
  static constexpr std::align_val_t alignment{64};
  unsigned char* bytes_;
};

}  // namespace

bool LayeredPackets::suit(const LayerSetting& setting) {
  const RayTolerance& wanted = setting.wanted;
  return find_kernel(setting.instruction_set) != nullptr && wanted.grade != Grade::proved &&
         wanted.precision == Precision::automatic && wanted.tolerance >= min_packet_tolerance &&
         setting.lights.size() <= std::size_t{PacketLight::max_lights} &&
         setting.integration.method == Method::exact;
}

std::unique_ptr<const LayeredPackets> LayeredPackets::make(
    const std::vector<ClippedLayer>& layers, const std::vector<LightSource<double>>& lights,
    const RayTolerance& wanted, bool depth) {
  if (layers.empty() || layers.size() > std::size_t{Row::max_layers} ||
      !suit(layers[0].setup->setting())) {
    return nullptr;
  }
  const Kernel kernel = find_kernel(layers[0].setup->setting().instruction_set);
  auto result =
      std::unique_ptr<LayeredPackets>(new LayeredPackets(layers, lights, wanted, depth, kernel));
  if (!is_moderate(result->extent_) || wanted.largest_color > 1e12) return nullptr;
  const bool any =
      std::ranges::any_of(result->seen_, [](const SeenLayer& one) { return one.in_lanes; });
  if (!any || result->marks_ > Row::most_marks ||
      result->seen_.size() > std::size_t{Row::max_layers}) {
    return nullptr;
  }
  return result;
}

LayeredPackets::LayeredPackets(const std::vector<ClippedLayer>& layers,
                               const std::vector<LightSource<double>>& lights,
                               const RayTolerance& wanted, bool depth, Kernel kernel)
    : layers_(layers), lights_(lights), wanted_(wanted), kernel_(kernel) {
  std::vector<Vec3<double>> corners;
  for (const ClippedLayer& layer : layers) {
    for (const Vec3<double>& corner : world_corners(layer.setup->layer())) {
      corners.push_back(corner);
    }
  }
  PacketLight all;
  origin_ = place_lights(corners, lights, all);
  extent_ = static_cast<double>(all.farthest);
  double largest_extinction = 0;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    add(layers[i], i, all);
    largest_extinction += layers[i].setup->largest_extinction();
  }
  for (const BinnedTransferStorage& function : functions_) function_.emplace_back(&function.view());
  for (const SeenLayer& one : seen_) {
    light_.emplace_back(one.light ? &*one.light : nullptr);
    grid_.push_back(one.grid.empty() ? nullptr : one.grid.data());
    lit_grid_.push_back(one.lit_grid);
    mixture_.emplace_back(one.mixture ? &*one.mixture : nullptr);
  }
  job_.layers = static_cast<std::int32_t>(seen_.size());
  job_.functions = function_.data();
  job_.light = light_.data();
  job_.grid = grid_.data();
  job_.lit_grid = lit_grid_.data();
  job_.mixture = mixture_.data();
  job_.largest_color = std::max(wanted.largest_color, 1.0);
  // A surface is opaque whatever its length.
  job_.largest_extinction = marks_ > 0 ? 1e30 : std::min(largest_extinction * 1.0001, 1e30);
  job_.depth = depth ? 1 : 0;
  job_.step = PellucidLayeredJob::size;
  kernel_(&job_);
}

void LayeredPackets::add(const ClippedLayer& layer, std::size_t number, const PacketLight& lights) {
  const LayerSource& source = layer.setup->source();
  const LayerAppearance& look = source.look();
  first_mark_.push_back(marks_);
  if (look.has_surfaces()) marks_ += static_cast<int>(look.isosurfaces().size()) + 1;
  const std::vector<MultivariateTransfer<double>>& functions = source.functions();
  const std::size_t first = seen_.size();
  const auto begin = [&]() -> SeenLayer& {
    SeenLayer& one = seen_.emplace_back();
    one.source = &source;
    one.layer = number;
    return one;
  };
  const bool is_sum = functions.size() == 1 && !is_one_table(functions[0]);
  if (is_sum) {
    // Terms of one function are layers that overlap.
    const MultivariateTransfer<double>& function = functions[0];
    for (int i = 0; i < function.tables; ++i) {
      SeenLayer& one = begin();
      one.variable = function.table[i].channel;
      one.table = {&function.table[i].table};
    }
    if (function.gaussians.count > 0) {
      SeenLayer& one = begin();
      for (int i = 0; i < function.gaussians.count; ++i) {
        one.gaussians.push_back(rounded_to_binary32(function.gaussians.primitive[i]));
      }
      one.mixture = {{one.gaussians.data(), function.gaussians.count}, function.channels};
    }
  } else {
    SeenLayer& one = begin();
    for (const MultivariateTransfer<double>& function : functions) {
      one.table.push_back(&function.table[0].table);
    }
  }
  bool all = true;
  for (std::size_t i = first; i < seen_.size(); ++i)
    all = prepare(seen_[i], lights, functions_) && all;
  // What packets do not know of a part of a layer they do not know of the layer.
  for (std::size_t i = first; i < seen_.size(); ++i) seen_[i].in_lanes = all;
}

/// Rays of a packet, one per lane, and what lies ahead of them.
class LayeredPackets::Packet {
 public:
  explicit Packet(const LayeredPackets& of)
      : of_(of),
        job_(of.job_),
        state_(static_cast<std::size_t>(job_.state_size)),
        lanes_(static_cast<std::size_t>(job_.lanes)),
        layers_(of.seen_.size()),
        head_(lanes_ * Row::of_a_ray * Row::head_fields),
        part_(layers_ * Row::max_lanes * Row::of_a_ray * Row::part_fields),
        curves_(layers_),
        row_(lanes_ * Row::of_a_ray),
        range_(2 * lanes_ * Row::of_a_ray),
        walk_(layers_),
        again_(of.layers_, of.lights_, job_.largest_color, false),
        media_(again_.sources(), of.lights_) {
    for (std::size_t l = 0; l < lanes_; ++l) {
      merge_.emplace_back(of.layers_, of.lights_, job_.largest_color, true);
    }
    for (std::size_t k = 0; k < layers_; ++k) {
      if (!of.seen_[k].mixture) continue;
      curves_[k].resize(lanes_ * Row::of_a_ray * curve_fields(k));
      curve_[k] = curves_[k].data();
    }
    job_.curves = curve_.data();
    job_.state = state_.get();
    job_.head = head_.data();
    job_.part = part_.data();
    job_.range = range_.data();
    job_.walk = walk_.data();
    job_.results = results_.data();
  }

  bool is_full() const { return used_ == lanes_; }
  bool is_empty() const { return used_ == 0; }

  /// Takes a part into a lane. Returns false if there is nothing on it.
  bool take(const RayPart& part, double tolerance, std::size_t number) {
    const Interval<double> inside = merge_[used_].start(part);
    if (inside.empty()) return false;
    const std::size_t l = used_++;
    inside_[l] = inside;
    ray_[l] = part.ray;
    number_[l] = number;
    tolerance_[l] = tolerance;
    return true;
  }

  /// Follows the rays that were taken, and makes room for others.
  void follow(std::vector<RayResult>& results, const std::stop_token& stop) {
    begin();
    for (bool goes_on = true; goes_on && !stop.stop_requested();) {
      for (std::size_t l = 0; l < used_; ++l) {
        if (job_.done[l] == 0) fill(l);
      }
      run(PellucidLayeredJob::go_on);
      goes_on = false;
      for (std::size_t l = 0; l < used_; ++l) {
        job_.gives_up[l] = job_.waits[l] != 0 && !integrate(l) ? 1 : 0;
        gave_up_[l] = gave_up_[l] || job_.gives_up[l] != 0;
        goes_on = goes_on || job_.done[l] == 0;
      }
    }
    run(PellucidLayeredJob::finish);
    for (std::size_t l = 0; l < used_; ++l) {
      RayResult& to = results[number_[l]];
      to = left_ray_result();
      if (gave_up_[l] || !(results_[l].error <= tolerance_[l])) continue;
      read_result(results_[l], to);
      if (of_.marks_ > 0) {
        // Nobody knows on which side of a surface a place in binary32 is.
        to.half = {};
      } else {
        to.half.range.begin += inside_[l].begin;
        to.half.range.end += inside_[l].begin;
      }
    }
    used_ = 0;
  }

 private:
  void run(PellucidLayeredJob::Step step) {
    job_.step = step;
    of_.kernel_(&job_);
  }

  void begin() {
    job_.count = static_cast<std::int32_t>(used_);
    for (std::size_t l = 0; l < std::size_t{Row::max_lanes}; ++l) {
      const std::size_t from = l < used_ ? l : 0;
      job_.tolerance[l] = static_cast<float>(tolerance_[from]);
      job_.length[l] = single_above(inside_[from].end - inside_[from].begin + beyond(from));
      job_.to_eye[0][l] = -static_cast<float>(ray_[from].direction.x);
      job_.to_eye[1][l] = -static_cast<float>(ray_[from].direction.y);
      job_.to_eye[2][l] = -static_cast<float>(ray_[from].direction.z);
      job_.next[l] = job_.end[l] = job_.done[l] = job_.waits[l] = 0;
      job_.gives_up[l] = 0;
      ended_[l] = gave_up_[l] = false;
      for (std::size_t k = 0; k < layers_; ++k) place_in_grid(k, l, ray_[from]);
    }
    run(PellucidLayeredJob::begin);
  }

  /// Takes a lane's ray into the coordinates of a layer's planes.
  void place_in_grid(std::size_t layer, std::size_t lane, const Ray<double>& ray) {
    const SeenLayer& seen = of_.seen_[layer];
    if (seen.grid.empty()) return;
    const Ray<double> in_grid = seen.source->cells()->grid_from_world().ray(ray);
    PellucidGridRays& to = walk_[layer];
    for (int a = 0; a < 3; ++a) {
      const bool is_uniform = seen.plane[a].empty();
      to.origin[a][lane] = in_grid.origin[a] + (is_uniform ? seen.grid[0].padding[a] : 0);
      to.direction[a][lane] = in_grid.direction[a];
      to.plane[a] = is_uniform ? nullptr : seen.plane[a].data();
    }
  }

  /// Returns how much longer a ray counts as where there are surfaces: one may be at the very end.
  double beyond(std::size_t lane) const {
    return of_.marks_ > 0 ? 1e-6 * (inside_[lane].end - inside_[lane].begin) : 0;
  }

  /// Numbers that a row has of a layer of several variables.
  std::size_t curve_fields(std::size_t layer) const {
    return static_cast<std::size_t>(Row::curve_fields(of_.seen_[layer].mixture->channels));
  }
  std::size_t slot(std::size_t lane, std::int32_t row) const {
    return lane * Row::of_a_ray + static_cast<std::size_t>(row & (Row::of_a_ray - 1));
  }

  /// Finds as many rows of a ray as there is room for.
  void fill(std::size_t lane) {
    // A row that waits for the caller stays until it was integrated.
    while (!ended_[lane] && job_.end[lane] - job_.next[lane] < Row::of_a_ray - 1) {
      const std::size_t at = slot(lane, job_.end[lane]);
      float* const head = &head_[at * Row::head_fields];
      if (!merge_[lane].next(row_[at])) {
        ended_[lane] = true;
        head[Row::kind] = Row::end;
        head[Row::length] = head[Row::left] = head[Row::left_out] = head[Row::position_error] = 0;
        ++job_.end[lane];
        return;
      }
      if (write(lane, at, row_[at], head)) ++job_.end[lane];
    }
  }

  /// Writes a row. Returns false if there is nothing to be told.
  bool write(std::size_t lane, std::size_t at, const MergedPart& part, float* head) {
    head[Row::length] = static_cast<float>(part.range.end - part.range.begin);
    head[Row::left] = static_cast<float>(inside_[lane].end - part.range.begin + beyond(lane));
    head[Row::position_error] = single_above(part.position_error);
    head[Row::left_out] = single_above(part.left_out);
    head[Row::present] = 0;
    const auto set = [&](Row::Kind kind) { head[Row::kind] = static_cast<float>(kind); };
    switch (part.kind) {
      case MergedPart::Kind::unknown:
        set(Row::unknown);
        head[Row::opacity] = single_above(part.opacity);
        return true;
      case MergedPart::Kind::absent:
        set(Row::absent);
        return part.left_out > 0;
      case MergedPart::Kind::surface:
        set(Row::surface);
        head[Row::opacity] = static_cast<float>(part.opacity);
        head[Row::color] = static_cast<float>(part.color.r);
        head[Row::color + 1] = static_cast<float>(part.color.g);
        head[Row::color + 2] = static_cast<float>(part.color.b);
        head[Row::error] = single_above(part.error);
        return true;
      case MergedPart::Kind::mark:
      case MergedPart::Kind::doubt:
        set(part.kind == MergedPart::Kind::mark ? Row::mark : Row::doubt);
        head[Row::opacity] = single_above(part.opacity);
        head[Row::mark_number] =
            static_cast<float>(of_.first_mark_[part.layer] + static_cast<int>(part.isosurface));
        return true;
      case MergedPart::Kind::medium:
        break;
    }
    const Vec3<double> entry =
        ray_[lane].origin + ray_[lane].direction * part.range.begin - of_.origin_;
    head[Row::entry] = static_cast<float>(entry.x);
    head[Row::entry + 1] = static_cast<float>(entry.y);
    head[Row::entry + 2] = static_cast<float>(entry.z);
    range_[2 * at] = part.range.begin;
    range_[2 * at + 1] = part.range.end;
    const LayerMerge& merge = merge_[lane];
    int present = 0;
    bool for_lanes = true;
    for (std::size_t k = 0; k < layers_ && for_lanes; ++k) {
      const SeenLayer& layer = of_.seen_[k];
      const int number = merge.key()[layer.layer];
      if (number < 0) continue;
      float* const to = &part_[(k * Row::max_lanes * Row::of_a_ray + at) * Row::part_fields];
      bool absorbs = true;
      float* const curves = layer.mixture ? &curves_[k][at * curve_fields(k)] : nullptr;
      for_lanes = write_part(layer, number, *merge.stretches()[layer.layer], part.range, to, curves,
                             absorbs);
      if (absorbs) present |= 1 << k;
    }
    if (for_lanes && present == 0) {
      set(Row::absent);
      return part.left_out > 0;
    }
    set(for_lanes ? Row::medium : Row::by_host);
    head[Row::present] = static_cast<float>(present);
    return true;
  }

  /// Calls visit(part) for what layers there are on a part of a lane's ray, which is followed anew.
  /// What has no length has rows of its own.
  template <class Visit>
  void follow_again(std::size_t lane, Interval<double> range, const Visit& visit) {
    if (again_.start({ray_[lane], range}).empty()) return;
    for (MergedPart part; again_.next(part);) {
      const bool has_length =
          part.kind == MergedPart::Kind::medium || part.kind == MergedPart::Kind::absent;
      if (has_length) visit(part);
    }
  }

  /// Integrates what is left of a row that lanes are not for. Returns false if the ray has spent so
  /// much that it had better be followed by itself.
  bool integrate(std::size_t lane) {
    const MergedPart& row = row_[slot(lane, job_.next[lane] - 1)];
    const double whole = row.range.end - row.range.begin;
    const Interval<double> range{
        row.range.begin + job_.from[lane] * whole,
        job_.to[lane] < 1 ? row.range.begin + job_.to[lane] * whole : row.range.end};
    const double length = range.end - range.begin;
    double most = 0;
    follow_again(lane, range, [&](const MergedPart& part) {
      double sum = part.left_out;
      for (std::size_t i = 0; i < again_.sources().size(); ++i) {
        if (part.kind == MergedPart::Kind::medium && again_.key()[i] >= 0) {
          sum += most_extinction(*again_.sources()[i], again_.key()[i], *again_.stretches()[i]);
        }
      }
      most = std::max(most, sum);
    });
    const double opacity = std::min(most * length, 1.0);
    const double allowed = job_.allowance_per_opacity[lane] * opacity + job_.allowance_flat[lane];
    const double share = length / (inside_[lane].end - inside_[lane].begin);
    if (!(allowed >= RayBudget<double>::minimum_allowance(tolerance_[lane], share))) return false;
    RayTolerance wanted = of_.wanted_;
    wanted.tolerance = std::min(allowed, largest_tolerance);
    const MultivariateTransfer<double> nothing{};
    MultivariateRayIntegrator integrator(nothing, most, wanted, length);
    follow_again(lane, range, [&](const MergedPart& part) {
      if (integrator.done()) return;
      if (part.kind == MergedPart::Kind::medium) {
        media_.add(part, again_.key(), again_.stretches(), ray_[lane], integrator);
      } else {
        integrator.skip(part.range.end - part.range.begin, part.left_out);
      }
    });
    // Nothing is left, unless that was charged.
    if (!integrator.done()) integrator.set_remaining_length(0);
    job_.handed[lane] = scalar_fallback(integrator.result(), opacity);
    return true;
  }

  /// A bound on the extinction of a layer on a stretch.
  static double most_extinction(const LayerSource& source, int number,
                                const LayerStretch& stretch) {
    const MultivariateTransfer<double>& function =
        source.functions()[static_cast<std::size_t>(number)];
    if (!is_one_table(function) || source.look().extinction_factor() != nullptr) {
      return source.most_extinction();
    }
    return most_extinction_on(function.table[0].table, stretch.data[0], stretch.value_error[0]);
  }

  const LayeredPackets& of_;
  PellucidLayeredJob job_;
  AlignedBytes state_;
  std::size_t lanes_, layers_, used_ = 0;
  std::vector<float> head_, part_;
  std::vector<std::vector<float>> curves_;  ///< of layers of several variables
  std::array<const float*, Row::max_layers> curve_{};
  std::vector<MergedPart> row_;         ///< what rows were made from
  std::vector<double> range_;           ///< of rows: begin and end
  std::vector<PellucidGridRays> walk_;  ///< of layers
  std::deque<LayerMerge> merge_;        ///< of each lane
  LayerMerge again_;                    ///< of what lanes are not for
  MediumParts media_;
  std::array<PellucidRayResult, Row::max_lanes> results_{};
  // Of the lanes' rays.
  std::array<Interval<double>, Row::max_lanes> inside_{};
  std::array<Ray<double>, Row::max_lanes> ray_{};
  std::array<std::size_t, Row::max_lanes> number_{};
  std::array<double, Row::max_lanes> tolerance_{};
  std::array<bool, Row::max_lanes> ended_{}, gave_up_{};
};

std::vector<RayResult> LayeredPackets::integrate(const std::vector<RayPart>& parts,
                                                 const std::vector<double>& tolerances,
                                                 const std::stop_token& stop) const {
  std::vector<RayResult> results(parts.size(), missed_ray_result());
  if (parts.empty()) return results;
  Packet packet(*this);
  for (std::size_t i = 0; i < parts.size() && !stop.stop_requested(); ++i) {
    if (packet.take(parts[i], tolerances[i], i) && packet.is_full()) packet.follow(results, stop);
  }
  if (!packet.is_empty()) packet.follow(results, stop);
  return results;
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "layers/interval_near.h"
#include "pellucid/render/integrate_mesh_ray.h"
#include "pellucid/scene/error.h"
#include "variables_source.h"

namespace pellucid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string quoted(const char* what, const std::string& name) {
  return name.empty() ? what : what + (" \"" + name + "\"");
}
std::string text(double x) {
  std::array<char, 32> shortest;
  const auto end = std::to_chars(shortest.data(), shortest.data() + shortest.size(), x).ptr;
  return {shortest.data(), end};
}
std::string text(const Vec3<double>& v) {
  return "(" + text(v.x) + ", " + text(v.y) + ", " + text(v.z) + ")";
}
bool is_finite(const CubicBernstein<double>& f) {
  return std::isfinite(f.b[0]) && std::isfinite(f.b[1]) && std::isfinite(f.b[2]) &&
         std::isfinite(f.b[3]);
}

/// A field of one's own.
class OwnSource : public VariablesSource {
 public:
  explicit OwnSource(const LayerTask& task)
      : VariablesSource(task, std::get<SourceContent>(task.layer.content).transfer_function),
        source_(*std::get<SourceContent>(task.layer.content).source) {
    if (task.layer.shading) demand_.gradient = task.layer.shading->channel;
    if (task.layer.gradient_opacity) demand_.magnitude = task.layer.gradient_opacity->channel();
  }

  std::unique_ptr<LayerStream> stream(bool by_cells) const override;

  const StretchSource::Description& description() const { return source_.description(); }
  const StretchDemand& demand() const { return demand_; }
  /// Begins the message of an error.
  std::string name() const {
    return quoted("layer", look().layer().name) + ": its " +
           quoted("stretch source", description().name);
  }

 private:
  const StretchSource& source_;
  StretchDemand demand_;
};

/// Returns what a call of somebody else's code returns. Throws Error for any exception.
template <class Call>
auto call_of(const OwnSource& source, const Call& call) {
  try {
    return call();
  } catch (const std::exception& error) {
    throw Error(source.name() + " fails: " + error.what());
  } catch (...) {
    throw Error(source.name() + " fails with an exception that is no std::exception; throw Error");
  }
}

/// Holds what a stream tells against what it promises.
class Promises {
 public:
  /// Which no ray through data that fit into memory has.
  static constexpr long max_stretches = 1L << 22;

  explicit Promises(const OwnSource& source) : source_(source) {}

  void start(const Ray<double>& ray, Interval<double> interval) {
    ray_ = ray;
    box_ = interval_near(source_.description().bounds, ray);
    last_ = -infinity;
    told_ = 0;
    if (std::isnan(interval.begin) || std::isnan(interval.end)) {
      fail("tells an interval that is not a number; let start() return numbers");
    }
  }
  void restrict_to_range() { last_ = -infinity; }

  /// Returns the interval of the ray near the bounds.
  Interval<double> box() const { return box_; }

  void check(const FieldStretch& stretch) {
    if (++told_ > max_stretches) {
      fail("tells more than " + std::to_string(max_stretches) +
           " stretches; let next() return false behind the last one");
    }
    if (!std::isfinite(stretch.begin) || !std::isfinite(stretch.end)) {
      fail("tells a stretch" + place(stretch) + "; let both be finite");
    }
    require_error(stretch, stretch.position_error, "position_error");
    const double off = stretch.position_error + 64 * rounding_unit<double> * std::abs(stretch.end);
    if (stretch.begin > stretch.end + off) {
      fail("tells a stretch" + place(stretch) + "; let it end behind its begin");
    }
    if (stretch.begin < last_ - off) {
      fail("tells a stretch" + place(stretch) + " behind one that ends at " + text(last_) +
           "; tell them front to back");
    }
    last_ = std::max(last_, stretch.end);
    if (!(stretch.begin < stretch.end)) return;
    check_bounds(stretch, off);
    for (int c = 0; c < source_.functions().front().channels; ++c) check_variable(stretch, c);
    if (source_.demand().gradient >= 0) {
      require_error(stretch, stretch.gradient_error, "gradient_error");
      for (const CubicBernstein<double>& component : stretch.gradient) {
        if (!is_finite(component)) fail_of(stretch, "a gradient that is not finite");
      }
    }
    if (source_.demand().magnitude >= 0) {
      const auto& [b0, b1, b2, b3] = stretch.magnitude.b;
      const double off_zero = -1e-9 * (std::abs(b1) + std::abs(b2) + std::max(b0, b3));
      if (!is_finite(stretch.magnitude) || !(std::min(b0, b3) >= off_zero)) {
        fail_of(stretch, "a magnitude that is negative or not finite");
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(source_.name() + " " + what + " (the ray from " + text(ray_.origin) + " along " +
                text(ray_.direction) + ")");
  }
  [[noreturn]] void fail_of(const FieldStretch& stretch, const std::string& what) const {
    fail("tells " + what + ", of a stretch" + place(stretch) + "; let it keep to FieldStretch");
  }
  static std::string place(const FieldStretch& stretch) {
    return " from " + text(stretch.begin) + " to " + text(stretch.end);
  }
  void require_error(const FieldStretch& stretch, double error, const char* name) const {
    if (error >= 0 && error < infinity) return;
    fail_of(stretch, std::string(name) + " = " + text(error));
  }

  void check_bounds(const FieldStretch& stretch, double off) const {
    // A thousandth of the box: what reaches farther out is no rounding.
    const Box<double>& bounds = source_.description().bounds;
    const double beside = off + 1e-3 * length(bounds.upper - bounds.lower);
    if (stretch.begin >= box_.begin - beside && stretch.end <= box_.end + beside) return;
    // What is behind the eye is cut.
    if (box_.begin <= 0 && stretch.end <= box_.end + beside) return;
    fail("tells a stretch" + place(stretch) + ", but its bounds are met from " + text(box_.begin) +
         " to " + text(box_.end) + "; let the bounds hold the whole field");
  }

  void check_variable(const FieldStretch& stretch, int c) const {
    const CubicBernstein<double>& data = stretch.data[c];
    const StretchSource::Variable& variable =
        source_.description().variables[static_cast<std::size_t>(c)];
    if (!is_finite(data)) fail_of(stretch, "data of " + variable.name + " that are not finite");
    require_error(stretch, stretch.value_error[c], "value_error");
    const double size = std::max(-variable.minimum, variable.maximum);
    const double beside =
        stretch.value_error[c] + 1e-6 * (variable.maximum - variable.minimum) + 1e-12 * size;
    const double least = std::min(data.b[0], data.b[3]), most = std::max(data.b[0], data.b[3]);
    if (least >= variable.minimum - beside && most <= variable.maximum + beside) return;
    fail("tells the value " + text(least < variable.minimum - beside ? least : most) + " of " +
         variable.name + ", which goes from " + text(variable.minimum) + " to " +
         text(variable.maximum) + "; give a range that holds all values");
  }

  const OwnSource& source_;
  Ray<double> ray_{};
  Interval<double> box_{0, 0};
  double last_ = 0;
  long told_ = 0;
};

/// Stretches of a field of one's own, cut to ranges.
class OwnStream : public LayerStream {
 public:
  OwnStream(const OwnSource& source, std::unique_ptr<StretchStream> stream)
      : source_(source), stream_(std::move(stream)), promises_(source) {}

  Interval<double> start(const Ray<double>& ray) override {
    const Interval<double> own = call_of(source_, [&] { return stream_->start(ray); });
    promises_.start(ray, own);
    const Interval<double> box = promises_.box();
    return {std::max(own.begin, box.begin), std::min(own.end, box.end)};
  }
  void restrict_to_range(Interval<double> range) override {
    range_ = range;
    promises_.restrict_to_range();
    call_of(source_, [&] { stream_->restrict_to_range(range); });
  }

  bool next(LayerStretch& stretch) override {
    for (;;) {
      found_.position_error = found_.gradient_error = 0;
      std::ranges::fill(found_.value_error, 0.0);
      if (!call_of(source_, [&] { return stream_->next(found_); })) return false;
      promises_.check(found_);
      if (found_.begin >= range_.end) return false;
      if (!(found_.begin < found_.end) || found_.end <= range_.begin) continue;
      take(stretch);
      return true;
    }
  }

 private:
  void take(LayerStretch& to) const {
    to.begin = std::max(found_.begin, range_.begin);
    to.end = std::min(found_.end, range_.end);
    to.position_error = found_.position_error;
    to.gradient_error = found_.gradient_error;
    to.function = 0;
    const double length = found_.end - found_.begin;
    const double from = (to.begin - found_.begin) / length, end = (to.end - found_.begin) / length;
    const bool whole = from <= 0 && end >= 1;
    const auto part = [&](const CubicBernstein<double>& f) {
      return whole ? f : restrict_to(f, from, end);
    };
    const MultivariateTransfer<double>& transfer = source_.functions().front();
    for (int c = 0; c < transfer.channels; ++c) {
      to.data[c] = part(found_.data[c]);
      to.value_error[c] = found_.value_error[c];
    }
    to.left_out = source_.extinction_error([&](const MultivariateTransfer<double>& function) {
      return detail::extinction_error(function, to.value_error, to.data);
    });
    if (source_.demand().gradient >= 0) {
      for (int a = 0; a < 3; ++a) to.gradient[a] = part(found_.gradient[a]);
    }
    if (source_.demand().magnitude >= 0) to.magnitude = part(found_.magnitude);
    if (const ChannelTransferFunction* const factor = source_.look().value_factor()) {
      to.magnitude = source_.look().factor_argument(to.data[factor->channel]);
    }
  }

  const OwnSource& source_;
  const std::unique_ptr<StretchStream> stream_;
  Promises promises_;
  FieldStretch found_;
  Interval<double> range_{0, 0};
};

std::unique_ptr<LayerStream> OwnSource::stream(bool /*by_cells*/) const {
  auto own = call_of(*this, [&] { return source_.stream(demand_); });
  if (own == nullptr) throw Error(name() + " returns no stream; let stream() make one");
  return std::make_unique<OwnStream>(*this, std::move(own));
}

}  // namespace

std::unique_ptr<const LayerSource> make_own_source(const LayerTask& task) {
  return std::make_unique<OwnSource>(task);
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pellucid/base/limits.h"
#include "pellucid/geometry/box.h"
#include "pellucid/math/bernstein.h"

namespace pellucid {

/// A stretch of a ray on which all variables of a field are polynomials of degree 3 or less, on
/// [begin, end] by their Bernstein coefficients. as_cubic() raises the degree of linear ones.
struct FieldStretch {
  double begin = 0, end = 0;  ///< world arc length
  /// Largest error of begin and end together, world length: the field may begin, end or become
  /// another polynomial that far away.
  double position_error = 0;
  CubicBernstein<double> data[max_channels];  ///< of each variable
  /// Largest error of the data, beside eight roundings of their largest coefficient.
  double value_error[max_channels]{};
  /// Gradient in the world, data units per world length, of the variable StretchDemand::gradient.
  CubicBernstein<double> gradient[3];
  double gradient_error = 0;  ///< largest length that it is off by, beside 64 roundings
  /// Length of the gradient of the variable StretchDemand::magnitude, or what the field takes for
  /// it; never negative.
  CubicBernstein<double> magnitude;
};

/// The stretches of a field along rays, one ray after the other. Used by one thread.
template <class Stretch>
class BasicStretchStream {
 public:
  BasicStretchStream() = default;
  BasicStretchStream(const BasicStretchStream&) = delete;
  BasicStretchStream& operator=(const BasicStretchStream&) = delete;
  virtual ~BasicStretchStream() = default;

  /// Takes a ray in the world, which begins at arc length 0 and has a direction of length 1.
  /// Returns an interval outside of which the field is absent; an empty one if the ray misses it.
  virtual Interval<double> start(const Ray<double>& ray) = 0;
  /// Restricts the ray to a range inside of that interval, behind all former ones. Stretches that
  /// reach out of it are cut by the caller; one that reaches into two ranges is told in both.
  virtual void restrict_to_range(Interval<double> range) = 0;
  /// Finds the next stretch that overlaps the range, front to back. Between stretches the field is
  /// absent. Returns false behind the last one.
  virtual bool next(Stretch& stretch) = 0;
};

/// The stretches of a field of one's own. next() gets a stretch whose errors are 0; what else it
/// leaves alone stays as it was.
using StretchStream = BasicStretchStream<FieldStretch>;

/// Quantities that stretches must have beside their data.
struct StretchDemand {
  int gradient = -1;   ///< the variable whose gradient is needed, for light; -1: none
  int magnitude = -1;  ///< the variable whose gradient's length is needed, for gradient opacity
};

/// A field of one's own, as a layer shows it (SourceContent): anything whose variables are
/// polynomials of degree 3 or less on stretches of a ray, or are replaced by such with a bound.
///
/// Immutable: another field is another object, by which a Renderer knows that it changed. Any
/// number of threads call stream() at once, and use what it returns one each.
///
/// Rendering holds what the streams tell against what is promised here and in BasicStretchStream.
/// A broken promise is an Error that names the layer, the ray and the promise; so is an exception
/// that a stream throws. A stream that does not return cannot be ended.
class StretchSource {
 public:
  struct Variable {
    std::string name;
    double minimum = 0, maximum = 1;  ///< no value is outside, but for value_error
  };
  struct Description {
    std::string name;                 ///< in messages
    Box<double> bounds;               ///< in the world; outside of it the field is absent
    std::vector<Variable> variables;  ///< 1 … max_channels
    /// World length of the finest detail, in which flatness and gradient opacity count
    /// (voxel_of()).
    double voxel_size = 1;
    bool has_gradient = false, has_magnitude = false;  ///< true if stretches can have them
  };

  virtual ~StretchSource() = default;
  StretchSource(const StretchSource&) = delete;
  StretchSource& operator=(const StretchSource&) = delete;

  const Description& description() const noexcept { return description_; }
  int count() const noexcept { return static_cast<int>(description_.variables.size()); }

  /// Returns a stream of stretches with what is demanded.
  virtual std::unique_ptr<StretchStream> stream(const StretchDemand& demand) const = 0;

 protected:
  /// Throws Error if the bounds are empty or not finite, the variables are none or more than
  /// max_channels, one has no name, a range is empty or beyond ±2.1e37, or the voxel size is not
  /// positive and finite.
  explicit StretchSource(Description description);

 private:
  Description description_;
};

}  // namespace pellucid

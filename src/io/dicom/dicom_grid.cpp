// SPDX-License-Identifier: Apache-2.0
//
// DICOM PS3.3, C.7.6.2.1.1: where a pixel stands. World is LPS, in millimetres.

#include "dicom_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "pellucid/scene/error.h"
#include "text/readable_number.h"

namespace pellucid {

namespace {

// What exact positions are off by is less than this share of the distance of slices, or of pixels.
constexpr double tolerance = 0.01;

class SlicePlacement {
 public:
  SlicePlacement(std::vector<DicomSlice>& slices, const ReadOptions& options,
                 const std::string& name, bool some_left_out)
      : slices_(slices), options_(options), name_(name), some_left_out_(some_left_out) {}

  Volume::Description find() {
    const DicomSlice& any = slices_.front();
    Volume::Description d;
    d.name = name_;
    d.dimensions = {any.image->format.columns, any.image->format.rows,
                    static_cast<int>(slices_.size())};
    find_pixels(d.placement);
    find_rounding();
    const auto without = std::ranges::find_if(slices_, [](const auto& s) { return !s.position; });
    if (without == slices_.end()) {
      sort_by_position(d.placement);
      d.placement.origin = *slices_.front().position;
      if (slices_.size() > 1) {
        find_steps(d);
        return d;
      }
    } else if (std::ranges::any_of(slices_, [](const auto& s) { return s.position.has_value(); })) {
      fail(without->name() +
           " has no position (ImagePositionPatient), but others have; leave it "
           "out");
    } else {
      sort_by_number();
    }
    assume_distance(d.placement);
    return d;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(name_ + ": " + what); }
  void note(const std::string& what) const {
    if (options_.note) options_.note(name_ + ": " + what);
  }

  void find_pixels(GridPlacement& placement) {
    const DicomSlice& any = slices_.front();
    if (!any.orientation) {
      note("no usable orientation (ImageOrientationPatient); taken to be axial");
    }
    const auto [row, column] =
        any.orientation.value_or(std::array{Vec3<double>{1, 0, 0}, Vec3<double>{0, 1, 0}});
    normal_ = normalized(cross(row, column));
    placement.direction.column[0] = row;
    placement.direction.column[1] = column;
    placement.direction.column[2] = normal_;
    if (!any.spacing && !options_.spacing) {
      note("no usable spacing of pixels (PixelSpacing); taken to be 1 mm");
    }
    const auto [x, y] = any.spacing.value_or(std::array{1.0, 1.0});
    placement.spacing.x = x;
    placement.spacing.y = y;
  }

  // Positions of one or some digits behind the point are rounded by up to half of the last one.
  // Whole numbers may as well be exact.
  void find_rounding() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      int decimals = 0;
      for (const DicomSlice& slice : slices_) decimals = std::max(decimals, slice.decimals[axis]);
      if (decimals > 0) rounding_[static_cast<int>(axis)] = 0.5 * std::pow(10, -decimals);
    }
  }
  // How far rounding may move a slice off the line through the first and the last, each rounded.
  double rounded_aside() const { return 2 * length(rounding_); }

  double along(const DicomSlice& slice) const { return dot(*slice.position, normal_); }

  void sort_by_position(const GridPlacement& placement) {
    std::ranges::stable_sort(slices_, {}, [&](const DicomSlice& slice) { return along(slice); });
    // Slices this close are one place that is written twice.
    const double least = 1e-3 * std::min(placement.spacing.x, placement.spacing.y);
    for (std::size_t i = 1; i < slices_.size(); ++i) {
      if (along(slices_[i]) - along(slices_[i - 1]) > least) continue;
      fail(slices_[i - 1].name() + " and " + slices_[i].name() +
           " stand at the same place: the series holds several volumes (times, echoes, "
           "repetitions), or a slice twice; put one volume into a folder of its own");
    }
  }

  void sort_by_number() {
    if (slices_.size() > 1) {
      std::ranges::stable_sort(slices_, {}, [](const DicomSlice& s) { return s.number; });
      for (std::size_t i = 1; i < slices_.size(); ++i) {
        if (slices_[i - 1].number && *slices_[i - 1].number < *slices_[i].number) continue;
        fail(
            "the slices have neither positions (ImagePositionPatient) nor numbers that differ "
            "(InstanceNumber); nothing says how they lie");
      }
    }
    note(
        "no positions (ImagePositionPatient); the slices are in the order of their numbers, "
        "from the origin on");
  }

  void assume_distance(GridPlacement& placement) {
    const DicomSlice& any = slices_.front();
    const auto usable = [](std::optional<double> x) { return x && *x > 0; };
    if (usable(any.distance)) {
      placement.spacing.z = *any.distance;
    } else if (usable(any.thickness)) {
      placement.spacing.z = *any.thickness;
    }
    if (options_.spacing) return;
    note(usable(any.distance)
             ? "the distance of slices is SpacingBetweenSlices, " + in_millimetres(*any.distance)
         : usable(any.thickness)
             ? "the distance of slices is taken to be their thickness, " +
                   in_millimetres(*any.thickness)
             : std::string("the distance of slices is not known; taken to be 1 mm"));
  }

  // From the first slice to the last, and that no slice is beside this line.
  void find_steps(Volume::Description& d) {
    GridPlacement& placement = d.placement;
    const Vec3<double> whole = *slices_.back().position - *slices_.front().position;
    const double height = dot(whole, normal_);
    const double pixel = std::min(placement.spacing.x, placement.spacing.y);
    check_line(whole, height, pixel);
    // Rounded positions must not turn a grid whose slices stand straight.
    if (length(whole - normal_ * height) > std::max(tolerance * pixel, rounded_aside())) {
      placement.direction.column[2] = normalized(whole);
      const double angle = std::acos(std::min(1.0, height / length(whole)));
      note("the slices are sheared by " + std::to_string(angle * 180 / std::numbers::pi) +
           " degrees (a tilted gantry); they stand as they lie");
    }
    const double stretch = dot(placement.direction.column[2], normal_);
    const auto steps = static_cast<double>(slices_.size() - 1);
    placement.spacing.z = height / steps / stretch;
    if (!options_.spacing) find_uneven(d, height / steps, stretch);
  }

  void check_line(const Vec3<double>& whole, double height, double pixel) {
    double largest = 0;
    std::size_t beside = 0;
    const DicomSlice* farthest = nullptr;
    for (const DicomSlice& slice : slices_) {
      const Vec3<double> offset = *slice.position - *slices_.front().position;
      const double aside = length(offset - whole * (dot(offset, normal_) / height));
      if (aside > std::max(tolerance * pixel, rounded_aside())) ++beside;
      if (aside <= largest) continue;
      largest = aside;
      farthest = &slice;
    }
    if (beside > 1) {
      fail(std::to_string(beside) + " of " + std::to_string(slices_.size()) +
           " slices are beside the line from the first to the last, " + farthest->name() + " by " +
           in_millimetres(largest) +
           "; they are no single stack, or their positions are too coarse: put one stack into a "
           "folder of its own");
    }
    if (beside == 1) {
      fail(farthest->name() + " is " + in_millimetres(largest) +
           " beside the line of the slices; leave it out");
    }
    if (largest > tolerance * pixel) {
      note("slices are up to " + in_millimetres(largest) +
           " beside their line, which the rounding of their positions explains");
    }
  }

  void find_uneven(Volume::Description& d, double step, double stretch) {
    std::vector<double> heights;
    heights.reserve(slices_.size());
    for (const DicomSlice& slice : slices_) heights.push_back(along(slice) - along(slices_[0]));
    double largest = 0;  // distance of a slice from its place among even ones
    // More than some of a step is a slice that is missing, however coarse the positions are.
    constexpr double most = 0.4;
    const double rounded =
        2 * (rounding_.x * std::abs(normal_.x) + rounding_.y * std::abs(normal_.y) +
             rounding_.z * std::abs(normal_.z));
    const double allowed = std::max(tolerance * step, std::min(rounded, most * step));
    for (std::size_t i = 0; i < heights.size(); ++i) {
      largest = std::max(largest, std::abs(heights[i] - static_cast<double>(i) * step));
    }
    if (largest <= allowed) {
      if (largest > tolerance * step) {
        note("slices are up to " + in_millimetres(largest) +
             " off even distances, which the rounding of their positions explains; they are taken "
             "as even");
      }
      return;
    }
    std::vector<double> gaps;
    gaps.reserve(heights.size() - 1);
    for (std::size_t i = 1; i < heights.size(); ++i) gaps.push_back(heights[i] - heights[i - 1]);
    std::vector<double> sorted = gaps;
    std::ranges::sort(sorted);
    const double middle = sorted[sorted.size() / 2];
    const auto odd = static_cast<std::size_t>(
        std::ranges::max_element(gaps, {}, [&](double g) { return std::abs(g - middle); }) -
        gaps.begin());
    const std::string where = "the distance of slices is " + in_millimetres(middle) + ", but " +
                              in_millimetres(gaps[odd]) + " from " + slices_[odd].name() + " to " +
                              slices_[odd + 1].name() +
                              (some_left_out_ ? " (a file that is left out may belong there)" : "");
    if (options_.centering == Centering::cell) {
      fail(where + "; uneven slices are read with their values as points only");
    }
    note(where + "; the grid is rectilinear");
    d.placement.spacing.z = middle / stretch;
    for (double& height : heights) height /= stretch;
    d.coordinates[2] = std::move(heights);
  }

  std::vector<DicomSlice>& slices_;
  const ReadOptions& options_;
  const std::string& name_;
  bool some_left_out_;
  Vec3<double> normal_{0, 0, 1};
  Vec3<double> rounding_{0, 0, 0};  ///< largest, of each coordinate of a position, in mm
};

}  // namespace

Volume::Description place_dicom_slices(std::vector<DicomSlice>& slices, const ReadOptions& options,
                                       const std::string& name, bool some_left_out) {
  return SlicePlacement(slices, options, name, some_left_out).find();
}

}  // namespace pellucid

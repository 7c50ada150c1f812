// SPDX-License-Identifier: Apache-2.0
//
// The format: nifti1.h, https://nifti.nimh.nih.gov.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "pellucid/scene/error.h"
#include "volumes/volume_writers.h"

namespace pellucid {

namespace {

struct Header {
  std::array<std::byte, 352> bytes{};  // with the four of the flag that there are no extensions

  template <class Number>
  void put(std::size_t offset, Number number) {
    const auto of_number = std::bit_cast<std::array<std::byte, sizeof(Number)>>(number);
    std::ranges::copy(of_number, bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  }
};

std::int16_t type_of(const VolumeData& data) {
  constexpr std::int16_t codes[] = {2, 256, 512, 4, 768, 8, 16, 64};
  return codes[data.index()];
}

/// Returns the rows of the map from index to world, RAS, as they are before they are rounded.
std::array<std::array<double, 4>, 3> map_of(const GridPlacement& placement) {
  std::array<std::array<double, 4>, 3> rows{};
  for (int row = 0; row < 3; ++row) {
    const double sign = row < 2 ? -1 : 1;  // right and anterior instead of left and posterior
    std::array<double, 4>& to = rows[static_cast<std::size_t>(row)];
    for (int a = 0; a < 3; ++a) {
      // The sum turns -0 into 0.
      to[static_cast<std::size_t>(a)] =
          sign * placement.direction.column[a][row] * placement.spacing[a] + 0.0;
    }
    to[3] = sign * placement.origin[row] + 0.0;
  }
  return rows;
}

/// Returns the largest distance that rounding moves any value of the grid along an axis of the
/// world.
double moved_by(const std::array<std::array<double, 4>, 3>& rows, const std::array<int, 3>& sides) {
  double most = 0;
  for (const std::array<double, 4>& row : rows) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double steps = i < 3 ? sides[i] - 1 : 1;
      sum += steps * std::abs(row[i] - static_cast<double>(static_cast<float>(row[i])));
    }
    most = std::max(most, sum);
  }
  return most;
}

Losses write_nifti(const WrittenVolume& volume, const Sink& sink) {
  const Volume::Description& d = volume.description();
  constexpr int most = std::numeric_limits<std::int16_t>::max();
  if (*std::ranges::max_element(d.dimensions) > most || volume.count() > most) {
    throw Error(volume.path +
                ": not written: NIfTI has at most 32767 values along an axis; write .nrrd");
  }
  const auto rows = map_of(d.placement);
  const bool several = volume.count() > 1;
  Header header;
  header.put(0, std::int32_t{348});
  const std::array<int, 8> dim{
      several ? 5 : 3, d.dimensions[0], d.dimensions[1], d.dimensions[2], 1, volume.count(), 1, 1};
  for (std::size_t i = 0; i < dim.size(); ++i) {
    header.put(40 + 2 * i, static_cast<std::int16_t>(dim[i]));
  }
  constexpr std::int16_t vectors = 1007;
  if (several) header.put(68, vectors);
  const std::size_t bytes =
      std::visit([](const auto& values) { return sizeof(values[0]); }, volume.data());
  header.put(70, type_of(volume.data()));
  header.put(72, static_cast<std::int16_t>(8 * bytes));
  header.put(76, 1.0F);
  for (int i = 0; i < 7; ++i) {
    const double step = i < 3 ? d.placement.spacing[i] : 1;
    header.put(80 + 4 * static_cast<std::size_t>(i), static_cast<float>(step));
  }
  header.put(108, 352.0F);
  constexpr char millimetres = 2;
  header.put(123, millimetres);
  constexpr std::int16_t scanner = 1;
  header.put(254, scanner);
  for (std::size_t i = 0; i < 12; ++i) {
    header.put(280 + 4 * i, static_cast<float>(rows[i / 4][i % 4]));
  }
  header.put(344, std::array{'n', '+', '1', '\0'});
  sink(header.bytes);
  put_one_by_one(volume, sink);

  Losses losses;
  if (const double moved = moved_by(rows, d.dimensions); moved > 0) {
    losses.push_back("NIfTI has places in binary32: values are moved by up to " +
                     exact_text(static_cast<double>(static_cast<float>(moved))));
  }
  if (d.centering == Centering::cell) {
    losses.emplace_back("NIfTI does not say that values fill cells; read it with --centering cell");
  }
  return losses;
}

}  // namespace

extern const VolumeWriter nifti_writer{.extension = ".nii", .write = write_nifti};

extern const VolumeWriter nifti_gzip_writer{
    .extension = ".nii.gz", .write = write_nifti, .compressed = true};

}  // namespace pellucid

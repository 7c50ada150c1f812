// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <string>

#include "volumes/volume_writers.h"

namespace pellucid {

namespace {

Losses write_raw(const WrittenVolume& volume, const Sink& sink) {
  put_interleaved(volume, sink);
  const Volume::Description& d = volume.description();
  const GridPlacement& placement = d.placement;
  std::string read = "raw holds the values alone; read it with --dimensions " +
                     std::to_string(d.dimensions[0]) + "," + std::to_string(d.dimensions[1]) + "," +
                     std::to_string(d.dimensions[2]) + " --type " +
                     std::string(type_name(volume.data()));
  if (volume.count() > 1) read += " --components " + std::to_string(volume.count());
  if (std::endian::native == std::endian::big) read += " --big-endian";
  read += " --spacing " + exact_text(placement.spacing, ",") + " --origin " +
          exact_text(placement.origin, ",");
  if (d.centering == Centering::cell) read += " --centering cell";
  Losses losses{read};
  if (placement.direction != Mat3<double>()) {
    losses.emplace_back("the direction of the axes is lost");
  }
  return losses;
}

}  // namespace

extern const VolumeWriter raw_writer{.extension = ".raw", .write = write_raw};

}  // namespace pellucid

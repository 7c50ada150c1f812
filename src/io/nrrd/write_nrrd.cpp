// SPDX-License-Identifier: Apache-2.0
//
// The format: https://teem.sourceforge.net/nrrd/format.html.

#include <bit>
#include <string>

#include "volumes/volume_writers.h"

namespace pellucid {

namespace {

const char* type_of(const VolumeData& data) {
  constexpr const char* names[] = {"unsigned char", "signed char", "unsigned short", "short",
                                   "unsigned int",  "int",         "float",          "double"};
  return names[data.index()];
}

Losses write_nrrd(const WrittenVolume& volume, const Sink& sink) {
  const Volume::Description& d = volume.description();
  const GridPlacement& placement = d.placement;
  const bool several = volume.count() > 1;
  const std::string center = d.centering == Centering::cell ? "cell" : "node";
  std::string header = "NRRD0005\n";
  const auto line = [&](const std::string& field, const std::string& value) {
    header += field + ": " + value + "\n";
  };
  line("type", type_of(volume.data()));
  line("dimension", several ? "4" : "3");
  line("space", "left-posterior-superior");
  std::string sizes = several ? std::to_string(volume.count()) + " " : "";
  std::string directions = several ? "none " : "";
  for (int a = 0; a < 3; ++a) {
    const std::string separator = a < 2 ? " " : "";
    sizes += std::to_string(d.dimensions[static_cast<std::size_t>(a)]) + separator;
    directions += "(" + exact_text(placement.direction.column[a] * placement.spacing[a], ",") +
                  ")" + separator;
  }
  line("sizes", sizes);
  line("space directions", directions);
  line("centers", (several ? "none " : "") + center + " " + center + " " + center);
  line("kinds", std::string(several ? "list " : "") + "domain domain domain");
  line("endian", std::endian::native == std::endian::little ? "little" : "big");
  line("encoding", "raw");
  line("space origin", "(" + exact_text(placement.origin, ",") + ")");
  // Values at a multiple of their size can be used where they lie in the file.
  constexpr std::size_t alignment = 8;
  header += "#";
  while ((header.size() + 2) % alignment != 0) header += " ";
  put_text(header + "\n\n", sink);
  put_interleaved(volume, sink);
  return {};
}

}  // namespace

extern const VolumeWriter nrrd_writer{.extension = ".nrrd", .write = write_nrrd};

}  // namespace pellucid

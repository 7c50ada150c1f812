// SPDX-License-Identifier: Apache-2.0
#include "import_arguments.h"

#include <fmt/format.h>

#include "parse.h"

namespace pellucid::cli {

void ImportArguments::add_range_to(CommandLine& command) {
  command.add_option("--range", range, "Move the first and the last point to these data values")
      ->option_text("A,B");
}

void ImportArguments::add_to(CommandLine& command) {
  given = {command
               .add_option("--map", map,
                           "Use this color map of another program's file. Default: the first")
               ->option_text("NAME"),
           command
               .add_option("--unit-distance", unit_distance,
                           "Thickness, in world units, of the layer that has the opacities of "
                           "another program's transfer function. Default: the file's, else 1")
               ->option_text("LENGTH"),
           command
               .add_option("--colors", colors,
                           "Read the colors of another program's transfer function as srgb or "
                           "linear. Default: as the format defines")
               ->option_text("KIND")
               ->one_of({"srgb", "linear"})};
}

ImportOptions ImportArguments::options(double deviation) const {
  ImportOptions options;
  options.deviation = deviation;
  options.name = map;
  if (!range.empty()) options.range = parse_range("--range", range);
  options.unit_distance = unit_distance;
  if (unit_distance &&
      !(*unit_distance >= smallest_unit_distance && *unit_distance <= largest_unit_distance)) {
    throw UsageError(fmt::format("--unit-distance {}: expected a length from {} to {}",
                                 *unit_distance, smallest_unit_distance, largest_unit_distance));
  }
  if (!colors.empty()) {
    options.encoding = colors == "linear" ? ColorEncoding::linear : ColorEncoding::srgb;
  }
  return options;
}

void ImportArguments::refuse(const std::string& what) const {
  for (const Option* option : given) {
    if (option->count() == 0) continue;
    throw UsageError(fmt::format("{} does not apply to {}; drop it", option->get_name(), what));
  }
}

std::vector<std::string> import_lines(const ImportedTransferFunction& imported,
                                      const std::string& file) {
  std::vector<std::string> lines{
      fmt::format("{}: {}{}", file, imported.format,
                  imported.name.empty() ? "" : fmt::format(" \"{}\"", one_line(imported.name)))};
  for (const std::string& note : imported.notes) lines.push_back(fmt::format("  {}", note));
  return lines;
}

}  // namespace pellucid::cli

// SPDX-License-Identifier: Apache-2.0

// The readers of other programs' transfer functions: any bytes give an opacity table that can be
// made and written, or an Error of one line. Opens no file.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "pellucid/io/export_transfer_function.h"
#include "pellucid/io/import_transfer_function.h"
#include "pellucid/io/scene_json.h"
#include "pellucid/scene/error.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  pellucid::needs_import(text);
  pellucid::ImportOptions options;
  options.deviation = 0.05;
  try {
    const pellucid::ImportedTransferFunction imported =
        pellucid::import_transfer_function(text, "fuzz", options);
    const pellucid::OpacityTable& table = imported.table;
    require(!table.points.empty());
    require(table.color_deviation >= 0 && table.color_deviation <= options.deviation * 1.001);
    require(table.extinction_deviation >= 0 &&
            table.extinction_deviation <= options.deviation * 1.001);
    for (const std::string& note : imported.notes) require(note.find('\n') == std::string::npos);
    // What is read can be written, and is read again as it was.
    const std::string written = pellucid::transfer_function_to_json(table);
    const auto again = pellucid::parse_transfer_function(written, "again");
    require(pellucid::transfer_function_to_json(again) == written);
    pellucid::transfer_function_from_opacity_table(table.points, table.unit_distance,
                                                   pellucid::largest_relative_error);
    const pellucid::LookDescription look{table, imported.shading, imported.gradient_opacity};
    const std::string with_light = pellucid::look_to_json(look);
    require(pellucid::look_to_json(pellucid::parse_look(with_light, "again")) == with_light);
    pellucid::export_transfer_function(look, {pellucid::ExportFormat::table, 0.05});
  } catch (const pellucid::Error& error) {
    const std::string_view message = error.what();
    require(message.size() > 10 && message.size() < 2000);
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20);
  }
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include "saved_files.h"

#include <filesystem>
#include <limits>

#include "page_messages.h"
#include "pellucid/io/export_transfer_function.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/import_transfer_function.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/internal/temporary_folder.h"
#include "pellucid/scene/error.h"

namespace pellucid::view {

namespace {

namespace fs = std::filesystem;

template <class Write>
std::string bytes_of(const std::string& name, const Write& write) {
  const TemporaryFolder folder("a file to save");
  const fs::path path = folder.path() / name;
  write(path);
  return read_bytes(path, std::numeric_limits<std::size_t>::max());
}

}  // namespace

PageMessage file_message(const SavedFile& file) {
  const Json header{{"type", "file"}, {"name", file.name}, {"content_type", file.content_type}};
  return binary_message(header, {file.bytes});
}

std::vector<ColorBar> wanted_color_bars(const SceneDescription& description, const Scene& scene) {
  check_draws_color_bars();
  std::vector<ColorBar> bars = color_bars(description, scene);
  if (!bars.empty()) return bars;
  throw Error(no_color_bars);
}

SavedFile png_file(const Image& image, const std::optional<Background>& background) {
  return {"picture.png", "image/png", encode_png(image, background)};
}

SavedFile exr_file(const Image& image) {
  return {"picture.exr", "image/x-exr",
          bytes_of("picture.exr", [&](const fs::path& path) { write_exr(image, path); })};
}

SavedFile function_file(const LayerDescription& layer, const std::string& format,
                        std::vector<std::string>& notes) {
  if (!layer.transfer_function) throw Error("the layer has no transfer function to export");
  const LookDescription look{*layer.transfer_function, layer.shading, layer.gradient_opacity};
  const std::string json = "application/json";
  if (format == "pellucid") {
    return {"transfer_function.json", json, look_to_json(look) + "\n"};
  }
  const ExportOptions options{*export_format_from_name(format)};
  ExportedTransferFunction exported = export_transfer_function(look, options);
  notes = std::move(exported.notes);
  switch (options.format) {
    case ExportFormat::slicer:
      return {"transfer_function.vp.json", json, exported.text};
    case ExportFormat::paraview:
      return {"color_map.json", json, exported.text};
    case ExportFormat::table:
      return {"color_table.csv", "text/csv", exported.text};
  }
  return {};
}

LookDescription read_function(const ImportFunction& import, std::vector<std::string>& notes) {
  if (!needs_import(import.text)) return parse_look(import.text, import.name);
  const ImportedTransferFunction imported = import_transfer_function(import.text, import.name);
  notes = imported.notes;
  return {imported.table, imported.shading, imported.gradient_opacity};
}

}  // namespace pellucid::view

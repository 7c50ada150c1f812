// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/import_transfer_function.h"

#include <nlohmann/json.hpp>
#include <string>

#include "import_readers.h"
#include "import_text.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "scene/scene_json_parts.h"

namespace pellucid {
namespace {

using scene_json::Node;

constexpr std::size_t largest_file = std::size_t{64} << 20;

enum class Kind { own, paraview, slicer, vtk_js, anari, slicer_text, table, xml };

/// Returns the kind of a document by the keys at its top.
Kind kind_of(const Node& document) {
  if (document.is_array()) {
    const bool gaussians = document.array_size() > 0 && document.element(0).has("position");
    return gaussians ? Kind::vtk_js : Kind::paraview;
  }
  for (const char* key : {"transfer_function", "points", "tables", "preset", "pellucid"}) {
    if (document.has(key)) return Kind::own;
  }
  if (const auto gaussians = document.find("gaussians")) {
    const bool is_vtk_js = gaussians->is_array() && gaussians->array_size() > 0 &&
                           gaussians->element(0).has("position");
    return is_vtk_js ? Kind::vtk_js : Kind::own;
  }
  if (document.has("volumeProperties")) return Kind::slicer;
  for (const char* key : {"RGBPoints", "Points", "ColorSpace", "IndexedColors"}) {
    if (document.has(key)) return Kind::paraview;
  }
  for (const char* key : {"color", "opacity", "valueRange", "unitDistance"}) {
    if (document.has(key)) return Kind::anari;
  }
  return Kind::own;
}

std::string_view from_first_letter(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const std::size_t at = text.find_first_not_of(" \t\r\n");
  return at == std::string_view::npos ? std::string_view() : text.substr(at);
}

/// Returns the kind of a text that is not JSON.
Kind kind_of(std::string_view text) {
  if (text.starts_with('<')) return Kind::xml;
  // The first line of a volume property is one number; no row of colors is.
  const std::string_view line = text.substr(0, text.find('\n'));
  const std::vector<std::string_view> list = imported::words(line, " \t\r,;");
  const bool number =
      list.size() == 1 && list[0].find_first_not_of("0123456789") == std::string_view::npos;
  return number ? Kind::slicer_text : Kind::table;
}

bool is_json(std::string_view text) {
  return text.starts_with('{') || text.starts_with('[');
}

void check(const ImportOptions& options) {
  if (!(options.deviation >= smallest_deviation && options.deviation <= largest_deviation)) {
    throw Error("import: the deviation must be from 1e-7 to 0.1");
  }
  if (options.range) {
    const auto [a, b] = *options.range;
    if (!(a < b && std::abs(a) <= scene_json::largest_value &&
          std::abs(b) <= scene_json::largest_value)) {
      throw Error("import: the range must be two ascending numbers up to 2.1e37");
    }
  }
  if (options.unit_distance && !(*options.unit_distance >= smallest_unit_distance &&
                                 *options.unit_distance <= largest_unit_distance)) {
    throw Error("import: the unit distance must be from 1e-20 to 1e30");
  }
}

imported::Function read_json(const Node& document, const std::string& wanted) {
  switch (kind_of(document)) {
    case Kind::paraview:
      return imported::read_paraview(document, wanted);
    case Kind::slicer:
      return imported::read_slicer(document);
    case Kind::vtk_js:
      return imported::read_vtk_js(document);
    case Kind::anari:
      return imported::read_anari(document);
    default:
      document.fail("is no transfer function of ParaView, 3D Slicer, vtk.js or ANARI");
  }
}

}  // namespace

bool needs_import(std::string_view text) {
  const std::string_view begin = from_first_letter(text);
  if (!is_json(begin)) return !begin.empty();
  try {
    const nlohmann::json parsed = scene_json::parse_document(begin, "");
    return kind_of(Node(parsed, "")) != Kind::own;
  } catch (const Error&) {
    // What is wrong with it is said by whoever reads it.
    return false;
  }
}

ImportedTransferFunction import_transfer_function(std::string_view text, const std::string& name,
                                                  const ImportOptions& options) {
  check(options);
  const std::string_view begin = from_first_letter(text);
  if (begin.empty()) throw Error(name + ": is empty; give a transfer function");
  if (is_json(begin)) {
    const nlohmann::json parsed = scene_json::parse_document(begin, name);
    return imported::fit(read_json(Node(parsed, name), options.name), options);
  }
  switch (kind_of(begin)) {
    case Kind::xml:
      return imported::fit(imported::read_xml(begin, name, options.name), options);
    case Kind::slicer_text:
      return imported::fit(imported::read_slicer_text(begin, name), options);
    default:
      return imported::fit(imported::read_color_table(begin, name), options);
  }
}

ImportedTransferFunction import_transfer_function(const std::filesystem::path& file,
                                                  const ImportOptions& options) {
  return import_transfer_function(read_text_file(file, largest_file), file.string(), options);
}

}  // namespace pellucid

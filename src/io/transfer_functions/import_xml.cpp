// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "import_readers.h"
#include "import_text.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"
#include "text/xml_scanner.h"

namespace pellucid::imported {
namespace {

using Scanner = XmlScanner;
using Tag = XmlTag;

double attribute(const Tag& tag, std::string_view key, const std::string& where) {
  const auto found = tag.attributes.find(key);
  if (found == tag.attributes.end()) {
    throw Error(where + ": <" + printable(tag.name) + "> has no " + std::string(key));
  }
  return number_of(found->second, where);
}

double checked(double x, double lower, double upper, const std::string& where) {
  if (x >= lower && x <= upper) return x;
  throw Error(where + ": " + text_of(x) + " must be from " + text_of(lower) + " to " +
              text_of(upper));
}

ColorSpace space_of(std::string_view word, const std::string& where) {
  if (word.empty() || word == "RGB") return ColorSpace::rgb;
  if (word == "HSV") return ColorSpace::hsv_without_wrap;  // vtkSMTransferFunctionProxy
  if (word == "Wrapped") return ColorSpace::hsv;
  if (word == "Lab" || word == "CIELAB") return ColorSpace::lab;
  if (word == "Diverging") return ColorSpace::diverging;
  if (word == "Step") return ColorSpace::step;
  throw Error(where + ": the space \"" + printable(word) +
              "\" is not read; save the map as RGB, HSV, Lab, Diverging or Step");
}

void note_once(Function& function, const std::string& note) {
  if (std::ranges::find(function.notes, note) == function.notes.end()) {
    function.notes.push_back(note);
  }
}

/// Reads <ColorMap name="" space=""><Point x="" o="" r="" g="" b=""/>…</ColorMap>; ParaView ignores
/// o.
Function read_color_maps(Scanner& scanner, Tag tag, const std::string& name,
                         const std::string& wanted) {
  Function function;
  function.format = "ParaView color map";
  bool inside = false, found = false;
  std::size_t count = 0;
  for (std::optional<Tag> next = tag; next; next = scanner.next()) {
    const std::string where = scanner.where(*next);
    if (next->name == "ColorMap") {
      if (!next->closes) ++count;
      const std::string map(next->attributes["name"]);
      inside = !next->closes && !next->closed && !found && (wanted.empty() || map == wanted);
      if (!inside) continue;
      found = true;
      function.name = map;
      if (const auto word = next->attributes["indexedLookup"]; word == "true" || word == "1") {
        throw Error(where +
                    ": has colors of categories (indexedLookup), not of values; take "
                    "another map");
      }
      function.space = space_of(next->attributes["space"], where);
    } else if (inside && next->name == "Point" && !next->closes) {
      const double x = attribute(*next, "x", where);
      const auto part = [&](const char* key) {
        return checked(attribute(*next, key, where), 0, 1, where);
      };
      function.colors.push_back({x, {part("r"), part("g"), part("b")}});
      if (next->attributes.contains("o")) {
        note_once(function, "the attribute o of the points is left out, as ParaView leaves it");
      }
    }
  }
  if (!found) {
    throw Error(name + ": has no color map" +
                (wanted.empty() ? "" : " \"" + printable(wanted) + "\""));
  }
  if (count > 1 && wanted.empty()) {
    function.notes.push_back("the first of " + std::to_string(count) + " maps is taken, \"" +
                             printable(function.name) + "\"");
  }
  complete(function, name);
  return function;
}

/// The fields of one control point by their names.
using Fields = std::map<std::string_view, std::string_view>;

double field(const Fields& fields, std::string_view key, const std::string& where) {
  const auto found = fields.find(key);
  const auto list =
      found == fields.end() ? std::vector<std::string_view>() : words(found->second, " \t\r\n");
  if (list.size() != 1) throw Error(where + ": a control point has no " + std::string(key));
  return number_of(list.front(), where);
}

GaussianNode visit_gaussian(const Fields& fields, const std::string& where) {
  GaussianNode g;
  g.x = field(fields, "x", where);
  g.height = checked(field(fields, "height", where), 0, 1, where);
  g.width = checked(field(fields, "width", where), 0, 1e30, where);
  if (g.width == 0) g.width = 0.00001;  // as VisIt
  g.x_bias = checked(field(fields, "xBias", where), -g.width, g.width, where);
  g.y_bias = checked(field(fields, "yBias", where), 0, 2, where);
  return g;
}

ColorNode visit_color(const Fields& fields, const std::string& where) {
  const auto found = fields.find("colors");
  const auto list =
      found == fields.end() ? std::vector<std::string_view>() : words(found->second, " \t\r\n");
  if (list.size() < 3) throw Error(where + ": a color control point has no colors");
  const auto part = [&](std::size_t i) {
    return checked(number_of(list[i], where), 0, 255, where) / 255;
  };
  return {field(fields, "position", where), {part(0), part(1), part(2)}};
}

/// Reads VisIt's attributes besides the control points: by enumerators' names or their numbers, as
/// versions of VisIt write either.
void visit_setting(Function& function, std::string_view key, std::string_view text,
                   const std::string& where) {
  const auto list = words(text, " \t\r\n");
  const std::string_view value = list.empty() ? std::string_view() : list.front();
  const auto is = [&](std::string_view name, std::string_view number) {
    return value.find(name) != std::string_view::npos || value == number;
  };
  const auto note = [&](const std::string& what) { note_once(function, what + " left out"); };
  if (key == "opacityMode" && value.find("Gaussian") == std::string_view::npos) {
    throw Error(where + ": the opacity mode is not Gaussian; only that one is read");
  }
  if (key == "scaling" && (is("Log", "1") || is("Skew", "2"))) {
    throw Error(where + ": the scaling is \"" + printable(value) +
                "\", not Linear; only that one is read");
  }
  if (key == "opacityAttenuation") note("VisIt's attenuation of opacities is");
  if (key == "smoothing" && !is("None", "0") && !is("Linear", "1")) {
    note("the smoothing of colors, \"" + printable(value) + "\", is");
  }
  for (const std::string_view limit : {"useColorVarMin", "useColorVarMax"}) {
    if (key != limit || !is("true", "1")) continue;
    note("a limit of the range, " + std::string(limit.substr(3)) +
         ", which gives the values of the control points (--range says it), is");
  }
}

/// Reads <Object name="GaussianControlPoint"><Field name="x" type="float">0.3</Field>…</Object>.
Function read_visit(Scanner& scanner, Tag tag, const std::string& name) {
  Function function;
  function.format = "VisIt volume attributes";
  std::string_view object;
  Fields fields;
  for (std::optional<Tag> next = tag; next; next = scanner.next()) {
    const std::string where = scanner.where(*next);
    if (next->name == "Field" && !next->closes) {
      visit_setting(function, next->attributes["name"], next->text, where);
      fields[next->attributes["name"]] = next->text;
    } else if (next->name == "Object" && !next->closes) {
      object = next->attributes["name"];
      fields.clear();
    } else if (next->name == "Object") {
      if (object == "GaussianControlPoint") {
        function.gaussians.push_back(visit_gaussian(fields, where));
      }
      if (object == "ColorControlPoint") function.colors.push_back(visit_color(fields, where));
      if (function.gaussians.size() > max_gaussians || function.colors.size() > max_nodes) {
        throw Error(where + ": too many control points");
      }
      object = {};
    }
  }
  complete(function, name);
  return function;
}

}  // namespace

Function read_xml(std::string_view text, const std::string& name, const std::string& wanted) {
  Scanner scanner(text, name);
  for (std::optional<Tag> tag = scanner.next(); tag; tag = scanner.next()) {
    if (tag->name == "ColorMap") return read_color_maps(scanner, *tag, name, wanted);
    if (tag->name == "Object") return read_visit(scanner, *tag, name);
  }
  throw Error(name + ": is XML, but neither ParaView's color maps nor VisIt's attributes");
}

}  // namespace pellucid::imported

// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/error.h"
#include "scene_fields.h"

namespace pellucid {
namespace {

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

/// Returns the shortest decimal that reads back to the same double (at most 17 digits).
std::string number(double value, std::string_view what) {
  if (!std::isfinite(value)) {
    throw Error(joined({"scene: ", what, " is not a finite number; JSON cannot hold it"}));
  }
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  std::string number(text, end);
  // Readers take "-0" for an integer, which has no sign of zero.
  return number == "-0" ? "-0.0" : number;
}

std::string quoted(const std::string& text, std::string_view what) {
  try {
    return nlohmann::json(text).dump();
  } catch (const nlohmann::json::exception&) {
    throw Error(joined({"scene: ", what, " is not UTF-8; JSON cannot hold it"}));
  }
}

std::string path_text(const std::filesystem::path& path, std::string_view what) {
  const std::u8string text = path.u8string();
  return quoted(std::string(text.begin(), text.end()), what);
}

std::string array(const Vec3<double>& v, std::string_view what) {
  return joined({"[", number(v.x, what), ", ", number(v.y, what), ", ", number(v.z, what), "]"});
}

std::string array(const Rgb<double>& c, std::string_view what) {
  return array(Vec3<double>{c.r, c.g, c.b}, what);
}

std::string background_text(const Background& background) {
  const std::string_view what = "the background";
  if (background.is_even()) return array(background.top, what);
  return joined({"{\"top\": ", array(background.top, what),
                 ", \"bottom\": ", array(background.bottom, what), "}"});
}

/// Returns an array of what `text` makes of each element, one per line behind an indent.
template <class List, class Text>
std::string lines_of(const List& list, const std::string& indent, const Text& text) {
  std::string lines;
  for (const auto& element : list) {
    lines += joined({lines.empty() ? "[" : ",", "\n", indent, "    ", text(element)});
  }
  return joined({lines, "\n", indent, "  ]"});
}
/// Returns the same on one line.
template <class List, class Text>
std::string list_of(const List& list, const Text& text) {
  std::string line;
  for (const auto& element : list) line += joined({line.empty() ? "[" : ", ", text(element)});
  return line + "]";
}

/// The members of an object, one per line, or without an indent all on one.
class Members {
 public:
  Members() = default;
  explicit Members(std::string_view indent)
      : indent_(indent),
        first_(joined({"{\n", indent_, "  "})),
        next_(joined({",\n", indent_, "  "})),
        end_(joined({"\n", indent_, "}"})) {}

  void add(std::string_view key, std::string_view value) {
    text_ += joined({text_.empty() ? first_ : next_, "\"", key, "\": ", value});
  }
  std::string object() const { return text_ + end_; }
  const std::string& indent() const noexcept { return indent_; }

 private:
  std::string indent_, first_ = "{", next_ = ", ", end_ = "}", text_;
};

/// Writes one point of a transfer function per line. `strength` is "extinction" or "opacity".
template <class Point>
std::string points_text(const std::vector<Point>& points, double Point::*strength,
                        std::string_view name, const std::string& indent) {
  return lines_of(points, indent, [&](const Point& p) {
    return joined({"{\"value\": ", number(p.value, "a value"), ", \"", name, "\": ",
                   number(p.*strength, name), ", \"color\": ", array(p.color, "a color"), "}"});
  });
}

std::string transfer_function_text(const std::vector<TransferFunction::Point>& points,
                                   const std::string& indent) {
  Members members(indent);
  members.add("type", "\"piecewise_linear\"");
  members.add("points",
              points_text(points, &TransferFunction::Point::extinction, "extinction", indent));
  return members.object();
}

std::string transfer_function_text(const OpacityTable& table, const std::string& indent) {
  Members members(indent);
  members.add("type", "\"piecewise_linear\"");
  members.add("unit_distance", number(table.unit_distance, "the unit distance"));
  if (table.extinction_deviation != 0 || table.color_deviation != 0) {
    members.add("deviation",
                joined({"{\"extinction\": ", number(table.extinction_deviation, "a deviation"),
                        ", \"color\": ", number(table.color_deviation, "a deviation"), "}"}));
  }
  members.add("points", points_text(table.points, &OpacityPoint::opacity, "opacity", indent));
  return members.object();
}

std::string transfer_function_text(const PresetDescription& preset, const std::string& indent) {
  Members members(indent);
  members.add("preset", quoted(preset.name, "the name of a preset"));
  if (preset.range) {
    members.add("range", joined({"[", number((*preset.range)[0], "the range"), ", ",
                                 number((*preset.range)[1], "the range"), "]"}));
  }
  return members.object();
}

std::string list(const std::vector<double>& numbers, std::string_view what) {
  return list_of(numbers, [&](double x) { return number(x, what); });
}

std::string list(const std::vector<std::vector<double>>& rows, std::string_view what) {
  return list_of(rows, [&](const auto& row) { return list(row, what); });
}

std::string name_text(const ChannelRef& channel) {
  return quoted(channel.name(), "the name of a channel");
}

std::string names_text(const std::vector<ChannelRef>& names) {
  return list_of(names, name_text);
}

void add_channel(std::string_view key, const ChannelRef& channel, Members& members) {
  if (!channel.name().empty()) members.add(key, name_text(channel));
}

std::string shape_text(const GaussianPrimitive& g) {
  if (!g.shape) return joined({"\"matrix\": ", list(g.matrix, "a matrix")});
  if (const auto* widths = std::get_if<GaussianWidths>(&*g.shape)) {
    std::string text = joined({"\"width\": ", list(widths->widths, "a width")});
    if (!widths->axes.empty()) text += joined({", \"axes\": ", list(widths->axes, "an axis")});
    return text;
  }
  return joined({"\"covariance\": ",
                 list(std::get<GaussianCovariance>(*g.shape).covariance, "a covariance")});
}

std::string gaussian_text(const GaussianPrimitive& g) {
  return joined({"{",
                 g.channels.empty() ? "" : joined({"\"channels\": ", names_text(g.channels), ", "}),
                 "\"center\": ", list(g.center, "a center"), ", ", shape_text(g),
                 ", \"extinction\": ", number(g.extinction, "an extinction"),
                 ", \"color\": ", array(g.color, "a color"), "}"});
}

std::string table_text(const ChannelTransferFunction& table, const std::string& indent) {
  Members members(indent);
  add_channel("channel", table.channel, members);
  members.add("points", points_text(table.function.points(), &TransferFunction::Point::extinction,
                                    "extinction", indent));
  return members.object();
}

/// Writes one point per line.
std::string factor_text(const ChannelTransferFunction& factor, const std::string& indent) {
  Members members(indent);
  add_channel("channel", factor.channel, members);
  const auto text = [](const TransferFunction::Point& point) {
    return joined({"{\"value\": ", number(point.value, "a value"),
                   ", \"factor\": ", number(point.extinction, "a factor"), "}"});
  };
  members.add("points", lines_of(factor.function.points(), indent, text));
  return members.object();
}

/// Writes one Gaussian per line.
std::string transfer_function_text(const MultivariateDescription& function,
                                   const std::string& indent) {
  Members members(indent);
  if (!function.channels.empty())
    members.add("channels", names_text({function.channels.begin(), function.channels.end()}));
  if (!function.gaussians.empty()) {
    members.add("gaussians", lines_of(function.gaussians, indent, gaussian_text));
  }
  if (!function.tables.empty()) {
    members.add("tables", list_of(function.tables, [&](const ChannelTransferFunction& table) {
                  return table_text(table, indent + "  ");
                }));
  }
  if (function.factor) members.add("factor", factor_text(*function.factor, indent + "  "));
  return members.object();
}

std::string transfer_function_text(const TransferFunctionDescription& description,
                                   const std::string& indent) {
  return std::visit([&](const auto& kind) { return transfer_function_text(kind, indent); },
                    description);
}

/// Adds the fields of a part (scene_fields.h) to the members of an object.
class FieldWriter {
 public:
  explicit FieldWriter(Members& members) : members_(&members) {}

  template <class Member, class Kind>
  void operator()(const scene_fields::Key& key, const Member& member, const Kind& kind) const {
    if (!key.applies) return;
    if constexpr (std::is_same_v<Kind, scene_fields::Channel>) {
      add_channel(key.name, member, *members_);
    } else if constexpr (std::is_same_v<Kind, scene_fields::Choice>) {
      const char* const name = kind.names[static_cast<std::size_t>(member)];
      members_->add(key.name, joined({"\"", name, "\""}));
    } else if constexpr (std::is_same_v<Kind, scene_fields::Colors>) {
      const std::string indent = members_->indent() + "  ";
      if (member.written_colors) {
        members_->add(key.name, transfer_function_text(*member.written_colors, indent));
      } else if (member.colors) {
        members_->add(key.name, transfer_function_text(member.colors->points(), indent));
      }
    } else if constexpr (std::is_same_v<Member, std::optional<double>>) {
      if (member) members_->add(key.name, number(*member, kind.noun));
    } else if constexpr (std::is_same_v<Member, double>) {
      members_->add(key.name, number(member, kind.noun));
    } else {
      members_->add(key.name, array(member, kind.noun));
    }
  }

 private:
  Members* members_;
};

/// Returns an object with the fields of a part, added to members that are there.
template <class Part>
std::string fields_text(const Part& part, Members members) {
  scene_fields::visit_fields(part, FieldWriter(members));
  return members.object();
}
/// Returns the same with a line for each.
template <class Part>
std::string lines_text(const Part& part, const std::string& indent) {
  return fields_text(part, Members(indent));
}

void add_time(const std::optional<double>& time, TimeBetween between, Members& members) {
  if (time) members.add("time", number(*time, "the time"));
  if (between == TimeBetween::linear) members.add("time_between", "\"linear\"");
}

void add_field(const FieldSource& field, Members& members) {
  if (!field.builtin.empty()) {
    members.add("builtin", quoted(field.builtin, "a name"));
    members.add("points", std::to_string(field.points));
    return;
  }
  members.add("file", path_text(field.file, "the path of the field"));
  const ReadOptions& options = field.options;
  if (options.dimensions) {
    const auto& d = *options.dimensions;
    members.add("dimensions", joined({"[", std::to_string(d[0]), ", ", std::to_string(d[1]), ", ",
                                      std::to_string(d[2]), "]"}));
  }
  if (options.type) members.add("type", quoted(*options.type, "a type"));
  if (options.components) members.add("components", std::to_string(*options.components));
  if (options.array) members.add("array", quoted(*options.array, "the name of an array"));
  if (options.axes) members.add("axes", quoted(*options.axes, "the axes"));
  add_time(options.time, options.time_between, members);
  if (options.component) {
    members.add("component", std::to_string(*options.component));
  } else if (options.component_name) {
    members.add("component", quoted(*options.component_name, "the name of a component"));
  }
  if (options.level) members.add("level", std::to_string(*options.level));
  if (options.series) members.add("series", quoted(*options.series, "a series"));
  if (options.big_endian) members.add("byte_order", *options.big_endian ? "\"big\"" : "\"little\"");
  if (options.skip_bytes != 0) members.add("skip_bytes", std::to_string(options.skip_bytes));
  if (options.spacing) members.add("spacing", array(*options.spacing, "the spacing"));
  if (options.origin) members.add("origin", array(*options.origin, "the origin"));
  if (options.centering) {
    members.add("centering", *options.centering == Centering::point ? "\"point\"" : "\"cell\"");
  }
}

std::string field_text(const FieldSource& field, const std::string& indent) {
  Members members(indent);
  add_field(field, members);
  return members.object();
}

std::string channel_text(const ChannelSource& channel, const std::string& indent) {
  Members members(indent);
  members.add("name", quoted(channel.name, "the name of a channel"));
  if (!channel.unit.empty()) members.add("unit", quoted(channel.unit, "the unit of a channel"));
  if (const auto* field = std::get_if<FieldSource>(&channel.source)) {
    add_field(*field, members);
    return members.object();
  }
  const auto& derived = std::get<DerivedSource>(channel.source);
  members.add(derived_name(derived.kind), quoted(derived.channel, "the name of a channel"));
  if (derived.kind == DerivedSource::Kind::smoothed) {
    members.add("sigma", number(derived.sigma, "sigma"));
  }
  return members.object();
}

std::string array_choice_text(const MeshArrayChoice& choice) {
  std::string text = joined({"{\"name\": ", quoted(choice.name, "the name of a channel"),
                             ", \"array\": ", quoted(choice.array, "the name of an array")});
  if (choice.component) text += joined({", \"component\": ", std::to_string(*choice.component)});
  return text + "}";
}

/// Writes one channel per line.
std::string mesh_text(const MeshSource& mesh, const std::string& indent) {
  Members members(indent);
  members.add("file", path_text(mesh.file, "the path of the mesh"));
  add_time(mesh.options.time, mesh.options.time_between, members);
  if (!mesh.options.q.empty()) members.add("q", path_text(mesh.options.q, "the path of q"));
  if (!mesh.channels.empty()) {
    members.add("channels", lines_of(mesh.channels, indent, array_choice_text));
  }
  return members.object();
}

/// Writes one label per line.
std::string labels_text(const LabelSource& labels, const std::string& indent) {
  Members members(indent);
  add_field(labels.field, members);
  if (!labels.table.empty()) members.add("table", path_text(labels.table, "the path of a table"));
  if (labels.extinction) members.add("extinction", number(*labels.extinction, "an extinction"));
  if (!labels.styles.empty()) {
    members.add("colors", lines_of(labels.styles, indent, [](const LabelStyle& style) {
                  return joined(
                      {"{\"label\": ", std::to_string(style.label),
                       style.name.empty() ? std::string()
                                          : joined({", \"name\": ", quoted(style.name, "a name")}),
                       ", \"color\": ", array(style.color, "a color"),
                       ", \"extinction\": ", number(style.extinction, "an extinction"), "}"});
                }));
  }
  return members.object();
}

std::string mask_text(const MaskSource& mask, const std::string& indent) {
  Members members(indent);
  add_field(mask.field, members);
  members.add("functions", list_of(mask.choices, [&](const MaskSource::Choice& choice) {
                Members one(indent + "  ");
                one.add("label", std::to_string(choice.label));
                one.add("transfer_function",
                        transfer_function_text(choice.transfer_function, indent + "    "));
                return one.object();
              }));
  return members.object();
}

std::string clip_text(const Clip& clip) {
  Members members;
  const auto fields = [](const auto& shape) { return fields_text(shape, Members()); };
  members.add(scene_fields::clip_shapes[clip.shape.index()], std::visit(fields, clip.shape));
  if (!clip.keep_inside) members.add("keep", "\"outside\"");
  return members.object();
}

std::string transform_text(const Affine<double>& map) {
  std::string rows;
  for (int r = 0; r < 3; ++r) {
    rows += rows.empty() ? "[[" : "], [";
    for (int c = 0; c < 3; ++c) {
      rows += joined({number(map.matrix.column[c][r], "the transform"), ", "});
    }
    rows += number(map.translation[r], "the transform");
  }
  return rows + "]]";
}

std::string light_text(const Light& light) {
  Members members;
  members.add("type", joined({"\"", scene_fields::light_kinds[light.kind.index()], "\""}));
  const FieldWriter write(members);
  std::visit([&](const auto& kind) { scene_fields::visit_fields(kind, write); }, light.kind);
  scene_fields::visit_fields(light, write);
  return members.object();
}

std::string lights_text(const std::vector<Light>& lights) {
  return lights.empty() ? "[]" : lines_of(lights, "", light_text);
}

/// Writes one point per line.
std::string gradient_opacity_text(const GradientOpacity& opacity, const std::string& indent) {
  Members members(indent);
  members.add("points", lines_of(opacity.points(), indent, [](const GradientOpacity::Point& point) {
                return joined({"{\"gradient\": ", number(point.gradient, "a gradient"),
                               ", \"factor\": ", number(point.factor, "a factor"), "}"});
              }));
  members.add("unit", opacity.unit() == GradientOpacity::Unit::voxel ? "\"voxel\"" : "\"world\"");
  add_channel("channel", opacity.channel(), members);
  return members.object();
}

/// Adds the look of a layer. `indent` is that of the keys.
void add_look(LayerDescription layer, const std::string& indent, Members& members) {
  name_channels(layer);
  if (layer.shading) members.add("shading", lines_text(*layer.shading, indent));
  if (layer.gradient_opacity) {
    members.add("gradient_opacity", gradient_opacity_text(*layer.gradient_opacity, indent));
  }
  const auto add_list = [&](const char* key, const auto& elements) {
    if (elements.empty()) return;
    members.add(key, list_of(elements, [&](const auto& each) { return lines_text(each, indent); }));
  };
  add_list("isosurfaces", layer.isosurfaces);
  add_list("slices", layer.slices);
}

/// Returns lines of which all but the first are two columns further right.
std::string indented(const std::string& text) {
  std::string made;
  for (const char c : text) {
    made += c;
    if (c == '\n') made += "  ";
  }
  return made;
}

/// Returns whether it is a white head light alone, the default.
bool are_default(const std::vector<Light>& lights) {
  return lights.size() == 1 && std::holds_alternative<HeadLight>(lights.front().kind) &&
         lights.front().color == Rgb<double>{1, 1, 1};
}

std::string layer_text(const LayerDescription& layer) {
  Members members("    ");
  const std::string indent = "      ";
  if (!layer.name.empty()) members.add("name", quoted(layer.name, "the name of a layer"));
  if (!layer.visible) members.add("visible", "false");
  if (layer.labels) {
    members.add("labels", labels_text(*layer.labels, indent));
  } else if (layer.mesh) {
    members.add("mesh", mesh_text(*layer.mesh, indent));
  } else if (layer.channels.empty()) {
    members.add("field", field_text(layer.field, indent));
  } else {
    members.add("channels", list_of(layer.channels, [&](const ChannelSource& channel) {
                  return channel_text(channel, indent);
                }));
  }
  if (layer.transfer_function) {
    members.add("transfer_function", transfer_function_text(*layer.transfer_function, indent));
  }
  if (layer.mask) members.add("mask", mask_text(*layer.mask, indent));
  if (!is_in_place(layer)) members.add("transform", transform_text(layer.transform));
  if (!layer.clips.empty()) members.add("clip", lines_of(layer.clips, "    ", clip_text));
  if (layer.projection) {
    members.add("projection", joined({"\"", projection_name(*layer.projection), "\""}));
  }
  add_look(layer, indent, members);
  return members.object();
}

}  // namespace

bool has_source(const FieldSource& field) {
  return !field.builtin.empty() || (!field.file.empty() && field.file != array_in_memory);
}

void check_has_sources(const SceneDescription& description) {
  for (std::size_t i = 0; i < description.layers.size(); ++i) {
    const LayerDescription& layer = description.layers[i];
    const auto is_readable = [&](const ChannelSource& channel) {
      const auto* const field = std::get_if<FieldSource>(&channel.source);
      return field == nullptr || has_source(*field);
    };
    const bool has_data = layer.labels ? has_source(layer.labels->field)
                          : layer.mesh ? layer.mesh->file != array_in_memory
                          : layer.channels.empty()
                              ? has_source(layer.field)
                              : std::ranges::all_of(layer.channels, is_readable);
    if (has_data && (!layer.mask || has_source(layer.mask->field))) continue;
    throw Error("layer " + std::to_string(i + 1) +
                ": its data are arrays, which a scene file cannot hold; write them to a file "
                "(Volume.write) and use what read() returns");
  }
}

std::string scene_to_json(const SceneDescription& scene) {
  std::string layers;
  for (const LayerDescription& layer : scene.layers) {
    layers += joined({layers.empty() ? "[\n    " : ", ", layer_text(layer)});
  }
  Members image("  ");
  image.add("width", std::to_string(scene.size.width));
  image.add("height", std::to_string(scene.size.height));
  image.add("samples", std::to_string(scene.samples));
  if (scene.is_transparent) {
    image.add("background", "null");
  } else if (scene.background) {
    image.add("background", background_text(*scene.background));
  }
  if (!scene.backdrop.empty()) {
    image.add("backdrop", path_text(scene.backdrop, "the path of the backdrop"));
  }
  Members document("");
  document.add("pellucid", "2");
  document.add("layers", joined({layers, "\n  ]"}));
  if (!scene.clips.empty()) document.add("clip", lines_of(scene.clips, "", clip_text));
  if (!are_default(scene.lights)) document.add("lights", lights_text(scene.lights));
  if (scene.camera) document.add("camera", lines_text(*scene.camera, "  "));
  document.add("image", image.object());
  document.add("integration", lines_text(scene.integration, "  "));
  if (scene.time) document.add("time", number(*scene.time, "the time"));
  if (scene.animation) document.add("animation", indented(animation_to_json(*scene.animation)));
  return document.object() + "\n";
}

std::string transfer_function_to_json(const TransferFunctionDescription& description) {
  return transfer_function_text(description, "");
}

std::string transfer_function_to_json(const TransferFunction& transfer_function) {
  return transfer_function_text(transfer_function.points(), "");
}

std::string layer_look_to_json(const LayerDescription& layer) {
  Members members("");
  add_look(layer, "  ", members);
  const std::string text = members.object();
  return text == "\n}" ? "{}" : text;
}

std::string lights_to_json(const std::vector<Light>& lights) {
  return lights_text(lights);
}

std::string look_to_json(const LookDescription& look) {
  if (!look.shading && !look.gradient_opacity) {
    return transfer_function_to_json(look.transfer_function);
  }
  const std::string indent = "  ";
  Members members("");
  members.add("transfer_function", transfer_function_text(look.transfer_function, indent));
  if (look.shading) members.add("shading", lines_text(*look.shading, indent));
  if (look.gradient_opacity) {
    members.add("gradient_opacity", gradient_opacity_text(*look.gradient_opacity, indent));
  }
  return members.object();
}

std::string camera_to_json(const Camera& camera) {
  return lines_text(camera, "");
}

}  // namespace pellucid

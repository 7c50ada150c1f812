// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/internal/scene_facts.h"

#include <array>
#include <charconv>
#include <type_traits>
#include <utility>

#include "pellucid/io/internal/checksum.h"
#include "scene_fields.h"

namespace pellucid {
namespace {

std::string text_of(double number) {
  std::array<char, 32> room;
  return {room.data(), std::to_chars(room.data(), room.data() + room.size(), number).ptr};
}

std::string text_of(const Vec3<double>& v) {
  return "(" + text_of(v.x) + ", " + text_of(v.y) + ", " + text_of(v.z) + ")";
}

std::string text_of(const Rgb<double>& color) {
  return text_of(Vec3<double>{color.r, color.g, color.b});
}

std::string text_of(const std::optional<double>& number) {
  return number ? text_of(*number) : "none";
}

void add(Checksum& sum, const Rgb<double>& color) {
  for (const double part : {color.r, color.g, color.b}) sum.add(part);
}

void add(Checksum& sum, const TransferFunction& function) {
  for (const TransferFunction::Point& point : function.points()) {
    const auto& [value, extinction, color] = point;
    sum.add(value);
    sum.add(extinction);
    add(sum, color);
  }
  sum.add(function.relative_error());
  sum.add(function.color_error());
}

void add(Checksum& sum, const ChannelTransferFunction& of_channel) {
  const auto& [channel, function] = of_channel;
  sum.add(channel.index());
  add(sum, function);
}

/// Adds a primitive. Its shape is that of a file, from which the matrix was made.
void add(Checksum& sum, const GaussianPrimitive& primitive) {
  const auto& [channels, center, matrix, extinction, color, shape] = primitive;
  for (const ChannelRef& channel : channels) sum.add(channel.index());
  for (const double number : center) sum.add(number);
  for (const auto& row : matrix) {
    for (const double number : row) sum.add(number);
  }
  sum.add(extinction);
  add(sum, color);
}

void add(Checksum& sum, const MultivariateTransferFunction& function) {
  for (const GaussianPrimitive& primitive : function.primitives()) add(sum, primitive);
  for (const ChannelTransferFunction& table : function.tables()) add(sum, table);
  sum.add(function.factor() != nullptr ? 1 : 0);
  if (function.factor() != nullptr) add(sum, *function.factor());
}

template <class Function>
std::string checksum_of(const std::shared_ptr<const Function>& function) {
  if (!function) return "none";
  Checksum sum;
  add(sum, *function);
  return std::to_string(sum.value());
}

/// Adds the fields of a part (scene_fields.h) to a text, those too that files leave out.
class FieldText {
 public:
  explicit FieldText(std::string& text) : text_(&text) {}

  template <class Member, class Kind>
  void operator()(const scene_fields::Key& key, const Member& member, const Kind& kind) const {
    *text_ += (text_->empty() ? "" : ", ") + std::string(key.name) + " ";
    if constexpr (std::is_same_v<Kind, scene_fields::Choice>) {
      *text_ += kind.names[static_cast<std::size_t>(member)];
    } else if constexpr (std::is_same_v<Kind, scene_fields::Channel>) {
      *text_ += std::to_string(member.index());
    } else if constexpr (std::is_same_v<Kind, scene_fields::Colors>) {
      *text_ += checksum_of(member.colors);
    } else {
      *text_ += text_of(member);
    }
  }

 private:
  std::string* text_;
};

template <class Part>
std::string fields_of(const Part& part) {
  std::string text;
  scene_fields::visit_fields(part, FieldText(text));
  return text;
}

/// Returns the text of each part of a list, in order.
template <class Part, class Text>
std::string list_of(const std::vector<Part>& parts, const Text& text_of_part) {
  std::string text = std::to_string(parts.size());
  for (const Part& part : parts) text += "; " + text_of_part(part);
  return text;
}

std::string text_of_clip(const Clip& clip) {
  const auto& [shape, keep_inside] = clip;
  return std::string(scene_fields::clip_sides[keep_inside ? 0 : 1]) + " of " +
         scene_fields::clip_shapes[shape.index()] + " " +
         std::visit([](const auto& one) { return fields_of(one); }, shape);
}

std::string text_of_light(const Light& light) {
  return std::string(scene_fields::light_kinds[light.kind.index()]) + " " + fields_of(light) + " " +
         std::visit([](const auto& one) { return fields_of(one); }, light.kind);
}

std::string text_of(const GradientOpacity& opacity) {
  return std::string(opacity.unit() == GradientOpacity::Unit::world ? "world" : "voxel") +
         ", channel " + std::to_string(opacity.channel().index()) + ", " +
         list_of(opacity.points(), [](const GradientOpacity::Point& point) {
           const auto& [gradient, factor] = point;
           return text_of(gradient) + " " + text_of(factor);
         });
}

std::string text_of(const Affine<double>& transform) {
  std::string text;
  for (const Vec3<double>& column : transform.matrix.column) text += text_of(column) + " ";
  return text + text_of(transform.translation);
}

std::string functions_of(const VolumeContent& content) {
  std::string text = checksum_of(content.transfer_function);
  if (!content.mask) return text;
  for (const LabelMask::Choice& choice : content.mask->choices()) {
    const auto& [label, function] = choice;
    text += "; " + std::to_string(label) + " " + checksum_of(function);
  }
  return text;
}
std::string functions_of(const ChannelsContent& content) {
  return checksum_of(content.transfer_function);
}
std::string functions_of(const LabelContent& content) {
  if (!content.table) return "none";
  Checksum sum;
  add(sum, content.table->function());
  return std::to_string(sum.value());
}
template <class Content>  // a mesh, or a field of one's own
std::string functions_of(const Content& content) {
  return std::visit([](const auto& function) { return checksum_of(function); },
                    content.transfer_function);
}

/// Adds the parts of a layer beside its data and its name.
void add_layer(const Layer& layer, const std::string& of_layer, std::vector<SceneFact>& facts) {
  const auto& [content, name, visible, transform, clips, projection, shading, gradient_opacity,
               isosurfaces, slices] = layer;
  const auto fact = [&](const char* what, std::string text) {
    facts.push_back({"the " + std::string(what) + of_layer, std::move(text)});
  };
  fact("visibility", visible ? "on" : "off");
  fact("transform", text_of(transform));
  fact("clips", list_of(clips, text_of_clip));
  fact("projection", projection ? std::to_string(static_cast<int>(*projection)) : "none");
  fact("shading", shading ? fields_of(*shading) : "none");
  fact("gradient opacity", gradient_opacity ? text_of(*gradient_opacity) : "none");
  fact("isosurfaces", list_of(isosurfaces, fields_of<Isosurface>));
  fact("slices", list_of(slices, fields_of<Slice>));
  fact("kind", std::to_string(content.index()));
  fact("checksum of the functions",
       std::visit([](const auto& one) { return functions_of(one); }, content));
}

std::string checksum_of(const Image& image) {
  Checksum sum;
  for (const auto& pixel : image.pixels) {
    for (const float part : pixel) sum.add(static_cast<double>(part));
  }
  for (const float depth : image.depth) sum.add(static_cast<double>(depth));
  return std::to_string(sum.value());
}

}  // namespace

std::vector<SceneFact> scene_facts(const Scene& scene) {
  const auto& [clips, lights, size, samples, integration, background] =
      static_cast<const SceneSettings&>(scene);
  std::vector<SceneFact> facts{
      {"the number of layers", std::to_string(scene.layers.size())},
      {"the size of the picture", std::to_string(size.width) + "x" + std::to_string(size.height) +
                                      ", " + std::to_string(samples) + " samples"},
      {"the integration", fields_of(integration)},
      {"the camera", fields_of(scene.camera)},
      {"the list of clips", list_of(clips, text_of_clip)},
      {"the list of lights", list_of(lights, text_of_light)},
      {"the background",
       background ? text_of(background->top) + " " + text_of(background->bottom) : "none"},
      {"the checksum of the backdrop", scene.backdrop ? checksum_of(*scene.backdrop) : "none"}};
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    add_layer(scene.layers[i], " of layer " + std::to_string(i + 1), facts);
  }
  return facts;
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "pellucid/scene/scene.h"
#include "text/json_document.h"

/// The fields of a scene's parts, one table per type. visit_fields(part, field) calls
///
///   field(key, part.member, kind)
///
/// for each of them. The reader and the writer of JSON (read_fields.h, scene_json_write.cpp) and
/// those of Python's objects (python/src/fields.h) are such functions: a new key is a member with
/// its line here, and an attribute of the class in python/pellucid/scene.py.
namespace pellucid::scene_fields {

/// Name of a field, in JSON and in Python.
struct Key {
  Key(const char* text) : name(text) {}  // NOLINT: a text is a key
  /// Names a key. `missing` says in messages what to give; not null: JSON must have the key.
  Key(const char* text, const char* missing, bool in_json = true)
      : name(text), hint(missing), applies(in_json) {}

  const char* name;
  const char* hint = nullptr;
  bool applies = true;  ///< false: JSON does not have the key beside the fields before it
};

/// Kind of a number: JSON must have one from `least` to `most`. `noun` names it in messages.
struct Number {
  enum class Ends { closed, above_least, open };
  const char* noun;
  double least = -scene_json::largest_number, most = scene_json::largest_number;
  Ends ends = Ends::closed;

  bool has(double value) const {
    return ends == Ends::open          ? value > least && value < most
           : ends == Ends::above_least ? value > 0 && value <= most
                                       : value >= least && value <= most;
  }
  /// Returns the range as messages have it: "from 0 to 1".
  std::string range() const {
    const std::string lower = scene_json::number_text(least), upper = scene_json::number_text(most);
    return ends == Ends::open          ? "above " + lower + " and below " + upper
           : ends == Ends::above_least ? "above 0 and at most " + upper
                                       : "from " + lower + " to " + upper;
  }
};
/// Kind of a point, or of a direction: of any length but 0.
struct Vector {
  const char* noun;
  bool is_direction = false;
};
/// Kind of a linear color, from 0 to `most`.
struct Color {
  const char* noun;
  double most = 1e6;
};
/// Kind of an enumeration whose values have these names, in their order.
struct Choice {
  std::span<const char* const> names;
  std::span<const char* const> python_names{};  ///< empty: the same
  const char* expected = nullptr;               ///< what Python's messages say for a list of names

  std::span<const char* const> in_python() const {
    return python_names.empty() ? names : python_names;
  }
};
/// Kind of a number in the place of the one before it, in (0, most]; Python has none.
struct InPlace {
  const char* other;  ///< the key of the one before it
  const char* noun;
  double most;
};
/// Kind of a ChannelRef.
struct Channel {};
/// Kind of a surface's colors; the member is the surface.
struct Colors {};

inline constexpr const char* camera_projections[] = {"perspective", "orthographic"};
inline constexpr const char* grades[] = {"estimated", "proved"};
inline constexpr const char* precisions[] = {"automatic", "float", "double"};
inline constexpr const char* python_precisions[] = {"automatic", "float32", "float64"};
/// Kinds of lights and shapes of clips, in the order of the alternatives in Light and Clip.
inline constexpr const char* light_kinds[] = {"head", "directional", "point"};
inline constexpr const char* clip_shapes[] = {"plane", "box", "sphere", "cylinder"};
/// Sides of a clip that are kept.
inline constexpr const char* clip_sides[] = {"inside", "outside"};

/// Returns the alternative of this index with its default value.
template <class Variant>
Variant alternative(std::size_t index) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    Variant made;
    ((i == index ? static_cast<void>(made.template emplace<i>()) : void()), ...);
    return made;
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>());
}

template <class S, class T>
concept Part = std::same_as<std::remove_const_t<S>, T>;

template <Part<Shading> S, class Visit>
void visit_fields(S& s, const Visit& field) {
  constexpr double largest = 1e3;
  field("ambient", s.ambient, Number{"a part of the shading", 0, largest});
  field("diffuse", s.diffuse, Number{"a part of the shading", 0, largest});
  field("specular", s.specular, Number{"a part of the shading", 0, largest});
  field("power", s.power, Number{"the power of the shading", 1, largest});
  field("gradient", s.gradient, Choice{gradient_kind_names});
  field("flatness", s.flatness, Number{"the flatness of the shading", 0, largest});
  field("flat_gradient", s.flat_gradient, Number{"the flat gradient of the shading", 0, 1e38});
  field("channel", s.channel, Channel{});
}

template <Part<Isosurface> S, class Visit>
void visit_fields(S& s, const Visit& field) {
  const auto colored = [&] { return s.colors || s.written_colors; };
  field(
      {"value", "give the data value of the surface"}, s.value,
      Number{"the value of an isosurface", -scene_json::largest_value, scene_json::largest_value});
  field({"color", nullptr, !colored()}, s.color, Color{"the color of an isosurface"});
  field("opacity", s.opacity, Number{"the opacity of an isosurface", 0, 1});
  field("channel", s.channel, Channel{});
  field("colors", s, Colors{});
  field({"color_channel", nullptr, colored()}, s.color_channel, Channel{});
}

template <Part<Slice> S, class Visit>
void visit_fields(S& s, const Visit& field) {
  field({"point", "give a point [x, y, z] of the plane"}, s.point, Vector{"the point of a slice"});
  field({"normal", "give a direction [x, y, z] across the plane"}, s.normal,
        Vector{"the normal of a slice", true});
  field("opacity", s.opacity, Number{"the opacity of a slice", 0, 1});
  field("colors", s, Colors{});
  field("channel", s.channel, Channel{});
}

template <Part<HeadLight> S, class Visit>
void visit_fields(S&, const Visit&) {}

template <Part<DirectionalLight> S, class Visit>
void visit_fields(S& light, const Visit& field) {
  field({"direction", "give [x, y, z], the way in which the light shines"}, light.direction,
        Vector{"a direction", true});
}

template <Part<PointLight> S, class Visit>
void visit_fields(S& light, const Visit& field) {
  field({"position", "give a point [x, y, z] of the world"}, light.position, Vector{"a position"});
}

/// Visits the fields that lights of all kinds have.
template <Part<Light> S, class Visit>
void visit_fields(S& light, const Visit& field) {
  field("color", light.color, Color{"the color of a light"});
}

template <Part<ClipPlane> S, class Visit>
void visit_fields(S& plane, const Visit& field) {
  field({"point", "give a point [x, y, z] of the plane"}, plane.point, Vector{"a point"});
  field({"normal", "give the direction of the kept side"}, plane.normal, Vector{"a normal"});
}

template <Part<ClipBox> S, class Visit>
void visit_fields(S& box, const Visit& field) {
  field({"lower", "give the least corner [x, y, z]"}, box.lower, Vector{"a corner"});
  field({"upper", "give the largest corner [x, y, z]"}, box.upper, Vector{"a corner"});
}

/// Kind of the radius of a clip.
inline constexpr Number clip_radius{"a radius", 0, scene_json::largest_number,
                                    Number::Ends::above_least};

template <Part<ClipSphere> S, class Visit>
void visit_fields(S& sphere, const Visit& field) {
  field({"center", "give a point [x, y, z]"}, sphere.center, Vector{"a center"});
  field({"radius", "give a length in the world"}, sphere.radius, clip_radius);
}

template <Part<ClipCylinder> S, class Visit>
void visit_fields(S& cylinder, const Visit& field) {
  field({"start", "give the middle [x, y, z] of one end"}, cylinder.start, Vector{"an end"});
  field({"end", "give the middle [x, y, z] of the other end"}, cylinder.end, Vector{"an end"});
  field({"radius", "give a length in the world"}, cylinder.radius, clip_radius);
}

template <Part<Camera> S, class Visit>
void visit_fields(S& camera, const Visit& field) {
  field("projection", camera.projection, Choice{camera_projections});
  const bool perspective = camera.projection == Projection::perspective;
  field({"position", "give the camera's place [x, y, z]"}, camera.position,
        Vector{"the camera's position"});
  field({"focal_point", "give a point [x, y, z] to look at"}, camera.focal_point,
        Vector{"the camera's focal point"});
  field("up", camera.up, Vector{"the camera's up"});
  field({"vertical_angle", nullptr, perspective}, camera.vertical_angle,
        Number{"the vertical angle", 0, 180, Number::Ends::open});
  field({"parallel_scale", "give half of the image's height in world units", !perspective},
        camera.parallel_scale,
        Number{"the parallel scale", 0, scene_json::largest_number, Number::Ends::above_least});
}

template <Part<Integration> S, class Visit>
void visit_fields(S& s, const Visit& field) {
  field("method", s.method, Choice{method_names, {}, "\"exact\" or a sampling method"});
  field({"tolerance", nullptr, !s.relative_tolerance}, s.tolerance,
        Number{"the tolerance", smallest_tolerance, largest_tolerance});
  field("relative_tolerance", s.relative_tolerance, InPlace{"tolerance", "the tolerance", 1});
  field("grade", s.grade, Choice{grades});
  field("precision", s.precision, Choice{precisions, python_precisions});
  field("step", s.step, Number{"the step", 0, largest_step, Number::Ends::above_least});
}

}  // namespace pellucid::scene_fields

// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/io/animation.h"
#include "scene_json_parts.h"

namespace pellucid {
namespace {

using scene_json::Node;
using OrderedJson = nlohmann::ordered_json;

constexpr double longest = 86400;  // seconds of a film
constexpr double fastest = 1000;   // frames per second

/// Reads seconds of the film.
double moment(const Node& node) {
  return node.number(0, longest);
}

AnimationTrack read_track(const Node& node) {
  node.expect_object({"target", "easing", "keys"});
  AnimationTrack track;
  track.target =
      node.at("target", "give a JSON pointer, as \"/layers/0/isosurfaces/0/value\"").string();
  if (const auto easing = node.find("easing")) {
    track.easing =
        static_cast<Easing>(easing->one_of({std::begin(easing_names), std::end(easing_names)}));
  }
  const Node keys = node.at("keys", "give one or more {\"at\": seconds, \"value\": ...}");
  if (keys.array_size() == 0) keys.fail("is empty; give one or more {\"at\", \"value\"}");
  track.keys = scene_json::list_of(keys, [&](const Node& key) {
    key.expect_object({"at", "value"});
    return AnimationTrack::Key{moment(key.at("at", "give the seconds from the film's start")),
                               key.at("value", "give what the target is then").value().dump()};
  });
  for (std::size_t i = 1; i < track.keys.size(); ++i) {
    if (track.keys[i].at > track.keys[i - 1].at) continue;
    keys.element(i).fail_at("at", "is not later than that of the key before it");
  }
  return track;
}

CameraKey read_camera(const Node& node) {
  node.expect_object({"at", "camera"});
  CameraKey key;
  if (const auto at = node.find("at")) key.at = moment(*at);
  key.camera = scene_json::camera(node.at("camera", "give a camera, as the scene has one"));
  return key;
}

Turntable read_turntable(const Node& node) {
  node.expect_object({"turns", "axis"});
  Turntable turntable;
  if (const auto turns = node.find("turns")) turntable.turns = turns->number(-1e4, 1e4);
  if (const auto axis = node.find("axis")) turntable.axis = scene_json::direction(*axis);
  return turntable;
}

void check_finite(double number) {
  if (!std::isfinite(number)) {
    throw Error("scene: the animation has a number that is not finite; JSON cannot hold it");
  }
}

OrderedJson json_of(double number) {
  check_finite(number);
  return number;
}

OrderedJson json_of(const AnimationTrack& track) {
  OrderedJson keys = OrderedJson::array();
  for (const AnimationTrack::Key& key : track.keys) {
    keys.push_back({{"at", json_of(key.at)}, {"value", OrderedJson::parse(key.value)}});
  }
  return {{"target", track.target},
          {"easing", easing_names[static_cast<int>(track.easing)]},
          {"keys", std::move(keys)}};
}

}  // namespace

Animation scene_json::animation(const Node& node) {
  node.expect_object({"seconds", "fps", "turntable", "cameras", "closed", "time", "tracks"});
  Animation animation;
  if (const auto seconds = node.find("seconds")) {
    animation.seconds = seconds->positive_number(longest);
  }
  if (const auto fps = node.find("fps")) animation.fps = fps->positive_number(fastest);
  if (animation.seconds * animation.fps > most_frames) {
    node.fail("has more than " + std::to_string(most_frames) + " frames");
  }
  if (const auto turntable = node.find("turntable")) {
    animation.turntable = read_turntable(*turntable);
  }
  if (const auto cameras = node.find("cameras")) {
    if (animation.turntable) cameras->fail("stands beside \"turntable\"; give one of the two");
    animation.cameras = list_of(*cameras, read_camera);
  }
  if (const auto closed = node.find("closed")) animation.is_closed = closed->boolean();
  if (!animation.cameras.empty()) {
    checked(*node.find("cameras"),
            [&] { return CameraPath(animation.cameras, animation.seconds, animation.is_closed); });
  }
  if (const auto time = node.find("time")) {
    if (time->is_string()) {
      time->one_of({"steps"});
      animation.by_steps = true;
    } else {
      if (time->array_size() != 2) {
        time->fail("must have two times, of the first and the last frame, or be \"steps\"");
      }
      animation.time = {time->element(0).number(), time->element(1).number()};
    }
  }
  if (const auto tracks = node.find("tracks")) animation.tracks = list_of(*tracks, read_track);
  return animation;
}

Animation parse_animation(std::string_view json, const std::string& name) {
  const nlohmann::json parsed = scene_json::parse_document(json, name);
  return scene_json::animation(Node(parsed, name));
}

std::string animation_to_json(const Animation& animation) {
  OrderedJson json;
  json["seconds"] = json_of(animation.seconds);
  json["fps"] = json_of(animation.fps);
  if (const auto& turntable = animation.turntable) {
    json["turntable"]["turns"] = json_of(turntable->turns);
    if (const auto& axis = turntable->axis) {
      json["turntable"]["axis"] = {json_of(axis->x), json_of(axis->y), json_of(axis->z)};
    }
  }
  for (const CameraKey& key : animation.cameras) {
    OrderedJson camera;
    if (key.at) camera["at"] = json_of(*key.at);
    camera["camera"] = OrderedJson::parse(camera_to_json(key.camera));
    json["cameras"].push_back(std::move(camera));
  }
  if (animation.is_closed) json["closed"] = true;
  if (const auto& time = animation.time) json["time"] = {json_of((*time)[0]), json_of((*time)[1])};
  if (animation.by_steps) json["time"] = "steps";
  for (const AnimationTrack& track : animation.tracks) json["tracks"].push_back(json_of(track));
  return json.dump(2);
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/film.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "pellucid/io/remake_scene.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"

namespace pellucid {
namespace {

using nlohmann::json;

/// Returns the parts of a JSON pointer (RFC 6901), with ~1 for / and ~0 for ~.
std::vector<std::string> tokens_of(const std::string& pointer) {
  if (pointer.empty() || pointer.front() != '/') {
    throw Error("is no JSON pointer: it must begin with /, as in \"/camera/vertical_angle\"");
  }
  constexpr std::size_t deepest = 32;
  std::vector<std::string> tokens;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      if (tokens.size() == deepest) throw Error("has more than 32 levels");
      tokens.emplace_back();
    } else if (pointer[i] != '~') {
      tokens.back() += pointer[i];
    } else {
      const char next = i + 1 < pointer.size() ? pointer[++i] : ' ';
      if (next != '0' && next != '1') throw Error("has a ~ that neither 0 nor 1 follows");
      tokens.back() += next == '0' ? '~' : '/';
    }
  }
  return tokens;
}

/// Returns the element of an array; null: the array has none there.
json* element(json& array, const std::string& token) {
  const bool is_index = !token.empty() && token.size() < 8 &&
                        (token.front() != '0' || token.size() == 1) &&
                        std::ranges::all_of(token, [](char c) { return c >= '0' && c <= '9'; });
  if (!is_index) return nullptr;
  const std::size_t index = std::stoul(token);
  return index < array.size() ? &array[index] : nullptr;
}

/// Returns what a pointer points to; objects and their keys are added where they are missing.
json& place_of(json& document, const std::vector<std::string>& tokens) {
  json* at = &document;
  std::string passed;
  for (const std::string& token : tokens) {
    const auto fail = [&](const std::string& what) {
      throw Error((passed.empty() ? "the scene" : passed) + " " + what + " \"" + token + "\"");
    };
    if (at->is_array()) {
      const std::size_t size = at->size();
      at = element(*at, token);
      if (at == nullptr) {
        fail("has " + std::to_string(size) + " elements, counted from 0, and none is");
      }
    } else if (at->is_object() || at->is_null()) {
      at = &(*at)[token];
    } else {
      fail("is a single value, and has no");
    }
    passed += "/" + token;
  }
  return *at;
}

/// Interpolates numbers, and those in arrays of one length and in objects of the same keys. All
/// else stays until it is the other.
json mixed(const json& a, const json& b, double share) {
  if (a.is_number() && b.is_number()) {
    const double from = a.get<double>(), to = b.get<double>();
    return share == 0 ? a : json(from + share * (to - from));
  }
  json made = a;
  if (a.is_array() && b.is_array() && a.size() == b.size()) {
    for (std::size_t i = 0; i < a.size(); ++i) made[i] = mixed(a[i], b[i], share);
  } else if (a.is_object() && b.is_object()) {
    for (auto& [key, value] : made.items()) {
      if (const auto other = b.find(key); other != b.end()) value = mixed(value, *other, share);
    }
  }
  return made;
}

/// Puts a value at its place. A key of the scene or of a layer that is null then is absent.
void put_value(json& document, const std::vector<std::string>& tokens, json value) {
  const bool is_absent =
      value.is_null() && (tokens.size() == 1 || (tokens.size() == 3 && tokens[0] == "layers"));
  place_of(document, tokens) = std::move(value);
  if (is_absent) place_of(document, {tokens.begin(), tokens.end() - 1}).erase(tokens.back());
}

/// A track as it is evaluated.
struct MovingPart {
  std::vector<std::string> tokens;
  Easing easing;
  std::vector<double> moments;
  std::vector<json> values;

  json at(double seconds) const {
    const auto next = std::ranges::upper_bound(moments, seconds);
    if (next == moments.begin()) return values.front();
    if (next == moments.end()) return values.back();
    const auto i = static_cast<std::size_t>(next - moments.begin());
    if (easing == Easing::hold) return values[i - 1];
    const double u = (seconds - moments[i - 1]) / (moments[i] - moments[i - 1]);
    return mixed(values[i - 1], values[i], easing == Easing::smooth ? u * u * (3 - 2 * u) : u);
  }
};

/// Returns the first tokens, which name what a track changes a part of: one key of a layer or of
/// the scene. Throws Error where it is the same in all frames.
std::vector<std::string> part_of(const std::vector<std::string>& tokens) {
  const std::string& first = tokens.front();
  const std::string second = tokens.size() > 1 ? tokens[1] : "";
  if (first == "animation" || first == "pellucid" || first == "volumes") {
    throw Error("is the same in all frames");
  }
  if (first == "image" && (second.empty() || second == "width" || second == "height")) {
    throw Error("is the size of the film, the same in all frames");
  }
  if (first == "layers" && tokens.size() < 3) {
    throw Error("is whole layers; name a key of one, as \"/layers/0/visible\"");
  }
  const std::size_t length = first == "layers" ? 3 : 1;
  return {tokens.begin(), tokens.begin() + static_cast<std::ptrdiff_t>(length)};
}

void add_keys(const AnimationTrack& track, MovingPart& part) {
  for (const AnimationTrack::Key& key : track.keys) {
    part.moments.push_back(key.at);
    part.values.push_back(json::parse(key.value));
  }
}

/// Returns the track of the data's time. Throws Error.
MovingPart time_part(const AnimationTrack& track, MovingPart part, const Animation& animation) {
  if (animation.time || animation.by_steps) {
    throw Error("stands beside \"time\" of the animation; give one of the two");
  }
  add_keys(track, part);
  for (const json& value : part.values) {
    if (!value.is_number()) throw Error("has a key whose value is no number, which times are");
  }
  return part;
}

}  // namespace

/// The scene as JSON, and what moves in it.
struct Film::Document {
  json base;
  std::vector<MovingPart> parts;
  std::optional<MovingPart> time;  ///< times of the data; none: no track has them

  /// Returns the values of all parts at a moment.
  std::vector<json> values_at(double seconds) const {
    std::vector<json> values;
    for (const MovingPart& part : parts) values.push_back(part.at(seconds));
    return values;
  }
  SceneDescription scene_of(std::vector<json> values, const std::string& name) const {
    json scene = base;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      put_value(scene, parts[i].tokens, std::move(values[i]));
    }
    return parse_scene(scene.dump(), name);
  }
  SceneDescription scene_at(double seconds, const std::string& name) const {
    return scene_of(values_at(seconds), name);
  }
};

namespace {

std::string name_of(int frame) {
  return "animation, frame " + std::to_string(frame + 1);
}

}  // namespace

Film::Film(const SceneDescription& written, const SceneDescription& complete,
           const Animation& animation, SceneTimes times)
    : animation_(animation),
      times_(std::move(times)),
      frames_(frame_count(animation)),
      document_(std::make_unique<Document>()) {
  SceneDescription still = complete;
  still.animation.reset();
  json& base = document_->base;
  base = json::parse(scene_to_json(still));
  const json as_written = json::parse(scene_to_json(written));
  for (std::size_t i = 0; i < animation.tracks.size(); ++i) {
    const AnimationTrack& track = animation.tracks[i];
    try {
      MovingPart part{tokens_of(track.target), track.easing, {}, {}};
      if (track.target == time_target) {
        document_->time = time_part(track, std::move(part), animation);
        continue;
      }
      const std::vector<std::string> whole = part_of(part.tokens);
      json::json_pointer place;
      for (const std::string& token : whole) place /= token;
      if (as_written.contains(place)) place_of(base, whole) = as_written.at(place);
      add_keys(track, part);
      place_of(base, part.tokens);
      document_->parts.push_back(std::move(part));
    } catch (const Error& error) {
      throw Error("animation: track " + std::to_string(i + 1) + ", target " +
                  printable(track.target) + ": " + error.what());
    }
  }
  if (!animation.cameras.empty()) {
    path_.emplace(animation.cameras, animation.seconds, animation.is_closed);
  }
  if (animation.moves_data() && times_.all().empty()) {
    throw Error("animation: \"time\" moves, but no data of the scene have steps");
  }
  // Most of what cannot be interpolated fails at once, as a whole number does.
  constexpr int most_checked = 8;
  const int checked = document_->parts.empty() ? 1 : std::min(frames_, most_checked);
  for (int i = 0; i < checked; ++i) {
    description(checked == 1 ? 0
                             : static_cast<int>(std::int64_t{i} * (frames_ - 1) / (checked - 1)));
  }
  for (const AnimationTrack& track : animation.tracks) {
    for (const AnimationTrack::Key& key : track.keys) {
      document_->scene_at(key.at, "animation, at " + json(key.at).dump() + " s");
    }
  }
}

bool Film::check(const std::function<bool()>& ended) const {
  if (document_->parts.empty()) return true;
  constexpr int asked_every = 16;
  std::vector<json> last;
  for (int frame = 0; frame < frames_; ++frame) {
    if (ended && frame % asked_every == 0 && ended()) return false;
    std::vector<json> values = document_->values_at(seconds(frame));
    if (values == last) continue;
    last = values;
    document_->scene_of(std::move(values), name_of(frame));
  }
  return true;
}

Film::~Film() = default;
Film::Film(Film&&) noexcept = default;
Film& Film::operator=(Film&&) noexcept = default;

std::optional<double> Film::time(int frame) const {
  if (animation_.by_steps) {
    const std::vector<double>& all = times_.all();
    return all[static_cast<std::size_t>(frame) * all.size() / static_cast<std::size_t>(frames_)];
  }
  if (document_->time) return document_->time->at(seconds(frame)).get<double>();
  if (!animation_.time) return std::nullopt;
  const auto [first, last] = *animation_.time;
  if (frames_ == 1) return first;
  return first + (last - first) * frame / (frames_ - 1);
}

SceneDescription Film::description(int frame) const {
  SceneDescription made = document_->scene_at(seconds(frame), name_of(frame));
  if (path_) {
    made.camera = path_->at(seconds(frame));
  } else if (animation_.turntable && made.camera) {
    const double degrees = 360 * animation_.turntable->turns * frame / frames_;
    made.camera = turned_camera(*made.camera, degrees, animation_.turntable->axis);
  }
  if (const auto moment = time(frame)) times_.set(made, *moment);
  return made;
}

Animation default_animation(const SceneTimes& times) {
  Animation animation;
  if (times.all().size() > 1) {
    animation.fps = 10;
    animation.seconds = static_cast<double>(times.all().size()) / animation.fps;
    animation.by_steps = true;
  } else {
    animation.turntable = Turntable{};
  }
  return animation;
}

namespace {

/// Returns the JSON of each layer, and of its data alone.
void describe_layers(const SceneDescription& description, std::vector<std::string>& layers,
                     std::vector<std::string>& sources) {
  const json document = json::parse(scene_to_json(description));
  layers.clear();
  sources.clear();
  for (const json& layer : document.at("layers")) {
    layers.push_back(layer.dump());
    json data;
    for (const char* const key : {"field", "channels", "mesh", "labels", "mask"}) {
      if (layer.contains(key)) data[key] = layer[key];
    }
    if (data.contains("labels")) {
      for (const char* const key : {"colors", "table", "extinction"}) data["labels"].erase(key);
    }
    if (data.contains("mask")) data["mask"].erase("functions");
    sources.push_back(data.dump());
  }
}

bool has_opacity_table(const LayerDescription& layer) {
  const auto is_table = [](const TransferFunctionDescription& function) {
    return std::holds_alternative<OpacityTable>(function);
  };
  return (layer.transfer_function && is_table(*layer.transfer_function)) ||
         (layer.mask && std::ranges::any_of(layer.mask->choices, [&](const auto& choice) {
            return is_table(choice.transfer_function);
          }));
}

}  // namespace

FrameLoader::FrameLoader(const SceneDescription& description, const Scene& loaded)
    : scene_(loaded) {
  describe_layers(description, layers_, sources_);
}

Scene FrameLoader::load(const SceneDescription& description, const ParallelFor& parallel) {
  std::vector<std::string> layers, sources;
  describe_layers(description, layers, sources);
  const std::size_t count = layers.size();
  std::vector<std::optional<Layer>> kept(count);
  for (std::size_t i = 0; i < count && i < layers_.size(); ++i) {
    if (sources[i] == sources_[i]) kept[i] = scene_.layers[i];
  }
  Scene scene = remake_scene(description, kept, parallel, nullptr, scene_.layers);
  // The points that stand for opacity tables depend on the other layers.
  if (std::ranges::none_of(description.layers, has_opacity_table) || layers == layers_) {
    for (std::size_t i = 0; i < count && i < layers_.size(); ++i) {
      if (layers[i] == layers_[i]) scene.layers[i] = scene_.layers[i];
    }
  }
  layers_ = std::move(layers);
  sources_ = std::move(sources);
  scene_ = scene;
  return scene;
}

}  // namespace pellucid

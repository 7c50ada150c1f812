// SPDX-License-Identifier: Apache-2.0
#include "command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <utility>

#include "pellucid/io/animation.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/view_camera.h"

namespace pellucid::view {

namespace {

constexpr int deepest_nesting = 16;
constexpr int max_members = 1024;
/// Drags across several pictures make no sense, nor do wheels that turn as fast.
constexpr double farthest_drag = 10, largest_zoom = 100;

/// Text of a page that a message may repeat: short, and of printable ASCII.
std::string shown(std::string_view text) {
  std::string result;
  for (const char c : text.substr(0, 40)) result += c >= ' ' && c <= '~' ? c : '?';
  return result;
}

/// Reads the members of a message, each once.
class Members {
 public:
  explicit Members(Json message) : message_(std::move(message)) { type_ = text("type", {1, 32}); }

  const std::string& type() const { return type_; }

  Json take(const char* key) {
    const auto found = message_.find(key);
    if (found == message_.end()) fail(key, "is missing");
    Json value = std::move(*found);
    message_.erase(found);
    return value;
  }
  bool has(const char* key) const { return message_.contains(key); }

  double number(const char* key, double least, double most) {
    const Json value = take(key);
    if (!value.is_number()) fail(key, "is not a number");
    const double number = value.get<double>();
    if (!(number >= least && number <= most)) {
      fail(key, fmt::format("is {}, but must be from {} to {}", number, least, most));
    }
    return number;
  }
  int integer(const char* key, int least, int most) {
    const Json value = take(key);
    if (!value.is_number_integer()) fail(key, "is not a whole number");
    const double number = value.get<double>();
    if (!(number >= least && number <= most)) {
      fail(key, fmt::format("is {}, but must be from {} to {}", number, least, most));
    }
    return static_cast<int>(number);
  }
  std::size_t layer() { return static_cast<std::size_t>(integer("layer", 0, 1023)); }
  double drag(const char* key) { return number(key, -farthest_drag, farthest_drag); }
  double share(const char* key) { return number(key, 0, 1); }
  bool flag(const char* key) {
    const Json value = take(key);
    if (!value.is_boolean()) fail(key, "is neither true nor false");
    return value.get<bool>();
  }
  std::string text(const char* key, std::pair<std::size_t, std::size_t> length) {
    Json value = take(key);
    if (!value.is_string()) fail(key, "is not a text");
    std::string text = value.get<std::string>();
    if (text.size() < length.first || text.size() > length.second) {
      fail(key, fmt::format("has {} bytes, but must have from {} to {}", text.size(), length.first,
                            length.second));
    }
    return text;
  }
  std::string path(const char* key, std::size_t least) {
    std::string path = text(key, {least, 4096});
    if (path.find('\0') != path.npos) fail(key, "has a byte 0");
    return path;
  }
  /// Returns the number of the text among the choices.
  std::size_t choice(const char* key, const std::vector<std::string>& choices) {
    const std::string value = text(key, {0, 64});
    const auto found = std::ranges::find(choices, value);
    if (found == choices.end()) {
      fail(key,
           fmt::format("is \"{}\", but must be one of {}", shown(value), fmt::join(choices, ", ")));
    }
    return static_cast<std::size_t>(found - choices.begin());
  }
  void end() const {
    if (message_.empty()) return;
    fail(shown(message_.begin().key()), "is not a member of this message");
  }

  [[noreturn]] void fail(std::string_view key, std::string_view what) const {
    throw Error(
        fmt::format("message{}: {} {}", type_.empty() ? "" : " " + shown(type_), key, what));
  }

 private:
  Json message_;
  std::string type_;
};

std::vector<std::string> texts(Members& members, const char* key, std::size_t most) {
  const Json list = members.take(key);
  if (!list.is_array() || list.empty() || list.size() > most) {
    members.fail(key, fmt::format("is not a list of 1 to {} texts", most));
  }
  std::vector<std::string> result;
  for (const Json& element : list) {
    if (!element.is_string()) members.fail(key, fmt::format("is not a list of texts"));
    result.push_back(element.get<std::string>());
    if (result.back().size() > 256) members.fail(key, "has a text of more than 256 bytes");
  }
  return result;
}

Edit read_edit(Members& members) {
  Edit edit;
  if (members.has("layer")) edit.layer = members.layer();
  edit.key = members.text("key", {1, 32});
  edit.value = members.take("value");
  edit.gesture = members.integer("gesture", 0, 1 << 30);
  return edit;
}

double finite_number(Members& members, const Json& value) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    members.fail("ranges", "has something else than finite numbers");
  }
  return value.get<double>();
}

AskHistogram read_histogram(Members& members) {
  AskHistogram ask{members.layer(), texts(members, "channels", 2)};
  if (members.has("all")) ask.all = members.flag("all");
  if (!members.has("ranges")) return ask;
  const Json ranges = members.take("ranges");
  if (!ranges.is_array() || ranges.size() != ask.channels.size()) {
    members.fail("ranges", "is not a list with one range for each channel");
  }
  for (const Json& range : ranges) {
    if (!range.is_array() || range.size() != 2)
      members.fail("ranges", "has a range of no two ends");
    ask.ranges.push_back({finite_number(members, range[0]), finite_number(members, range[1])});
    if (!(ask.ranges.back().lower < ask.ranges.back().upper)) {
      members.fail("ranges", "has a range that is empty");
    }
  }
  return ask;
}

/// A number far beyond all data; squares of it are numbers.
constexpr double farthest = 1e30;

template <std::size_t count>
std::array<double, count> read_position(Members& members, const char* key) {
  const Json list = members.take(key);
  std::array<double, count> position;
  const auto is_near = [](const Json& value) {
    return value.is_number() && std::abs(value.get<double>()) <= farthest;
  };
  if (!list.is_array() || list.size() != count || !std::ranges::all_of(list, is_near)) {
    members.fail(key, fmt::format("is not a list of {} numbers within {}", count, farthest));
  }
  for (std::size_t i = 0; i < count; ++i) position[i] = list[i].get<double>();
  return position;
}

AskSlice read_slice(Members& members) {
  AskSlice ask;
  ask.plane.axis = members.integer("axis", 0, 2);
  ask.plane.position = members.number("position", -farthest, farthest);
  ask.plane.from = read_position<2>(members, "from");
  ask.plane.to = read_position<2>(members, "to");
  for (const std::size_t a : {0U, 1U}) {
    if (ask.plane.from[a] == ask.plane.to[a]) members.fail("to", "has a number of from");
  }
  ask.plane.columns = members.integer("columns", 1, largest_slice_edge);
  ask.plane.rows = members.integer("rows", 1, largest_slice_edge);
  if (members.has("layer")) {
    ask.layer = members.layer();
    ask.channel = members.integer("channel", 0, 1023);
  }
  return ask;
}

Probe read_probe(Members& members) {
  Probe probe{members.share("x"), members.share("y")};
  if (members.has("picks")) probe.picks = members.flag("picks");
  return probe;
}

EditFilm read_film(Members& members) {
  using Action = EditFilm::Action;
  constexpr std::array actions{Action::set_keyframe, Action::move_keyframe, Action::delete_keyframe,
                               Action::length,       Action::turntable,     Action::remove};
  EditFilm edit{
      actions[members.choice("action", {"set_keyframe", "move_keyframe", "delete_keyframe",
                                        "length", "turntable", "remove"})]};
  if (edit.action == Action::move_keyframe || edit.action == Action::delete_keyframe) {
    edit.keyframe = static_cast<std::size_t>(members.integer("keyframe", 0, most_frames));
  }
  if (edit.action == Action::set_keyframe && members.has("keyframe")) {
    edit.chosen = static_cast<std::size_t>(members.integer("keyframe", 0, most_frames));
  }
  if (edit.action == Action::move_keyframe) edit.frame = members.integer("frame", 0, most_frames);
  if (edit.action == Action::turntable) edit.turns = members.number("turns", -1e4, 1e4);
  if (edit.action == Action::length) {
    edit.seconds = members.number("seconds", 1e-3, 86400);
    edit.fps = members.number("fps", 1e-3, 1000);
  }
  return edit;
}

SaveFilm read_save_film(Members& members) {
  const std::vector<std::string> formats(film_formats.begin(), film_formats.end());
  return {members.integer("width", 1, largest_edge), members.integer("height", 1, largest_edge),
          members.number("tolerance", smallest_tolerance, largest_tolerance),
          formats[members.choice("format", formats)]};
}

struct Kind {
  std::string_view type;
  Command (*read)(Members&);
};

// Members of an aggregate are initialised in the order in which they stand, as braces say.
constexpr Kind kinds[] = {
    {"size",
     [](Members& m) -> Command {
       return Resize{m.integer("width", 1, largest_edge), m.integer("height", 1, largest_edge)};
     }},
    {"turn",
     [](Members& m) -> Command {
       return Turn{m.drag("x"), m.drag("y")};
     }},
    {"pan",
     [](Members& m) -> Command {
       return Pan{m.drag("x"), m.drag("y")};
     }},
    {"zoom",
     [](Members& m) -> Command {
       return Zoom{m.number("factor", 1 / largest_zoom, largest_zoom)};
     }},
    {"roll", [](Members& m) -> Command { return Roll{m.number("degrees", -360, 360)}; }},
    {"center",
     [](Members& m) -> Command {
       return Center{m.share("x"), m.share("y")};
     }},
    {"reset", [](Members&) -> Command { return ResetCamera{}; }},
    {"look_from",
     [](Members& m) -> Command { return LookFrom{view_names()[m.choice("side", view_names())]}; }},
    {"projection",
     [](Members& m) -> Command {
       return SetProjection{m.choice("name", {"perspective", "orthographic"}) == 0
                                ? Projection::perspective
                                : Projection::orthographic};
     }},
    {"tolerance",
     [](Members& m) -> Command {
       return SetTolerance{m.number("value", smallest_tolerance, largest_tolerance)};
     }},
    {"edit", [](Members& m) -> Command { return read_edit(m); }},
    {"undo", [](Members&) -> Command { return Undo{}; }},
    {"redo", [](Members&) -> Command { return Redo{}; }},
    {"suggest",
     [](Members& m) -> Command {
       return Suggest{m.layer(), m.choice("kind", {"curve", "gaussians"}) == 0
                                     ? Suggest::Kind::curve
                                     : Suggest::Kind::gaussians};
     }},
    {"cancel", [](Members&) -> Command { return CancelFit{}; }},
    {"import",
     [](Members& m) -> Command {
       return ImportFunction{m.layer(), m.text("name", {1, 255}),
                             m.text("text", {1, largest_message})};
     }},
    {"export",
     [](Members& m) -> Command {
       const std::vector<std::string> formats{"pellucid", "slicer", "paraview", "table"};
       return ExportFunction{m.layer(), formats[m.choice("format", formats)]};
     }},
    {"histogram", [](Members& m) -> Command { return read_histogram(m); }},
    {"thumbnail",
     [](Members& m) -> Command {
       return AskThumbnail{m.layer(), m.take("function")};
     }},
    {"probe", [](Members& m) -> Command { return read_probe(m); }},
    {"slice", [](Members& m) -> Command { return read_slice(m); }},
    {"locate",
     [](Members& m) -> Command {
       const auto [x, y, z] = read_position<3>(m, "position");
       return Locate{{x, y, z}};
     }},
    {"handle",
     [](Members& m) -> Command {
       return DragHandle{static_cast<std::size_t>(m.integer("clip", 0, 1023)),
                         m.text("handle", {1, 16}), m.drag("x"), m.drag("y"),
                         m.integer("gesture", 0, 1 << 30)};
     }},
    {"error_map", [](Members& m) -> Command { return ShowErrorMap{m.flag("shown")}; }},
    {"component",
     [](Members& m) -> Command {
       return ChooseComponent{m.layer(), m.integer("component", 0, 1 << 20)};
     }},
    {"array",
     [](Members& m) -> Command {
       return ChooseArray{m.layer(), m.text("array", {1, 1024})};
     }},
    {"time",
     [](Members& m) -> Command {
       return ChooseTime{m.layer(), m.number("time", -1e30, 1e30)};
     }},
    {"scene_time", [](Members& m) -> Command { return SetTime{m.number("time", -1e30, 1e30)}; }},
    {"film_frame",
     [](Members& m) -> Command { return ShowFilmFrame{m.integer("frame", 0, most_frames)}; }},
    {"film", [](Members& m) -> Command { return read_film(m); }},
    {"save_film", [](Members& m) -> Command { return read_save_film(m); }},
    {"cancel_film", [](Members&) -> Command { return CancelFilm{}; }},
    {"film_taken", [](Members&) -> Command { return TakeFilm{}; }},
    {"list_file", [](Members& m) -> Command { return ListFile{m.layer()}; }},
    {"list_folder", [](Members& m) -> Command { return ListFolder{m.path("folder", 0)}; }},
    {"open", [](Members& m) -> Command { return OpenFile{m.path("input", 1)}; }},
    {"open_upload",
     [](Members& m) -> Command {
       return OpenUpload{m.integer("set", 0, 1 << 30), m.path("name", 0)};
     }},
    {"save",
     [](Members& m) -> Command {
       constexpr std::array kinds_of_files{Save::Kind::png, Save::Kind::png_with_color_bar,
                                           Save::Kind::exr, Save::Kind::scene};
       return Save{kinds_of_files[m.choice("what", {"png", "png_with_color_bar", "exr", "scene"})]};
     }},
};

Json parse_json(std::string_view message) {
  if (message.size() > largest_message) throw Error("message: is too long");
  // Members of an object are looked up one after the other.
  std::array<int, deepest_nesting + 3> members{};
  const auto shallow = [&](int depth, Json::parse_event_t event, Json&) {
    using Event = Json::parse_event_t;
    if (depth > deepest_nesting && (event == Event::object_start || event == Event::array_start)) {
      throw Error(fmt::format("message: is nested more than {} deep", deepest_nesting));
    }
    const auto level = static_cast<std::size_t>(depth);
    if (event == Event::object_start) members[level + 1] = 0;
    if (event == Event::key && ++members[level] > max_members) {
      throw Error(fmt::format("message: an object has more than {} members", max_members));
    }
    return true;
  };
  try {
    return Json::parse(message, shallow);
  } catch (const Json::exception&) {
    throw Error("message: is not JSON");
  }
}

}  // namespace

Command parse_command(std::string_view message) {
  Json json = parse_json(message);
  if (!json.is_object()) throw Error("message: is not an object");
  Members members(std::move(json));
  const auto kind = std::ranges::find(kinds, members.type(), &Kind::type);
  if (kind == std::end(kinds)) members.fail("type", "is not known");
  Command command = kind->read(members);
  members.end();
  return command;
}

}  // namespace pellucid::view

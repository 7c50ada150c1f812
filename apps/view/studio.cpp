// SPDX-License-Identifier: Apache-2.0
#include "studio.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <new>
#include <type_traits>
#include <utility>

#include "camera_moves.h"
#include "histograms.h"
#include "pellucid/cpu/framed_camera.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/view_camera.h"
#include "probe.h"
#include "server/page_messages.h"
#include "slice.h"
#include "thumbnail.h"

namespace pellucid::view {

namespace {

/// A page that sends faster than commands are carried out, for minutes, is not ours.
constexpr std::size_t max_waiting = 4096;
/// Size of waiting messages. Commands take some twenty times as much memory at worst.
constexpr std::size_t max_waiting_bytes = std::size_t{16} << 20;

/// Until a frame is done, however long it takes.
constexpr double endless = 1e9;
/// Seconds of a turn between which slices are answered: some ten in a second.
constexpr double short_turn = 0.1;

constexpr const char* defect = "; this is a defect of pellucid, please report it";

/// Tells whether a command begins a fit, whose outcome comes later.
bool starts_fit(const Command& command) {
  const auto* const suggest = std::get_if<Suggest>(&command);
  return suggest != nullptr && suggest->kind == Suggest::Kind::gaussians;
}

/// Returns whether a command only asks, so that the frame that is being rendered stays right.
bool only_asks(const Command& command) {
  return std::holds_alternative<Probe>(command) || std::holds_alternative<Save>(command) ||
         std::holds_alternative<AskSlice>(command) || std::holds_alternative<Locate>(command) ||
         std::holds_alternative<AskHistogram>(command) ||
         std::holds_alternative<AskThumbnail>(command) ||
         std::holds_alternative<ExportFunction>(command) ||
         std::holds_alternative<ListFile>(command) || std::holds_alternative<CancelFit>(command) ||
         std::holds_alternative<EditFilm>(command) || std::holds_alternative<SaveFilm>(command) ||
         std::holds_alternative<CancelFilm>(command) || std::holds_alternative<TakeFilm>(command) ||
         starts_fit(command);
}

/// Tells whether a command ends the frame that is being rendered: it changes it, or begins a fit.
bool ends_frame(const Command& command) {
  return !only_asks(command) || starts_fit(command);
}

/// Returns whether a command changes what pages are told of the scene besides the camera.
bool is_edit(const Command& command) {
  if (starts_fit(command)) return false;
  return std::visit(
      []<class Kind>(const Kind&) {
        return std::is_same_v<Kind, Edit> || std::is_same_v<Kind, Undo> ||
               std::is_same_v<Kind, Redo> || std::is_same_v<Kind, Suggest> ||
               std::is_same_v<Kind, ImportFunction> || std::is_same_v<Kind, DragHandle> ||
               std::is_same_v<Kind, ChooseComponent> || std::is_same_v<Kind, ChooseArray> ||
               std::is_same_v<Kind, ChooseTime> || std::is_same_v<Kind, SetTime> ||
               std::is_same_v<Kind, ShowFilmFrame> || std::is_same_v<Kind, EditFilm>;
      },
      command);
}

/// Returns whether a later command makes an earlier one of the same page needless.
bool replaces(const Command& later, const Command& earlier) {
  if (std::holds_alternative<Probe>(later)) {
    const Probe* const probe = std::get_if<Probe>(&earlier);
    return probe != nullptr && !probe->picks;
  }
  if (std::holds_alternative<Locate>(later)) return std::holds_alternative<Locate>(earlier);
  if (std::holds_alternative<SetTime>(later)) return std::holds_alternative<SetTime>(earlier);
  if (std::holds_alternative<ShowFilmFrame>(later)) {
    return std::holds_alternative<ShowFilmFrame>(earlier);
  }
  const Edit *const newer = std::get_if<Edit>(&later), *const older = std::get_if<Edit>(&earlier);
  return newer != nullptr && older != nullptr && newer->gesture == older->gesture &&
         newer->layer == older->layer && newer->key == older->key;
}

/// Number of the last message of each page, by the number of the page.
Json answered_json(const std::map<PageId, std::uint64_t>& answered) {
  Json json = Json::object();
  for (const auto& [page, number] : answered) json[std::to_string(page)] = number;
  return json;
}

/// Returns half of the diagonal of a box around the data, and how far away its far side may be.
double reach_of(const Scene& scene) {
  const std::array<Vec3<double>, 8> corners = world_corners(scene);
  double reach = 0;
  for (const Vec3<double>& corner : corners) {
    reach = std::max(reach, 2 * length(corner - scene.camera.focal_point));
  }
  return reach;
}

}  // namespace

/// Carries out one command of a page.
struct Studio::Visitor {
  Studio& studio;
  PageId page;

  void operator()(const Resize& c) const {
    studio.state_.set_size({c.width, c.height});
    // A camera that nobody has moved shows all of the data in any window.
    if (!studio.is_fitted_ && !studio.first_camera_) studio.fit_camera("oblique");
    studio.is_fitted_ = true;
  }
  void operator()(const Turn& c) const {
    move([&](Camera& camera) { turn(camera, c.x, c.y); });
  }
  void operator()(const Pan& c) const {
    move([&](Camera& camera) { pan(camera, c.x, c.y); });
  }
  void operator()(const Zoom& c) const {
    move([&](Camera& camera) { zoom(camera, c.factor); });
  }
  void operator()(const Roll& c) const {
    move([&](Camera& camera) { roll(camera, c.degrees); });
  }
  void operator()(const Center& c) const {
    const ProbeResult result =
        probe(studio.frames_.renderer(), studio.state_.scene(), Probe{c.x, c.y});
    if (result.position) move([&](Camera& camera) { center(camera, *result.position); });
  }
  void operator()(const ResetCamera&) const {
    if (studio.first_camera_) {
      move([&](Camera& camera) { camera = *studio.first_camera_; });
    } else {
      studio.fit_camera("oblique");
    }
  }
  void operator()(const LookFrom& c) const { studio.fit_camera(c.side); }
  void operator()(const SetProjection& c) const {
    const double reach = reach_of(studio.state_.scene());
    move([&](Camera& camera) { set_projection(camera, c.projection, reach); });
  }
  void operator()(const SetTolerance& c) const { studio.state_.set_tolerance(c.tolerance); }
  void operator()(const Edit& c) const { studio.state_.edit(c); }
  void operator()(const Undo&) const { studio.state_.undo(); }
  void operator()(const Redo&) const { studio.state_.redo(); }
  void operator()(const Suggest& c) const {
    const std::size_t layer = studio.state_.checked_layer(c.layer);
    if (c.kind == Suggest::Kind::gaussians) {
      studio.start_fit(layer, page);
    } else {
      studio.state_.set_default_function(layer);
      studio.start_choice(studio.state_.with_open_function(layer));
    }
  }
  void operator()(const CancelFit&) const { studio.cancel_fit(); }
  void operator()(const ImportFunction& c) const {
    std::vector<std::string> notes;
    const LookDescription look = read_function(c, notes);
    studio.state_.set_look(c.layer, look);
    studio.send_notes(page, notes);
  }
  void operator()(const ExportFunction& c) const {
    std::vector<std::string> notes;
    const std::size_t layer = studio.state_.checked_layer(c.layer);
    studio.send_file(page,
                     function_file(studio.state_.description().layers[layer], c.format, notes));
    studio.send_notes(page, notes);
  }
  void operator()(const AskHistogram& c) const {
    const std::size_t layer = studio.state_.checked_layer(c.layer);
    const JointHistogram histogram =
        count_values(studio.state_.scene().layers[layer], c, studio.parallel_);
    studio.send_(page, text_message(histogram_json(histogram, c)));
  }
  void operator()(const AskThumbnail& c) const {
    studio.send_(page, thumbnail_message(studio.state_, c, studio.thumbnails_));
  }
  void operator()(const Probe& c) const {
    const ProbeResult result = probe(studio.frames_.renderer(), studio.state_.scene(), c);
    studio.send_(page, text_message(probe_json(result, c)));
  }
  void operator()(const AskSlice& c) const {
    studio.slices_are_shown_ = true;
    studio.send_(page, slice_message(studio.state_.scene(), c, studio.parallel_));
  }
  void operator()(const Locate& c) const {
    studio.send_(page, text_message(located_json(studio.state_.scene(), c)));
  }
  void operator()(const DragHandle& c) const {
    studio.state_.set_clips(with_handle_dragged(studio.state_.scene(), c), c.gesture);
  }
  void operator()(const ShowErrorMap& c) const { studio.with_error_map_ = c.shown; }
  void operator()(const ChooseComponent& c) const {
    studio.state_.set_source(
        c.layer,
        [&](LayerDescription& layer) {
          FieldSource& field = field_of(layer);
          field.options.component = c.component;
          field.options.time.reset();
        },
        true);
    studio.cancel_choice();  // It reads another component.
  }
  void operator()(const ChooseArray& c) const {
    studio.state_.set_source(
        c.layer,
        [&](LayerDescription& layer) {
          if (layer.mesh) {
            layer.mesh->channels = {MeshArrayChoice{c.array, {}, std::string(field_channel)}};
            return;
          }
          FieldSource& field = field_of(layer);
          field.options.array = c.array;
          field.options.component.reset();
          field.options.component_name.reset();
        },
        false);
    SceneDescription open = studio.state_.description();
    open.layers[c.layer].transfer_function.reset();
    studio.start_choice(std::move(open));
  }
  void operator()(const SetTime& c) const { studio.state_.set_time(c.time); }
  void operator()(const ShowFilmFrame& c) const {
    studio.state_.show_frame(c.frame);
    studio.is_fitted_ = true;
  }
  void operator()(const EditFilm& c) const { studio.edit_film(c); }
  void operator()(const SaveFilm& c) const { studio.save_film(page, c); }
  void operator()(const CancelFilm&) const { studio.cancel_film(); }
  void operator()(const TakeFilm&) const { studio.forget_film(page); }
  void operator()(const ChooseTime& c) const {
    if (studio.state_.follows_time(studio.state_.checked_layer(c.layer))) {
      return studio.state_.set_time(c.time);
    }
    studio.state_.set_source(
        c.layer,
        [&](LayerDescription& layer) {
          if (!layer.mesh) throw Error("this layer is no mesh with steps of time");
          layer.mesh->options.time = c.time;
        },
        true);
  }
  void operator()(const ListFile& c) const {
    const std::size_t layer = studio.state_.checked_layer(c.layer);
    studio.choices_[layer] = all_choices(studio.state_.description().layers[layer]);
    studio.send_scene();
  }
  void operator()(const Save& c) const { studio.save(page, c.kind); }
  // The viewer carries these out.
  void operator()(const ListFolder&) const {}
  void operator()(const OpenFile&) const {}
  void operator()(const OpenUpload&) const {}

 private:
  template <class Move>
  void move(const Move& how) const {
    studio.move_camera(how);
  }
  static FieldSource& field_of(LayerDescription& layer) {
    if (layer.mesh || layer.labels || !layer.channels.empty()) {
      throw Error("this layer has no file of which a part could be chosen");
    }
    return layer.field;
  }
};

Studio::Studio(SceneState state, bool keeps_camera, int threads, SceneChanged changed, Send send,
               std::vector<std::size_t> quick_layers, Worker worker,
               std::optional<SceneDescription> asked)
    : state_(std::move(state)),
      threads_(threads),
      parallel_(parallel_for(threads)),
      changed_(std::move(changed)),
      send_(std::move(send)),
      lettering_(lettering_of(state_.description())),
      choices_(file_choices(state_.description())),
      frames_(threads, [this](PageMessage message) { send_({}, std::move(message)); }),
      thumbnails_(threads),
      quick_layers_(std::move(quick_layers)) {
  if (keeps_camera) first_camera_ = state_.scene().camera;
  if (asked) start_choice(*std::move(asked));
  if (worker == Worker::own_thread) thread_ = std::thread([this] { run(); });
}

Studio::~Studio() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  wakes_.notify_one();
  frames_.interrupt();
  cancel_choice();
  if (thread_.joinable()) thread_.join();
  choice_.reset();
  cancel_fit();
  fitting_.reset();
  film_job_.reset();
}

void Studio::page_opened(PageId page, std::uint64_t number) {
  {
    const std::lock_guard lock(mutex_);
    opened_.push_back(page);
    received_[page] = number;
    ++pages_;
  }
  wakes_.notify_one();
  tell_of_film(page);
}

void Studio::page_closed(PageId page, std::size_t left) {
  {
    const std::lock_guard lock(mutex_);
    received_.erase(page);
    pages_ = left;
  }
  take_film_from(page);
}

void Studio::receive(PageId page, Command command, std::size_t bytes, std::uint64_t number) {
  // A fit waits for no frame.
  if (std::holds_alternative<CancelFit>(command)) {
    cancel_fit();
    return skip(page, number);
  }
  if (std::holds_alternative<CancelFilm>(command)) {
    cancel_film();
    return skip(page, number);
  }
  if (std::holds_alternative<TakeFilm>(command)) {
    forget_film(page);
    return skip(page, number);
  }
  const bool ends = ends_frame(command);
  {
    const std::lock_guard lock(mutex_);
    received_[page] = number;
    if (!asked_.empty() && asked_.back().page == page && replaces(command, asked_.back().command)) {
      asked_bytes_ -= asked_.back().bytes;
      asked_.pop_back();
    }
    if (asked_.size() >= max_waiting || asked_bytes_ + bytes > max_waiting_bytes) {
      return send_(page, error_message("too many commands wait; this one is left out"));
    }
    asked_bytes_ += bytes;
    asked_.push_back({page, std::move(command), bytes});
  }
  wakes_.notify_one();
  if (ends) frames_.interrupt();
}

void Studio::skip(PageId page, std::uint64_t number) {
  {
    const std::lock_guard lock(mutex_);
    received_[page] = number;
    skipped_ = true;
  }
  wakes_.notify_one();
}

void Studio::run() {
  refine_next();
  while (true) {
    {
      std::unique_lock lock(mutex_);
      wakes_.wait(lock, [&] { return ended_ || has_work(); });
      if (ended_) return;
    }
    work(slices_are_shown_ ? short_turn : endless);
  }
}

bool Studio::advance(double seconds) {
  const auto has_more = [&] {
    const std::lock_guard lock(mutex_);
    return has_work();
  };
  if (!has_more()) return false;
  work(seconds);
  return has_more();
}

bool Studio::has_work() const {
  return is_rendering_ || !asked_.empty() || skipped_ || !opened_.empty() || fitted_ || chosen_ ||
         (stale_ && pages_ > 0);
}

void Studio::work(double seconds) {
  try {
    if (is_rendering_) {
      // What only asks does not wait for the frame; what ends it waits for its first picture.
      carry_out(take_what_asks());
      return render(seconds);
    }
    carry_out(take_asked());
    finish_fit();
    finish_choice();
    greet_opened();
    if (stale_) {
      render(seconds);
    } else if (!failed_) {
      show_current();
    }
  } catch (const std::exception& error) {
    // What telling the scene throws ends neither the program nor the page.
    stale_ = false;
    send_({}, error_message(error.what()));
  }
}

bool Studio::has_ended() {
  const std::lock_guard lock(mutex_);
  return ended_;
}

/// Tells whether the picture that is being rendered is of no use any more. Needs the mutex.
bool Studio::has_overtaken() const {
  return ended_ || fitted_ || chosen_ ||
         std::ranges::any_of(asked_, [](const Asked& asked) { return ends_frame(asked.command); });
}

/// Takes what was asked, unless a part of it ends the frame. Pages are told of what they sent
/// meanwhile behind the frame, which does not count it.
std::deque<Studio::Asked> Studio::take_what_asks() {
  const std::lock_guard lock(mutex_);
  if (has_overtaken() || asked_.empty()) return {};
  skipped_ = true;
  asked_bytes_ = 0;
  return std::exchange(asked_, {});
}

std::deque<Studio::Asked> Studio::take_asked() {
  const std::lock_guard lock(mutex_);
  skipped_ = false;
  answered_ = received_;
  asked_bytes_ = 0;
  return std::exchange(asked_, {});
}

/// A new page has no picture yet.
void Studio::greet_opened() {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(opened_, {}).empty()) return;
  }
  stale_ = true;
  send_scene();
  tell_choice_failure();
}

void Studio::carry_out(std::deque<Asked> asked) {
  // A drag sends edits faster than frames are rendered: scenes are told once, after all of them.
  bool edited = false, changed = false;
  for (const Asked& one : asked) {
    if (has_ended()) return;
    carry_out(one);
    edited = edited || is_edit(one.command);
    changed = changed || !only_asks(one.command);
  }
  if (changed) send_({}, text_message({{"type", "changing"}}));
  if ((changed || edited) && changed_) changed_(state_.resolved_description(), state_.scene());
  if (edited) send_scene();
}

void Studio::carry_out(const Asked& asked) {
  if (!only_asks(asked.command)) {
    stale_ = true;
    frames_.forget_image();
  }
  try {
    std::visit(Visitor{*this, asked.page}, asked.command);
  } catch (const Error& error) {
    send_(asked.page, error_message(error.what()));
  } catch (const Cancelled&) {
    // The program ends.
  } catch (const std::bad_alloc&) {
    send_(asked.page, error_message("there is not enough memory for this"));
  } catch (const std::exception& error) {
    send_(asked.page, error_message(std::string(error.what()) + defect));
  }
}

/// Tells pages that nothing that they sent makes another picture.
void Studio::show_current() {
  send_({}, text_message({{"type", "current"}, {"answered", answered_json(answered_)}}));
}

void Studio::render(double seconds) {
  failed_ = true;
  try {
    if (!std::exchange(is_rendering_, false)) {
      frames_.set_answered(answered_json(answered_));
      frames_.begin(state_.scene(), lettering_, with_error_map_, [this] {
        const std::lock_guard lock(mutex_);
        return has_overtaken();
      });
    }
    const FrameMaker::State state = frames_.advance(seconds);
    is_rendering_ = state == FrameMaker::State::goes_on;
    stale_ = state != FrameMaker::State::exact;
    failed_ = false;
  } catch (const Error& error) {
    send_failure(error.what());
  } catch (const std::bad_alloc&) {
    send_failure("there is not enough memory for a picture of this size");
  } catch (const std::exception& error) {
    send_failure(std::string(error.what()) + defect);
  }
}

/// There is no picture of the scene; pages still show an older one.
void Studio::send_failure(const std::string& why) {
  stale_ = false;
  send_({}, text_message({{"type", "error"}, {"message", why}, {"no_picture", true}}));
}

void Studio::send_scene() {
  send_({}, text_message(scene_json(state_, choices_)));
}

void Studio::send_notes(PageId page, const std::vector<std::string>& notes) {
  if (!notes.empty()) send_(page, text_message({{"type", "notes"}, {"notes", notes}}));
}

void Studio::send_file(PageId page, const SavedFile& file) {
  send_(page, file_message(file));
}

void Studio::move_camera(const std::function<void(Camera&)>& move) {
  Camera camera = state_.scene().camera;
  move(camera);
  state_.set_camera(camera);
  is_fitted_ = true;
}

void Studio::fit_camera(const std::string& side) {
  const Scene& scene = state_.scene();
  Camera camera = view_camera(visible_corners(scene, parallel_), side, scene.size);
  FrameMonitor monitor;
  monitor.progress = [this](double) { return !has_ended(); };
  camera = framed_camera(scene, camera, {}, monitor);
  if (scene.camera.projection == Projection::orthographic) {
    set_projection(camera, Projection::orthographic, reach_of(scene));
  }
  state_.set_camera(camera);
}

void Studio::save(PageId page, Save::Kind kind) {
  if (kind == Save::Kind::scene) {
    return send_file(page, {"scene.json", "application/json", state_.saved()});
  }
  RenderOptions options;
  options.monitor.progress = [this](double) { return !has_ended(); };
  if (kind == Save::Kind::png || kind == Save::Kind::png_with_color_bar) {
    std::vector<ColorBar> bars;
    if (kind == Save::Kind::png_with_color_bar) {
      bars = wanted_color_bars(state_.description(), state_.scene());
    }
    const std::optional<Image>& shown = frames_.exact_image();
    Image image = shown ? *shown : frames_.renderer().render(state_.scene(), options).image;
    if (!bars.empty()) image = with_color_bars(image, bars);
    return send_file(page, png_file(image, shown_background(state_.description())));
  }
  options.outputs.depth = true;
  options.outputs.error = state_.scene().integration.method == Method::exact;
  send_file(page, exr_file(frames_.renderer().render(state_.scene(), options).image));
}

}  // namespace pellucid::view

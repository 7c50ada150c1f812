// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "command.h"
#include "film/film_job.h"
#include "frame_maker.h"
#include "gaussian_fit.h"
#include "scene_facts.h"
#include "scene_state.h"
#include "server/page_server.h"
#include "server/saved_files.h"
#include "steps_choice.h"

namespace pellucid::view {

/// Told of the scene after each change.
using SceneChanged = std::function<void(const SceneDescription&, const Scene&)>;
/// Receiver of a studio's messages: one page, or all if none is given.
using Send = std::function<void(std::optional<PageId>, PageMessage)>;

/// Owns the scene and renders it, on a thread of its own, for all pages together. Commands are
/// carried out in the order in which they come; one that changes the picture ends the frame that is
/// being rendered.
class Studio {
 public:
  /// Who carries out what is asked: a thread of the studio, or whoever calls advance().
  enum class Worker { own_thread, caller };

  /// `keeps_camera`: whether the camera was chosen by the user, and not fitted to the data.
  /// `changed` may be empty. `asked`: the description before it was completed; what it leaves to
  /// data with steps is chosen from all of them, and until then from the one that is shown.
  Studio(SceneState state, bool keeps_camera, int threads, SceneChanged changed, Send send,
         std::vector<std::size_t> quick_layers = {}, Worker worker = Worker::own_thread,
         std::optional<SceneDescription> asked = {});
  ~Studio();
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  // Safe to call from any thread:

  /// `number`: of the messages that the page has sent so far.
  void page_opened(PageId page, std::uint64_t number);
  /// `left`: the number of pages that are left.
  void page_closed(PageId page, std::size_t left);
  /// `bytes` and `number`: of the message that holds it. Frames tell each page the number of its
  /// last message that they follow.
  void receive(PageId page, Command command, std::size_t bytes, std::uint64_t number);
  /// Counts a message that holds no command for the studio.
  void skip(PageId page, std::uint64_t number);

  /// Carries out what was asked, and renders for some seconds. Returns whether there is more to do.
  /// For a studio without a thread of its own.
  bool advance(double seconds);

 private:
  struct Asked {
    PageId page;
    Command command;
    std::size_t bytes;
  };
  struct Visitor;
  /// A fit that goes on.
  struct Fitting {
    std::size_t layer;
    std::optional<PageId> page;  ///< that asked for it; none: it refines the first function
    std::string function;        ///< of the layer when the fit began
    std::shared_ptr<const Volume> data;
    std::unique_ptr<GaussianFit> fit;
  };

  void run();
  /// Returns false when the studio is to end.
  bool has_ended();
  /// Returns whether there is something to do. Needs the mutex.
  bool has_work() const;
  bool has_overtaken() const;
  void work(double seconds);
  std::deque<Asked> take_asked();
  std::deque<Asked> take_what_asks();
  void carry_out(std::deque<Asked> asked);
  void greet_opened();
  void show_current();
  void carry_out(const Asked& asked);
  void render(double seconds);
  void send_failure(const std::string& why);
  void send_scene();
  void send_file(PageId page, const SavedFile& file);
  void send_notes(PageId page, const std::vector<std::string>& notes);
  void move_camera(const std::function<void(Camera&)>& move);
  void fit_camera(const std::string& side);
  void save(PageId page, Save::Kind kind);

  // studio_fit.cpp:
  /// Begins a fit of Gaussians; one that goes on is given up.
  void start_fit(std::size_t layer, std::optional<PageId> page);
  /// Begins the fit of a layer that was suggested quickly, if there is one left.
  void refine_next();
  /// Takes the outcome of a fit that is done, if there is one, into the scene.
  void finish_fit();
  void take_gaussians(const Fitting& fitting, GaussianFit::Outcome outcome);
  void cancel_fit();

  // studio_steps.cpp:
  /// Begins to choose what a description leaves open from all steps, if there are any; a choice
  /// that goes on is given up.
  void start_choice(SceneDescription asked);
  /// Takes what was chosen, if it is done, into the layers that were not edited meanwhile.
  void finish_choice();
  /// Tells pages why nothing was chosen, once there is one.
  void tell_choice_failure();
  /// Waits for what is being chosen, and takes it.
  void wait_for_choice();
  void cancel_choice();

  // studio_film.cpp:
  void edit_film(const EditFilm& edit);
  /// Begins to save a film for a page. All pages are told how far it is. Throws Error if one is
  /// being saved.
  void save_film(PageId page, const SaveFilm& wanted);
  void cancel_film();
  /// Tells pages of the end of a film, and gives one of them its file.
  void end_film(SavedFile file, const std::string& failure);
  /// Gives a file that is kept to the page that asked for it, or to another one if that one is
  /// gone. Needs the mutex of films.
  void give_film();
  /// Tells a new page of the film that is being saved, or gives it the one that is kept.
  void tell_of_film(PageId page);
  /// Gives the file of a film to another page than one that went without having it.
  void take_film_from(PageId page);
  /// Forgets the file of a film, which a page has.
  void forget_film(PageId page);

  SceneState state_;
  int threads_;
  ParallelFor parallel_;
  SceneChanged changed_;
  Send send_;
  Lettering lettering_;
  std::vector<FileChoices> choices_;
  std::optional<Camera> first_camera_;  ///< none: fitted to the data
  FrameMaker frames_;
  Renderer thumbnails_;
  std::string choice_failure_;  ///< reason that no page was told
  bool with_error_map_ = false, is_fitted_ = false;
  std::vector<std::size_t> quick_layers_;
  bool is_rendering_ = false;                 ///< whether a frame goes on
  bool stale_ = true;                         ///< whether the picture is not that of the scene
  bool failed_ = false;                       ///< whether there is no picture of the scene
  bool slices_are_shown_ = false;             ///< True once a page asked for one
  std::map<PageId, std::uint64_t> answered_;  ///< last message of each page that was carried out

  std::mutex mutex_;  ///< of the following
  std::condition_variable wakes_;
  std::deque<Asked> asked_;
  std::size_t asked_bytes_ = 0;               ///< of their messages
  std::vector<PageId> opened_;                ///< pages that have no scene yet
  std::map<PageId, std::uint64_t> received_;  ///< last message of each page
  std::size_t pages_ = 0;
  bool skipped_ = false;  ///< whether messages came that are no commands
  bool ended_ = false;
  std::unique_ptr<Fitting> fitting_;
  std::optional<GaussianFit::Outcome> fitted_;
  std::size_t fit_number_ = 0;
  std::unique_ptr<StepsChoice> choice_;
  std::vector<LayerDescription> before_choice_;
  std::optional<StepsChoice::Outcome> chosen_;
  std::size_t choice_number_ = 0;
  std::mutex film_mutex_;  ///< Mutex of the following; mutex_ may be taken within it
  std::unique_ptr<FilmJob> film_job_;
  PageId film_page_ = 0;                  ///< Page that asked for the film
  bool film_has_ended_ = false;           ///< True once pages were told of the end of film_job_
  std::optional<PageMessage> film_told_;  ///< last progress; none: no film is being saved
  std::optional<PageMessage> film_file_;  ///< kept until a page has it
  std::optional<PageId> film_given_to_;   ///< Page that the file is on its way to
  std::thread thread_;
};

}  // namespace pellucid::view

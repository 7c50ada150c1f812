// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <utility>

#include "pellucid/scene/error.h"
#include "server/page_messages.h"
#include "studio.h"

namespace pellucid::view {

namespace {

using Clock = std::chrono::steady_clock;
/// Pages are told of the progress of a film so often.
constexpr std::chrono::milliseconds told_every{250};

}  // namespace

void Studio::edit_film(const EditFilm& edit) {
  using Action = EditFilm::Action;
  switch (edit.action) {
    case Action::set_keyframe:
      return state_.set_keyframe();
    case Action::move_keyframe:
      return state_.move_keyframe(edit.keyframe, edit.frame);
    case Action::delete_keyframe:
      return state_.delete_keyframe(edit.keyframe);
    case Action::length:
      return state_.set_film_length(edit.seconds, edit.fps);
    case Action::turntable:
      return state_.set_turntable(edit.turns);
    case Action::remove:
      return state_.remove_film();
  }
}

void Studio::save_film(PageId page, const SaveFilm& wanted) {
  if (film_job_ && !film_job_->has_ended()) {
    throw Error("a film is being saved; wait for it, or cancel it");
  }
  const std::lock_guard lock(film_mutex_);
  film_job_ = std::make_unique<FilmJob>(
      state_, wanted, threads_,
      [this, page, last = Clock::time_point(),
       frame = 0](const SavedFilmProgress& progress) mutable {
        const auto now = Clock::now();
        if (progress.frame == frame && now - last < told_every) return;
        last = now;
        frame = progress.frame;
        send_(page, text_message({{"type", "film_progress"},
                                  {"frame", progress.frame},
                                  {"frames", progress.frames},
                                  {"share", progress.share},
                                  {"seconds_left", progress.seconds_left}}));
      },
      [this, page](SavedFile file, const std::string& failure) {
        send_(page, text_message({{"type", "film_ended"}, {"failure", failure}}));
        if (failure.empty()) send_file(page, std::move(file));
      });
}

void Studio::cancel_film() {
  const std::lock_guard lock(film_mutex_);
  if (film_job_) film_job_->cancel();
}

}  // namespace pellucid::view

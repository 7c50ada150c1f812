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
      return state_.set_keyframe(edit.chosen);
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
  {
    const std::lock_guard lock(film_mutex_);
    if (film_job_ && !film_has_ended_) {
      throw Error("a film is being saved; wait for it, or cancel it");
    }
    film_job_.reset();  // whose thread has nothing left to do
    film_file_.reset();
    film_page_ = page;
    film_has_ended_ = false;
  }
  wait_for_choice();
  auto job = std::make_unique<FilmJob>(
      state_, wanted, threads_,
      [this, last = Clock::time_point(), frame = 0](const SavedFilmProgress& progress) mutable {
        const auto now = Clock::now();
        if (progress.frame == frame && now - last < told_every) return;
        last = now;
        frame = progress.frame;
        const std::lock_guard lock(film_mutex_);
        film_told_ = text_message({{"type", "film_progress"},
                                   {"frame", progress.frame},
                                   {"frames", progress.frames},
                                   {"share", progress.share},
                                   {"seconds_left", progress.seconds_left}});
        send_({}, *film_told_);
      },
      [this](SavedFile file, const std::string& failure) { end_film(std::move(file), failure); });
  const std::lock_guard lock(film_mutex_);
  film_job_ = std::move(job);
}

void Studio::cancel_film() {
  const std::lock_guard lock(film_mutex_);
  if (film_job_) film_job_->cancel();
}

void Studio::end_film(SavedFile file, const std::string& failure) {
  const std::lock_guard lock(film_mutex_);
  film_has_ended_ = true;
  film_told_.reset();
  if (!failure.empty()) {
    return send_({}, text_message({{"type", "film_ended"}, {"failure", failure}}));
  }
  film_file_ = file_message(file);
  give_film();
}

void Studio::give_film() {
  film_given_to_.reset();
  {
    const std::lock_guard lock(mutex_);
    if (received_.contains(film_page_)) {
      film_given_to_ = film_page_;
    } else if (!received_.empty()) {
      film_given_to_ = received_.begin()->first;
    }
  }
  if (!film_given_to_) return;
  send_({}, text_message({{"type", "film_ended"}, {"failure", ""}, {"page", *film_given_to_}}));
  send_(*film_given_to_, *film_file_);
}

void Studio::tell_of_film(PageId page) {
  const std::lock_guard lock(film_mutex_);
  if (film_told_) send_(page, *film_told_);
  if (film_file_ && !film_given_to_) give_film();
}

void Studio::take_film_from(PageId page) {
  const std::lock_guard lock(film_mutex_);
  if (film_file_ && film_given_to_ == page) give_film();
}

void Studio::forget_film(PageId page) {
  const std::lock_guard lock(film_mutex_);
  if (film_given_to_ == page) film_file_.reset();
}

}  // namespace pellucid::view

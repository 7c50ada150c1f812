// SPDX-License-Identifier: Apache-2.0
#include "film_job.h"
#include "pellucid/scene/error.h"

namespace pellucid::view {

std::vector<std::string> savable_film_formats() {
  return {};
}

FilmJob::FilmJob(const SceneState&, SaveFilm, int, Progress, Done, std::uintmax_t) {
  throw Error(
      "a page without a program saves no film; save the scene, and call pellucid animate "
      "scene.json -o film.webm");
}

FilmJob::~FilmJob() = default;

}  // namespace pellucid::view

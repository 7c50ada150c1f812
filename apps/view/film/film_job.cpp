// SPDX-License-Identifier: Apache-2.0
#include "film_job.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <string_view>
#include <utility>

#include "film_frames.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/internal/temporary_folder.h"
#include "pellucid/io/internal/zip_files.h"
#include "pellucid/scene/error.h"

namespace pellucid::view {

namespace {

namespace fs = std::filesystem;

/// Returns whether a program is in one of the folders of PATH.
bool has_program(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path != nullptr ? path : "";
  while (!rest.empty()) {
    const std::size_t end = rest.find(':');
    const fs::path file = fs::path(rest.substr(0, end)) / name;
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0) return true;
    rest = end == rest.npos ? "" : rest.substr(end + 1);
  }
  return false;
}

/// A film, and all that its thread takes for it.
struct Work {
  std::unique_ptr<Film> film;
  std::unique_ptr<FrameLoader> loader;
  SaveFilm wanted;
  double fps = 0;
  int threads = 0;
  std::uintmax_t most_bytes = 0;
};

std::string content_type_of(const std::string& format) {
  return format == "zip" ? "application/zip" : "video/" + format;
}

void check_size(std::uintmax_t bytes, std::uintmax_t most) {
  if (bytes <= most) return;
  throw Error(fmt::format(
      "the film has more than {} MB, the most that a page can be given; make it "
      "smaller or shorter, or save the scene and call pellucid animate scene.json -o film.webm",
      most >> 20));
}

/// Renders and encodes the film into the folder, and returns the path of its file. `progress`
/// returns false where it is cancelled.
fs::path make_file(const Work& work, const fs::path& folder,
                   const std::function<bool(const FilmProgress&)>& progress,
                   const std::function<bool()>& cancelled) {
  const bool is_zip = work.wanted.format == "zip";
  const fs::path made = folder / ("film." + work.wanted.format);
  const FilmFiles files(is_zip ? folder / "film" / "%04d.png" : made);
  files.check_size({work.wanted.width, work.wanted.height});
  if (!work.film->check(cancelled)) throw Cancelled();
  RenderOptions options;
  options.machine.threads = work.threads;
  std::uintmax_t bytes = 0;
  const auto count_bytes = [&](int frame) {
    if (is_zip) bytes += fs::file_size(files.picture(frame));
    check_size(bytes, work.most_bytes);
  };
  FilmFrames film_frames(
      *work.film, files, *work.loader, parallel_for(work.threads), options,
      {[](int) { return true; }, work.film->frames(),
       [](const SceneDescription& description) { return scene_to_json(description); }, progress,
       [&](const FilmFrame& frame, RenderResult&) {
         if (frame.number > 0) count_bytes(frame.number - 1);
       }});
  film_frames.render();
  const int count = work.film->frames();
  if (!progress({count + 1, count, 0, 0})) throw Cancelled();
  count_bytes(count - 1);
  if (!files.finish(count, work.fps, false, cancelled)) throw Cancelled();
  if (!is_zip) return made;
  std::vector<fs::path> pictures;
  pictures.reserve(static_cast<std::size_t>(count));
  for (int frame = 0; frame < count; ++frame) pictures.push_back(files.picture(frame));
  write_zip(made, pictures);
  return made;
}

SavedFile read_file(const fs::path& path, const Work& work) {
  check_size(fs::file_size(path), work.most_bytes);
  return {path.filename().string(), content_type_of(work.wanted.format),
          read_bytes(path, work.most_bytes)};
}

/// Returns a message without the folder, which pages do not know.
std::string without_folder(std::string text, const fs::path& folder) {
  const std::string path = folder.string() + "/";
  for (std::size_t at = text.find(path); at != text.npos; at = text.find(path)) {
    text.erase(at, path.size());
  }
  // What the program proposes there is a choice of the page.
  const std::size_t proposal = text.find("; or give a name of pictures");
  if (proposal != text.npos) text = text.substr(0, proposal) + "; choose numbered pictures instead";
  return text;
}

}  // namespace

std::vector<std::string> savable_film_formats() {
  std::vector<std::string> formats(film_formats.begin(), film_formats.end());
  if (!has_program("ffmpeg")) formats = {"zip"};
  return formats;
}

FilmJob::FilmJob(const SceneState& state, SaveFilm wanted, int threads, Progress progress,
                 Done done, std::uintmax_t most_bytes) {
  SceneState sized = state;
  sized.set_size({wanted.width, wanted.height});
  sized.set_tolerance(wanted.tolerance);
  const Animation animation = sized.film_to_save();
  auto work = std::make_shared<Work>();
  work->film = std::make_unique<Film>(sized.make_film(animation));
  work->loader = std::make_unique<FrameLoader>(sized.make_loader());
  work->wanted = std::move(wanted);
  work->fps = animation.fps;
  work->threads = threads;
  work->most_bytes = most_bytes;
  thread_ = std::thread([this, work, progress = std::move(progress), done = std::move(done)] {
    SavedFile file;
    std::string failure;
    try {
      progress({1, work->film->frames(), 0, -1});
      const TemporaryFolder folder("a film");
      try {
        const auto cancelled = [this] { return cancelled_.load(); };
        const auto tell = [&](const FilmProgress& now) {
          progress({now.frame, now.frames, now.share_done, now.seconds_left.value_or(-1)});
          return !cancelled_;
        };
        const fs::path path = make_file(*work, folder.path(), tell, cancelled);
        if (cancelled_) throw Cancelled();  // while it was packed
        file = read_file(path, *work);
      } catch (const Error& error) {
        failure = without_folder(error.what(), folder.path());
      }
    } catch (const Cancelled&) {
      failure = "the film was cancelled; no file is left of it";
    } catch (const std::bad_alloc&) {
      failure = "there is not enough memory for this film";
    } catch (const fs::filesystem_error& error) {
      failure = "the film needs a folder for temporary files (TMPDIR): " + error.code().message();
    } catch (const std::exception& error) {
      failure = error.what();
    }
    done(std::move(file), failure);
    ended_ = true;
  });
}

FilmJob::~FilmJob() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

}  // namespace pellucid::view

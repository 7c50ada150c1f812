// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/film_files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <system_error>
#include <utility>

#include "files/numbered_files.h"
#include "images/picture_text.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/scene_json.h"
#include "pellucid/scene/error.h"
#include "video.h"

namespace pellucid {
namespace {

constexpr const char* made_from_key = "pellucid.made_from";

/// Returns the pattern of a name with one %d or %04d, of up to nine digits, and no other %.
std::optional<NamePattern> frame_pattern(const std::string& name) {
  std::optional<NamePattern> pattern = name_pattern(name);
  if (!pattern || std::ranges::count(name, '%') != 1) return std::nullopt;
  const bool is_plain = pattern->letter == 'd' && !pattern->plus && pattern->width < 10;
  return is_plain && pattern->zeros == (pattern->width > 0) ? pattern : std::nullopt;
}

/// Returns the size that a .png states in its first chunk.
ImageSize png_size(const std::filesystem::path& path) {
  std::array<unsigned char, 24> head{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(head.data()), std::ssize(head))) {
    throw Error(path.string() + ": the picture of a frame is not there, or is damaged");
  }
  const auto number = [&](std::size_t at) {
    return head[at] << 24 | head[at + 1] << 16 | head[at + 2] << 8 | head[at + 3];
  };
  return {number(16), number(20)};
}

}  // namespace

FilmFiles::FilmFiles(std::filesystem::path path) : path_(std::move(path)) {
  const std::string name = path_.filename().string(), extension = path_.extension().string();
  if (is_video_extension(extension)) {
    check_writable(path_);
    check_video(path_);
    folder_ = path_;
    folder_ += ".frames";
    after_ = ".png";
  } else {
    const bool is_picture = extension == ".png" || extension == ".exr";
    const auto pattern = is_picture ? frame_pattern(name) : std::nullopt;
    if (!pattern) {
      throw Error(path_.string() +
                  ": cannot be a film; give a name that ends in .webm or .mp4, or one of pictures "
                  "with a place for their number, as frames/%04d.png");
    }
    before_ = pattern->before;
    after_ = pattern->behind;
    digits_ = static_cast<int>(pattern->width);
  }
  const std::filesystem::path folder = is_video() ? folder_ : path_.parent_path();
  // The folder is made with its first picture, so that a film that fails leaves none.
  std::filesystem::path missing;
  std::error_code failure;
  for (std::filesystem::path at = folder; !at.empty() && !std::filesystem::exists(at, failure);
       at = at.parent_path()) {
    if (failure) throw Error(at.string() + ": cannot write: " + failure.message());
    missing = at;
  }
  if (missing.empty() && !folder.empty() && !std::filesystem::is_directory(folder, failure)) {
    throw Error(folder.string() + ": is a file, but pictures need a folder of this name");
  }
  check_writable(missing.empty() ? picture(0) : missing);
}

void FilmFiles::check_size(ImageSize size) const {
  if (is_video()) check_video(path_, size);
}

/// A lock of a folder, which ends with this or with the process.
class FilmFiles::Hold {
 public:
  Hold(std::filesystem::path folder, Holder holder) : folder_(std::move(folder)) {
    while (true) {
      std::error_code failure;
      std::filesystem::create_directory(folder_, failure);
      if (failure) {
        throw Error(folder_.string() + ": cannot make the folder: " + failure.message());
      }
      file_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      // Folders of some file systems cannot be held.
      if (file_ < 0) return;
      const int how = holder == Holder::alone ? LOCK_EX : LOCK_SH;
      const bool is_held = flock(file_, how | LOCK_NB) != 0 && errno == EWOULDBLOCK;
      if (!is_held && is_there()) return;
      close(file_);
      if (!is_held) continue;  // Another one has removed it meanwhile.
      throw Error(folder_.string() +
                  ": another call makes this video now; wait for its end, or give another name");
    }
  }
  ~Hold() {
    // Before the lock goes, so that it is empty still.
    if (file_ < 0 || is_there()) rmdir(folder_.c_str());
    if (file_ >= 0) close(file_);
  }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

 private:
  bool is_there() const {
    struct stat held {};
    struct stat there {};
    return fstat(file_, &held) == 0 && stat(folder_.c_str(), &there) == 0 &&
           held.st_ino == there.st_ino && held.st_dev == there.st_dev;
  }

  std::filesystem::path folder_;
  int file_ = -1;
};

void FilmFiles::hold(Holder holder) {
  if (is_video()) hold_ = std::make_shared<const Hold>(folder_, holder);
}

std::filesystem::path FilmFiles::picture(int frame) const {
  std::string number = std::to_string(frame);
  const auto digits = static_cast<std::size_t>(digits_);
  if (number.size() < digits) number.insert(0, digits - number.size(), '0');
  return (is_video() ? folder_ : path_.parent_path()) / (before_ + number + after_);
}

bool FilmFiles::has(int frame, const std::string& made_from) const {
  const std::filesystem::path path = picture(frame);
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) return false;
  const auto text = picture_text(path, made_from_key);
  return text && *text == made_from;
}

std::optional<std::string> FilmFiles::text(int frame, const std::string& name) const {
  return picture_text(picture(frame), name);
}

void FilmFiles::write(int frame, const Image& image, const std::string& made_from,
                      const std::optional<Background>& background) const {
  Image stamped = image;
  stamped.metadata[made_from_key] = made_from;
  const std::filesystem::path path = picture(frame);
  if (std::error_code failure; path.has_parent_path()) {
    std::filesystem::create_directories(path.parent_path(), failure);
    if (failure) {
      throw Error(path.parent_path().string() + ": cannot make the folder: " + failure.message());
    }
  }
  if (path.extension() == ".exr") {
    write_exr(stamped, path);
  } else {
    // A video has no transparency.
    write_png(stamped, path, is_video() && !background ? calm_background() : background);
  }
}

bool FilmFiles::finish(int frames, double fps, bool keeps_pictures,
                       const std::function<bool()>& ended) const {
  if (!is_video()) return true;
  if (!make_video(folder_, digits_, frames, fps, png_size(picture(0)), path_, ended)) return false;
  std::error_code ignored;  // pictures that stay do no harm
  remove_behind(frames);
  if (keeps_pictures) return true;
  for (int frame = 0; frame < frames; ++frame) std::filesystem::remove(picture(frame), ignored);
  std::filesystem::remove(folder_, ignored);
  return true;
}

void FilmFiles::remove_behind(int frames) const {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
    const std::filesystem::path& path = entry.path();
    const std::string name = path.filename().string();
    int number = -1;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    const bool is_behind = error == std::errc{} && number >= frames && path == picture(number);
    if (is_behind && picture_text(path, made_from_key)) std::filesystem::remove(path, ignored);
  }
}

std::string data_stamp(const SceneDescription& description) {
  std::string stamp;
  SceneDescription scene = description;
  visit_paths(scene, [&](const std::filesystem::path& path) {
    if (path.empty()) return;
    std::error_code failure;
    const auto changed = std::filesystem::last_write_time(path, failure);
    if (failure) return;
    const auto size = std::filesystem::is_regular_file(path, failure)
                          ? std::filesystem::file_size(path, failure)
                          : 0;
    stamp += path.string() + " " + std::to_string(size) + " " +
             std::to_string(changed.time_since_epoch().count()) + "\n";
  });
  return stamp;
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include "video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"

extern char** environ;

namespace pellucid {
namespace {

/// Time between two questions whether a process is to end.
constexpr std::chrono::milliseconds asked_every{50};

/// End of a process: its status, -1 if it could not be started, and what it wrote to stderr.
struct Outcome {
  int status = -1;
  std::string said;
  bool was_ended = false;  ///< True where it was killed, as its caller wanted
};

/// Collects what a process says, until it closes the pipe. Returns false where it is to end.
bool listen(int pipe_end, const std::function<bool()>& ended, std::string& said) {
  std::array<char, 1024> part{};
  constexpr std::size_t most = 4096;
  while (true) {
    if (ended && ended()) return false;
    pollfd waited{pipe_end, POLLIN, 0};
    const int ready = poll(&waited, 1, ended ? static_cast<int>(asked_every.count()) : -1);
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    if (ready < 0) return true;
    const ssize_t count = read(pipe_end, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return true;
    if (said.size() < most) said.append(part.data(), static_cast<std::size_t>(count));
  }
}

/// Waits for a process that closed its pipe, and returns its status. Kills it where it is to end.
int wait_for(pid_t process, bool& was_ended, const std::function<bool()>& ended) {
  int status = 0;
  while (true) {
    if (!was_ended && ended && ended()) was_ended = true;
    if (was_ended) kill(process, SIGKILL);
    const bool asks = ended && !was_ended;
    const pid_t found = waitpid(process, &status, asks ? WNOHANG : 0);
    if (found == process || (found < 0 && errno != EINTR)) return status;
    if (found == 0) std::this_thread::sleep_for(asked_every);
  }
}

/// Runs ffmpeg in a folder and waits for it, or until `ended`.
Outcome run_ffmpeg(std::vector<std::string> arguments, const std::filesystem::path& folder,
                   const std::function<bool()>& ended = {}) {
  arguments.insert(arguments.begin(), {"ffmpeg", "-nostdin", "-hide_banner", "-v", "error"});
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);

  std::array<int, 2> pipe_ends{};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) return {};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t process = 0;
  const int failure = posix_spawnp(&process, "ffmpeg", &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(pipe_ends[1]);

  Outcome outcome;
  if (failure == 0) outcome.was_ended = !listen(pipe_ends[0], ended, outcome.said);
  close(pipe_ends[0]);
  if (failure != 0) return outcome;
  const int status = wait_for(process, outcome.was_ended, ended);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  return outcome;
}

/// Returns the first line of what it said, without the part of FFmpeg that said it: "[libx264 @
/// 0x55fb] ".
std::string first_line(const Outcome& outcome) {
  std::string line = outcome.said.substr(0, outcome.said.find('\n'));
  const std::size_t end = line.find("] ");
  if (line.starts_with('[') && end != line.npos) line.erase(0, end + 2);
  return line.empty() ? "it gave no reason" : printable(line);
}

std::string size_text(ImageSize size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

/// Returns the size of a video's frames: encoders take even ones.
ImageSize even(ImageSize size) {
  return {size.width + size.width % 2, size.height + size.height % 2};
}

/// Returns the filter that gives pictures of a size even ones. It repeats the last row or column,
/// which goes unseen, unlike a black one.
std::string filling(ImageSize size) {
  const ImageSize whole = even(size);
  const int right = whole.width - size.width, bottom = whole.height - size.height;
  if (right == 0 && bottom == 0) return "";
  return "format=gbrp,pad=" + std::to_string(whole.width) + ":" + std::to_string(whole.height) +
         ",fillborders=right=" + std::to_string(right) + ":bottom=" + std::to_string(bottom) +
         ":mode=smear,";
}

/// Returns how a video of this name is encoded, its container last.
std::vector<std::string> encoding_of(const std::filesystem::path& path) {
  if (path.extension() == ".webm") {
    return {"-c:v", "libvpx-vp9", "-crf", "18", "-b:v", "0", "-row-mt", "1", "-f", "webm"};
  }
  return {"-c:v", "libx264", "-crf", "16", "-movflags", "+faststart", "-f", "mp4"};
}

}  // namespace

bool is_video_extension(const std::string& extension) {
  return extension == ".webm" || extension == ".mp4";
}

void check_video(const std::filesystem::path& path, std::optional<ImageSize> size) {
  const std::string tried = size_text(even(size.value_or(ImageSize{64, 64})));
  std::vector<std::string> arguments{
      "-f",        "lavfi", "-i",  "color=size=" + tried + ":duration=0.1",
      "-frames:v", "1",     "-vf", "format=yuv420p"};
  const std::vector<std::string> encoding = encoding_of(path);
  arguments.insert(arguments.end(), encoding.begin(), encoding.end() - 2);
  arguments.insert(arguments.end(), {"-f", "null", "-"});
  const Outcome outcome = run_ffmpeg(std::move(arguments), ".");
  constexpr const char* otherwise = "; or give a name of pictures, as frames/%04d.png";
  if (outcome.status == -1 || outcome.status == 127) {
    throw Error(path.string() +
                ": videos are made by the program ffmpeg, which was not found; "
                "install it (Debian: ffmpeg)" +
                otherwise);
  }
  if (outcome.status != 0) {
    throw Error(path.string() + ": ffmpeg cannot encode it" +
                (size ? " with " + size_text(*size) + " pixels: " : ": ") + first_line(outcome) +
                otherwise);
  }
}

bool make_video(const std::filesystem::path& folder, int digits, int frames, double fps,
                ImageSize size, const std::filesystem::path& path,
                const std::function<bool()>& ended) {
  AtomicFile file(path);
  const std::string rate = std::to_string(fps);
  // The signals of the pictures are sRGB in full range; players assume BT.709 in limited range.
  std::vector<std::string> arguments{
      "-y",
      "-f",
      "image2",
      "-framerate",
      rate,
      "-start_number",
      "0",
      "-i",
      "%0" + std::to_string(digits) + "d.png",
      "-frames:v",
      std::to_string(frames),
      "-vf",
      filling(size) +
          "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int,"
          "format=yuv420p",
      "-color_primaries",
      "bt709",
      "-color_trc",
      "iec61966-2-1",
      "-colorspace",
      "bt709",
      "-color_range",
      "tv",
      "-fflags",
      "+bitexact",
      "-flags:v",
      "+bitexact",
      "-map_metadata",
      "-1"};
  const std::vector<std::string> encoding = encoding_of(path);
  arguments.insert(arguments.end(), encoding.begin(), encoding.end());
  // With the protocol's name a colon in a path is no protocol.
  arguments.push_back("file:" + std::filesystem::absolute(file.temporary_path()).string());
  const Outcome outcome = run_ffmpeg(std::move(arguments), folder, ended);
  // Ctrl-C ends it, too.
  if (outcome.was_ended || (outcome.status != 0 && ended && ended())) return false;
  if (outcome.status != 0) {
    throw Error(path.string() + ": ffmpeg failed: " + first_line(outcome) +
                "; the pictures are in " + folder.string());
  }
  file.commit();
  return true;
}

}  // namespace pellucid

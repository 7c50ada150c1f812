// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "pellucid/scene/scene.h"

namespace pellucid {

/// Returns whether videos have this extension: ".webm" or ".mp4".
bool is_video_extension(const std::string& extension);

/// Throws Error if the program ffmpeg is not there, or cannot encode a video of this name and size,
/// or of any: encodes a black frame.
void check_video(const std::filesystem::path& path, std::optional<ImageSize> size = {});

/// Makes a video of pictures "000000.png" … in a folder, by FFmpeg, which is a process of its own.
/// Repeats the last row or column where a size is odd. Equal pictures make an equal file.
/// Throws Error with the first line of what it says. `ended` is asked some twenty times a second,
/// if there is one: where it returns true the process is killed, no file is left, and false is
/// returned.
bool make_video(const std::filesystem::path& folder, int digits, int frames, double fps,
                ImageSize size, const std::filesystem::path& path,
                const std::function<bool()>& ended);

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "pellucid/scene/volume.h"

namespace pellucid::cli {

using Json = nlohmann::ordered_json;

/// Writes to stdout. Throws Error where that fails (a full disk, a closed pipe).
void print_text(const std::string& text);
/// Prints indented JSON, with one line feed at the end. Numbers that are not finite become null.
void print_json(const Json& json);
/// Prints "pellucid: …" on stderr; one line.
void print_note(const std::string& text);
/// Prints an error on stderr likewise, at once.
void print_error(const std::string& message);

Json to_json(const Vec3<double>& v);
Json dimensions_json(const Volume& volume);
/// Returns the lower-case extension with its dot: ".png".
std::string extension_of(const std::filesystem::path& path);

}  // namespace pellucid::cli

// SPDX-License-Identifier: Apache-2.0
//
// Stands in for exr_file.cpp where there is no OpenEXR: in a page.
#include "pellucid/io/image_files.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const char* verb) {
  throw Error(path.string() + ": a page " + verb +
              " no OpenEXR; save the scene and its data, and take the program for it");
}

}  // namespace

void write_exr(const Image&, const std::filesystem::path& path) {
  refuse(path, "writes");
}

void write_error_exr(const Image&, double, const std::filesystem::path& path) {
  refuse(path, "writes");
}

void write_values_exr(const Image&, const std::filesystem::path& path) {
  refuse(path, "writes");
}

Image read_exr(const std::filesystem::path& path) {
  refuse(path, "reads");
}

}  // namespace pellucid

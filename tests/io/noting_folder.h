// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "image_files.h"
#include "pellucid/io/read_volume.h"

namespace pellucid::test {

/// A scratch folder whose readings keep their notes.
class NotingFolder : public ScratchFolder {
 protected:
  std::vector<Volume> components(const std::filesystem::path& file, ReadOptions options = {}) {
    notes_.clear();
    options.note = [this](const std::string& text) { notes_.push_back(text); };
    return read_components(file, options);
  }
  /// Pages of all components in their order.
  std::string order(const std::filesystem::path& file, const ReadOptions& options = {}) {
    return page_order(components(file, options));
  }
  std::string refused(const std::filesystem::path& file, const ReadOptions& options = {}) {
    return error_of([&] { read_components(file, options); });
  }
  Vec3<double> spacing(const std::filesystem::path& file) {
    return components(file).front().description().placement.spacing;
  }
  bool is_noted(const std::string& part) const {
    for (const std::string& note : notes_) {
      if (contains(note, part)) return true;
    }
    return false;
  }
  std::string notes() const {
    std::string all;
    for (const std::string& note : notes_) all += note + "\n";
    return all;
  }

  std::vector<std::string> notes_;
};

}  // namespace pellucid::test

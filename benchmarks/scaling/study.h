// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pellucid/cpu/render.h"

namespace pellucid::bench {

struct StudyOptions {
  int size = 512;   ///< width and height of the images
  int threads = 1;  ///< the most
  std::size_t rounds = 3;
  int points = 256;          ///< data values per axis where they do not vary
  int largest_points = 512;  ///< where they do
  std::function<void(const std::string&)> say;
};

/// What a study finds: a table for readers and its figures.
struct Study {
  std::string name, markdown;
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
};

/// Time of a frame from one thread to the most.
Study study_threads(const StudyOptions& options);
/// Time of a frame on one thread with each instruction set that runs here, from scalar on.
Study study_instruction_sets(const StudyOptions& options);
/// Time of a frame and per cell that its rays cross, over the data's size.
Study study_size(const StudyOptions& options);
/// Time of a frame in which a ball fills less and less of a box that is empty else.
Study study_empty_space(const StudyOptions& options);

}  // namespace pellucid::bench

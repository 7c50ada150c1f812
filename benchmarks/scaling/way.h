// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid::bench {

/// A method at one setting.
struct Way {
  std::string name;
  Integration integration;
};

/// Exact at a tolerance of 1/512, and the sampling methods that are there at a step of one voxel.
std::vector<Way> compared_ways();

/// The seconds that a frame takes, as its report says.
double seconds_of_frame(const Scene& scene, const Integration& integration, int threads,
                        RenderReport* report = nullptr,
                        std::optional<InstructionSet> instruction_set = {});

/// Whether render() can be told which instruction set to use.
bool instruction_set_is_a_choice();

/// Cells of the grid that the rays through all pixel centres cross in the data's box.
std::uint64_t cells_crossed(const Scene& scene);

}  // namespace pellucid::bench

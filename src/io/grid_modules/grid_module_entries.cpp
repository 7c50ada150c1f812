// SPDX-License-Identifier: Apache-2.0
//
// Part of every module of grids: its functions, by the names that it is asked for.
#include "grid_module.h"
#include "process/module_answer.h"

namespace {

// The values' memory was there before; what a library takes beside it depends on the file.
constexpr const char* remedy =
    "the file is damaged, or asks for far more than its size lets expect; get it again, or crop or "
    "reduce the volume";

}  // namespace

extern "C" __attribute__((visibility("default"))) void pellucid_list_grids_5(
    const std::filesystem::path& path, const pellucid::AxisLetters& axes,
    pellucid::GridContents& answer) {
  pellucid::answer(answer.error, remedy, [&] { pellucid::list_grids(path, axes, answer); });
}

extern "C" __attribute__((visibility("default"))) void pellucid_read_grid_5(
    const std::filesystem::path& path, const std::string& array, const pellucid::AxisLetters& axes,
    pellucid::ComponentRange range, pellucid::GridValues& answer) {
  pellucid::answer(answer.error, remedy,
                   [&] { pellucid::read_grid(path, array, axes, range, answer); });
}

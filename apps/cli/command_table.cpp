// SPDX-License-Identifier: Apache-2.0
//
// All commands. In builds for a first picture left_out.cpp stands in.
#include "commands.h"

namespace pellucid::cli {

std::span<const AddCommand> command_table() {
  static constexpr AddCommand table[] = {
      add_render,  add_animate, add_view,     add_export,  add_info,    add_histogram,
      add_suggest, add_convert, add_evaluate, add_compare, add_presets, add_transfer_function};
  return table;
}

}  // namespace pellucid::cli

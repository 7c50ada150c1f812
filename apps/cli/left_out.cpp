// SPDX-License-Identifier: Apache-2.0
//
// Stands in for the sources and libraries that builds for a first picture leave out
// (PELLUCID_FIRST_PICTURE).
#include "pellucid/scene/internal/left_out.h"

#include "commands.h"
#include "pellucid/reference/render.h"
#include "render/render.h"
#include "view/suggestions.h"

namespace pellucid {

namespace cli {
namespace {

/// Adds a command, the arguments of which are not read.
Command add_left_out(CommandLine& app, const char* name) {
  CommandLine& command = *app.add_subcommand(name, "Is not in this program yet");
  command.take_any_arguments();
  return {&command, [name]() -> int { throw left_out(std::string("the command ") + name); }};
}

template <std::size_t number>
Command add_left_out(CommandLine& app) {
  static constexpr const char* names[] = {
      "animate", "view",     "info",    "histogram", "suggest",          "convert",
      "export",  "evaluate", "compare", "presets",   "transfer-function"};
  return add_left_out(app, names[number]);
}

}  // namespace

std::span<const AddCommand> command_table() {
  static constexpr AddCommand table[] = {add_render,      add_left_out<0>, add_left_out<1>,
                                         add_left_out<2>, add_left_out<3>, add_left_out<4>,
                                         add_left_out<5>, add_left_out<6>, add_left_out<7>,
                                         add_left_out<8>, add_left_out<9>, add_left_out<10>};
  return table;
}

bool is_rank(int, char**) {
  return false;
}

int fail_on_ranks(const std::string& wrong_use) {
  throw left_out(wrong_use + "; what runs on ranks");
}

int run_on_ranks(const RenderArguments&) {
  throw left_out("--ranks: what runs on ranks");
}

}  // namespace cli

RenderResult render_reference(const Scene&, const RenderOptions&) {
  throw left_out("--reference: the reference renderer");
}

std::vector<std::optional<Layer>> view::suggest_missing_functions(
    SceneDescription&, const ParallelFor&,
    const std::function<void(std::vector<ChannelSource>&)>&) {
  throw left_out("what suggests functions");
}

}  // namespace pellucid

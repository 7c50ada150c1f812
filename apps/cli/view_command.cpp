// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "arguments/mesh_input.h"
#include "arguments/output.h"
#include "arguments/parse.h"
#include "commands.h"
#include "render/progress.h"
#include "render/render.h"
#include "view/viewer.h"

namespace pellucid::cli {

namespace {

struct ViewArguments {
  RenderArguments scene;
  int port = 0;
  bool no_open = false, end_with_page = false;
};

/// Opens an address in the user's browser. Others can read the arguments of a program, so that the
/// browser is given a file that only the user can read, and the file has the address.
class BrowserOpener {
 public:
  BrowserOpener() = default;
  ~BrowserOpener() {
    std::error_code ignored;
    if (!file_.empty()) std::filesystem::remove(file_, ignored);
  }
  BrowserOpener(const BrowserOpener&) = delete;
  BrowserOpener& operator=(const BrowserOpener&) = delete;

  /// Returns whether a browser was started.
  bool open(const std::string& address) {
    const bool has_display =
        std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
    if (!has_display || !write(address)) return false;
    std::string program = "xdg-open";
    char* const arguments[] = {program.data(), file_.data(), nullptr};
    pid_t process = 0;
    if (posix_spawnp(&process, program.c_str(), nullptr, nullptr, arguments, environ) != 0) {
      return false;
    }
    int status = 0;
    return waitpid(process, &status, 0) == process && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

 private:
  bool write(const std::string& address) {
    file_ = (std::filesystem::temp_directory_path() / "pellucid-XXXXXX.html").string();
    const int descriptor = mkstemps(file_.data(), 5);  // mode 0600
    if (descriptor < 0) {
      file_.clear();
      return false;
    }
    const std::string page = fmt::format(
        "<!doctype html><meta charset=\"utf-8\"><meta name=\"referrer\" content=\"no-referrer\">"
        "<meta http-equiv=\"refresh\" content=\"0; url={}\"><title>Pellucid</title>\n",
        address);
    const auto written = ::write(descriptor, page.data(), page.size());
    close(descriptor);
    return written == static_cast<ssize_t>(page.size());
  }

  std::string file_;
};

/// Reads the input of the arguments for the page. Throws Error.
view::ViewedScene viewed_scene(const RenderArguments& input) {
  std::optional<SceneDescription> asked;
  PreparedScene prepared =
      prepare(input, [&](const SceneRequest& request) { asked = request.prepared.description; });
  for (const std::string& note : prepared.import_notes) print_note(note);
  light_look(input, prepared);
  scene_to_json(prepared.description);  // throws what cannot be told to a page, as a name's bytes
  prepared.description.integration.relative_tolerance
      .reset();  // the page has a tolerance of its own
  const bool keeps_camera = prepared.has_own_camera || !input.camera.empty() || !input.view.empty();
  return {std::move(prepared.description), std::move(prepared.scene), keeps_camera,
          std::move(prepared.quick_layers), std::move(asked)};
}

int run_view(const ViewArguments& arguments) {
  const RenderArguments& input = arguments.scene;
  const bool has_input = !input.input.empty() || !input.channels.empty() || !input.layers.empty() ||
                         !input.labels.empty();
  std::optional<view::ViewedScene> scene;
  if (has_input) scene = viewed_scene(input);
  view::ViewerOptions options;
  options.port = static_cast<std::uint16_t>(arguments.port);
  options.ends_with_page = arguments.end_with_page;
  options.threads = input.threads;
  options.open = [&](const std::string& name) {
    RenderArguments opened = input;
    opened.input = name;
    opened.channels.clear();
    opened.layers.clear();
    opened.labels.clear();
    opened.label_tables.clear();
    return viewed_scene(opened);
  };
  const InterruptGuard guard;
  BrowserOpener browser;
  view::run_viewer(
      std::move(scene), options,
      [&](const std::string& address) {
        print_text(address + "\n");
        const bool opened = !arguments.no_open && browser.open(address);
        print_note(opened ? "the page is open in your browser; Ctrl-C ends"
                          : "open this address in a browser on this machine; Ctrl-C ends");
      },
      [] { return InterruptGuard::interrupted(); });
  return 0;
}

}  // namespace

Command add_view(CommandLine& app) {
  CommandLine& command = *app.add_subcommand(
      "view", "Turn and edit a volume, a mesh or a scene in the browser of this machine");
  const auto arguments = std::make_shared<ViewArguments>();
  arguments->scene.suggests_functions = true;
  command.add_option("INPUT", arguments->scene.input,
                     scene_input_help() + ". Without it the page asks for a file");
  command
      .add_option("--port", arguments->port,
                  "Serve the page at this port of the loopback interface. Default: any free one")
      ->option_text("N")
      ->in_range(0, 65535);
  command.add_flag("--no-open", arguments->no_open,
                   "Print the address only. Default: also open it in the browser");
  command.add_flag("--end-with-page", arguments->end_with_page,
                   "End when the last page is closed. Default: end by Ctrl-C");
  command.add_threads(arguments->scene.threads);
  add_scene_options(command, arguments->scene);
  arguments->scene.volume.add_to(command, false);
  arguments->scene.mesh.add_to(command, true);
  command.footer(
      "The address holds a random token. Whoever has it can see the data; keep it to yourself.\n"
      "\n"
      "Examples:\n"
      "  pellucid view\n"
      "  pellucid view brain.nii.gz\n"
      "  pellucid view scene.json --port 8080 --no-open\n"
      "  pellucid view head.nrrd --preset ct-bone --end-with-page\n"
      "  pellucid view --channel t1=T1.nii.gz --channel flair=FLAIR.nii.gz");
  return {&command, [arguments] { return run_view(*arguments); }};
}

}  // namespace pellucid::cli

// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/embed_scene.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include "arguments/overwriting.h"
#include "arguments/parse.h"
#include "commands.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"
#include "render/progress.h"
#include "render/render.h"

namespace pellucid::cli {

namespace {

struct ExportArguments {
  RenderArguments scene;
  std::string output, largest, crop;
  bool reduces = false, has_threads = false;
};

/// Reads "20M": a number of bytes, or of so many thousands of them.
double parse_byte_count(const std::string& option, const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
  const double factor = unit.empty() ? 1 : unit == "k" ? 1e3 : unit == "M" ? 1e6 : 1e9;
  if (error != std::errc{} || !(number > 0) || (factor == 1e9 && unit != "G")) {
    throw UsageError(
        fmt::format("{} '{}': expected a number of bytes, as 20M or 500k", option, text));
  }
  return number * factor;
}

void check(const ExportArguments& arguments) {
  if (arguments.output.empty()) {
    throw UsageError("nothing to write; give -o FILE.html (see 'pellucid export --help')");
  }
  if (extension_of(arguments.output) != ".html") {
    throw UsageError(fmt::format("-o {}: expected a name that ends in .html", arguments.output));
  }
  const RenderArguments& scene = arguments.scene;
  if (source_text(scene).empty()) {
    throw UsageError("no input; give INPUT, --channel or --labels (see 'pellucid export --help')");
  }
  const NamedFile outputs[] = {{"--output", arguments.output}};
  const NamedFile inputs[] = {{"INPUT", scene.input}, {"--tf", scene.transfer_function}};
  refuse_overwriting(outputs, inputs);
  check_writable(arguments.output);
}

/// Reads "10:60,0:100,5:25": values from the first number to the one before the second, along x, y,
/// z.
IndexBox parse_crop(const std::string& option, const std::string& text) {
  IndexBox box;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t a = 0; a < 3; ++a) {
    int last = 0;
    const auto number = [&](int& value, char behind) {
      const auto [rest, error] = std::from_chars(at, end, value);
      const bool is_good =
          error == std::errc{} && (behind == 0 ? rest == end : rest != end && *rest == behind);
      at = is_good && behind != 0 ? rest + 1 : rest;
      return is_good;
    };
    if (!number(box.first[a], ':') || !number(last, a < 2 ? ',' : '\0') || box.first[a] < 0 ||
        last - box.first[a] < 2) {
      throw UsageError(fmt::format(
          "{} '{}': expected X0:X1,Y0:Y1,Z0:Z1, of two values or more each", option, text));
    }
    box.count[a] = last - box.first[a];
  }
  return box;
}

int run_export(const ExportArguments& given) {
  check(given);
  ExportArguments arguments = given;
  if (!arguments.crop.empty()) arguments.scene.crop = parse_crop("--crop", arguments.crop);
  if (arguments.reduces && arguments.largest.empty()) {
    throw UsageError("--reduce: give --max-size, the size to reduce to");
  }
  const double largest =
      arguments.largest.empty() ? 0 : parse_byte_count("--max-size", arguments.largest);
  PreparedScene prepared = prepare(arguments.scene);
  const InterruptGuard guard;
  place_camera(arguments.scene, prepared);
  if (!arguments.scene.quiet) {
    for (const std::string& note : prepared.import_notes) print_note(note);
  }
  const PageThreads threads = arguments.has_threads ? PageThreads::where_allowed : PageThreads::one;
  const auto [page, note] =
      arguments.reduces
          ? reduced_page(prepared.description, prepared.scene, static_cast<std::uint64_t>(largest),
                         threads)
          : ReducedPage{page_of(embed_scene(prepared.description, prepared.scene), threads), ""};
  const double size = static_cast<double>(page.size());
  if (largest > 0 && size > largest) {
    throw Error(
        fmt::format("{}: not written: it would have {:.1f} MB, more than --max-size {}{}; "
                    "take a coarser --level or a part (--crop){}, or raise it",
                    arguments.output, size / 1e6, arguments.largest,
                    arguments.reduces ? ", also with the data reduced as far as they can be" : "",
                    arguments.reduces ? "" : ", or give --reduce"));
  }
  write_text_file(arguments.output, page);
  if (!arguments.scene.quiet) {
    if (!note.empty()) print_note(fmt::format("{}: {}", arguments.output, note));
    print_note(fmt::format("{}: {:.1f} MB; it opens in a browser without this program",
                           arguments.output, size / 1e6));
  }
  return 0;
}

}  // namespace

Command add_export(CommandLine& app) {
  CommandLine& command = *app.add_subcommand(
      "export", "Write a page that shows data in any browser, exact, by itself");
  const auto arguments = std::make_shared<ExportArguments>();
  arguments->scene.suggests_functions = true;
  command.add_option("INPUT", arguments->scene.input, scene_input_help());
  command
      .add_option("-o,--output", arguments->output,
                  "Write this page. It holds the data, the viewer and the renderer, and asks for "
                  "no other file")
      ->option_text("FILE.html");
  command
      .add_option("--crop", arguments->crop,
                  "Embed these values of INPUT alone, by their indices from 0, the last ones left "
                  "out; at their place")
      ->option_text("X0:X1,Y0:Y1,Z0:Z1");
  command
      .add_option("--max-size", arguments->largest,
                  "Write nothing if the page is larger: a number of bytes, or with k, M or G")
      ->option_text("SIZE");
  command.add_flag(
      "--reduce", arguments->reduces,
      "Make data coarser until the page has --max-size: half the resolution along each "
      "axis, again and again. The page tells");
  command.add_flag("--page-threads", arguments->has_threads,
                   "Write a larger page, which renders on all cores where its server sends "
                   "Cross-Origin-Opener-Policy and -Embedder-Policy, and on one thread elsewhere");
  command.add_threads(arguments->scene.threads);
  command.add_flag("-q,--quiet", arguments->scene.quiet, "Print no notes, only errors");
  add_scene_options(command, arguments->scene);
  arguments->scene.volume.add_to(command, false);
  arguments->scene.mesh.add_to(command, true);
  command.footer(
      "Whoever has the page has the data: what is embedded is the values as they are.\n"
      "\n"
      "Examples:\n"
      "  pellucid export brain.nii.gz -o brain.html\n"
      "  pellucid export scene.json -o scene.html --max-size 20M\n"
      "  pellucid export ct.nii.gz --max-size 20M --reduce -o ct.html\n"
      "  pellucid export cells.zarr --level 2 -o cells.html\n"
      "  pellucid export head.nrrd --crop 60:200,40:220,0:120 -o skull.html");
  return {&command, [arguments] { return run_export(*arguments); }};
}

}  // namespace pellucid::cli

// SPDX-License-Identifier: Apache-2.0

// Scenes × cameras × tolerances × grades against the reference. Fails where a pixel is over.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "benchmarks/frames/matrix_report.h"
#include "benchmarks/support/document.h"
#include "benchmarks/support/environment.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"

namespace {

using namespace pellucid;

struct Arguments {
  scenes::MatrixOptions matrix;
  bool quick = false;
  std::vector<std::string> parts;  ///< of scenes' names; none: all
  std::string pictures, markdown, section = "matrix", json, commit;
};

/// What the reference sees, over black.
void write_picture(const scenes::ReferenceFrame& frame, const std::filesystem::path& file) {
  Image image;
  image.width = frame.width;
  image.height = frame.height;
  for (const auto& p : frame.pixels) {
    image.pixels.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]),
                            static_cast<float>(p[2]), static_cast<float>(p[3])});
  }
  write_png(image, file, Rgb<double>{0, 0, 0});
}

void write_pictures(const scenes::GalleryEntry& entry, const Arguments& arguments) {
  const int size = arguments.matrix.size;
  const scenes::Exhibit exhibit = entry.make(size);
  for (std::size_t c = 0; c < exhibit.cameras.size(); ++c) {
    const scenes::ReferenceFrame frame = scenes::cached_reference_frame(
        scenes::scene_of(exhibit, c, size), arguments.matrix.threads, arguments.matrix.cache);
    write_picture(frame, std::filesystem::path(arguments.pictures) /
                             (entry.name + ", " + exhibit.cameras[c].name + ".png"));
  }
}

bool is_wanted(const std::string& name, const std::vector<std::string>& parts) {
  return parts.empty() || std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
           return name.find(part) != std::string::npos;
         });
}

std::vector<scenes::MatrixRow> measure(const Arguments& arguments,
                                       std::vector<std::string>& missing) {
  std::vector<scenes::MatrixRow> rows;
  for (const scenes::GalleryEntry& entry : scenes::gallery()) {
    if (!is_wanted(entry.name, arguments.parts)) continue;
    if (!entry.file.empty() && !std::filesystem::exists(entry.file)) {
      missing.push_back(entry.name + " (" + entry.file.filename().string() + ")");
      continue;
    }
    if (!arguments.pictures.empty()) {
      write_pictures(entry, arguments);
      continue;
    }
    const scenes::Exhibit exhibit = entry.make(arguments.matrix.size);
    scenes::MatrixOptions matrix = arguments.matrix;
    matrix.least_proved = entry.least_proved;
    for (std::size_t c = 0; c < exhibit.cameras.size(); ++c) {
      std::fprintf(stderr, "%s, %s\n", entry.name.c_str(), exhibit.cameras[c].name.c_str());
      rows.push_back(scenes::measure_row(entry.name, exhibit, c, matrix));
      std::fprintf(stderr, "%s", bench::violations({rows.back()}).c_str());
    }
  }
  return rows;
}

/// Whether every pixel kept its promises.
bool run(Arguments arguments) {
  using namespace pellucid::bench;
  if (arguments.quick) {
    arguments.matrix.size = 16;
    arguments.matrix.tolerances.assign(std::begin(scenes::quick_tolerances),
                                       std::end(scenes::quick_tolerances));
  }
  if (arguments.matrix.threads == 0) {
    arguments.matrix.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  }
  if (!arguments.pictures.empty()) std::filesystem::create_directories(arguments.pictures);
  std::vector<std::string> missing;
  const std::vector<scenes::MatrixRow> rows = measure(arguments, missing);
  for (const std::string& name : missing) {
    std::fprintf(stderr, "left out, for the file is not there: %s\n", name.c_str());
  }
  if (!arguments.pictures.empty()) return true;
  if (rows.empty()) throw std::runtime_error("no scene has a name like that");

  const Environment where = environment(arguments.commit);
  std::string text = to_markdown(where) + "\n";
  for (const std::string& name : missing) text += "Left out, for want of data: " + name + ".\n\n";
  text += format("Frames of %d×%d. ", arguments.matrix.size, arguments.matrix.size) +
          matrix_markdown(rows);
  if (arguments.markdown.empty()) {
    std::printf("%s", text.c_str());
  } else {
    replace_section(arguments.markdown, arguments.section, "\n" + text + "\n");
  }
  if (!arguments.json.empty()) {
    const nlohmann::ordered_json json{{"environment", to_json(where)},
                                      {"size", arguments.matrix.size},
                                      {"views", matrix_json(rows)}};
    write_text_file(arguments.json, json.dump(1) + "\n");
  }
  const MatrixTotal total = matrix_total(rows);
  std::fprintf(stderr, "%zu frames, %zu pixels: %zu over the tolerance, %zu over their report\n",
               total.frames, total.pixels, total.over, total.over_reported);
  return total.kept();
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  arguments.matrix.threads = 0;
  CLI::App app("Every pixel within its tolerance: scenes x cameras x tolerances x grades");
  app.add_option("--size", arguments.matrix.size, "width and height of the frames")
      ->capture_default_str()
      ->check(CLI::Range(4, 4096));
  app.add_flag("--quick", arguments.quick, "frames of 16 x 16 to three tolerances");
  app.add_option("--tolerances", arguments.matrix.tolerances, "those asked for")->delimiter(',');
  app.add_option("--scenes", arguments.parts, "only those whose name contains one of these");
  app.add_option("--threads", arguments.matrix.threads, "0: one per core")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--device", arguments.matrix.device, "cpu, cuda, or emulated: a card's functions")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Device>{
          {"cpu", Device::cpu}, {"cuda", Device::cuda}, {"emulated", Device::emulated}}));
  app.add_option("--cache", arguments.matrix.cache, "folder that keeps reference frames");
  app.add_option("--markdown", arguments.markdown, "file to put the tables into; default: print")
      ->check(CLI::ExistingFile);
  app.add_option("--section", arguments.section, "section of that file")->capture_default_str();
  app.add_option("--json", arguments.json, "file for all figures");
  app.add_option("--commit", arguments.commit, "commit to name in the tables");
  app.add_option("--pictures", arguments.pictures,
                 "only write what the reference sees, as PNG, into this folder");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(std::move(arguments)) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tolerance_matrix: %s\n", error.what());
    return 2;
  }
}

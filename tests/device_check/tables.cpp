// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <sstream>

#include "benchmarks/support/document.h"
#include "benchmarks/support/environment.h"
#include "pellucid/io/internal/atomic_file.h"
#include "tests/device_check/kernel_table.h"
#include "tests/device_check/parts.h"
#include "tests/device_check/rows.h"

namespace pellucid::device_check {
namespace {

/// A part, as the script tells of it.
struct Part {
  std::string name, state, seconds, limit, what, remark;
  std::vector<Json> rows;
};

std::vector<Part> read_parts(const std::filesystem::path& folder) {
  std::vector<Part> parts;
  std::istringstream stream(read_text_file(folder / "parts"));
  for (std::string line; std::getline(stream, line);) {
    Part part;
    std::istringstream fields(line);
    for (std::string* const field :
         {&part.name, &part.state, &part.seconds, &part.limit, &part.what, &part.remark}) {
      std::getline(fields, *field, '\t');
    }
    part.rows = read_rows(folder / (part.name + ".rows"));
    parts.push_back(std::move(part));
  }
  return parts;
}

std::vector<Json> rows_of(const std::vector<Part>& parts, const std::string& kind) {
  std::vector<Json> rows;
  for (const Part& part : parts) {
    for (const Json& row : part.rows) {
      if (row.value("kind", "") == kind) rows.push_back(row);
    }
  }
  return rows;
}

/// As a cell of a table: no line ends and bars.
std::string cell(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  for (std::size_t at = 0; (at = text.find('|', at)) != text.npos; at += 2) text.insert(at, "\\");
  return text;
}

std::string list_of(const Json& names) {
  std::string text;
  for (const std::string name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string parts_table(const std::vector<Part>& parts) {
  std::string text = "| part | what | state | seconds | remark |\n|---|---|---|---|---|\n";
  for (const Part& part : parts) {
    const bool good = part.state == "passed";
    text += "| " + part.name + " | " + cell(part.what) + " | " +
            (good ? part.state : "**" + part.state + "**") + " | " + part.seconds + " | " +
            cell(part.remark) + " |\n";
  }
  return text;
}

struct MatrixSum {
  std::set<std::string> scenes, scenes_on_cpu;
  std::uint64_t views = 0, frames = 0, pixels = 0, in_double = 0, left = 0;
  std::uint64_t over = 0, over_reported = 0, bad_views = 0;
};

MatrixSum sum_of(const std::vector<Json>& views) {
  MatrixSum sum;
  for (const Json& view : views) {
    const auto add = [&](std::uint64_t& total, const char* name) {
      total += view.at(name).get<std::uint64_t>();
    };
    (view.at("on_device").get<bool>() ? sum.scenes : sum.scenes_on_cpu).insert(view.at("scene"));
    if (view.at("on_device").get<bool>()) ++sum.views;
    add(sum.frames, "frames");
    add(sum.pixels, "pixels");
    add(sum.in_double, "in_double");
    add(sum.left, "left");
    add(sum.over, "over");
    add(sum.over_reported, "over_reported");
    if (!view.at("faults").empty()) ++sum.bad_views;
  }
  return sum;
}

std::string matrix_section(const std::vector<Part>& parts) {
  const std::vector<Json> views = rows_of(parts, "view");
  if (views.empty()) return "";
  const MatrixSum sum = sum_of(views);
  std::string text = "\n## Scenes against the truth\n\n| | |\n|---|---|\n";
  const auto add = [&](const char* name, std::uint64_t number) {
    text += std::string("| ") + name + " | " + std::to_string(number) + " |\n";
  };
  add("scenes that the device followed", sum.scenes.size());
  add("views of them", sum.views);
  add("frames", sum.frames);
  add("pixels, in all frames", sum.pixels);
  add("over the tolerance without saying so", sum.over);
  add("over the error that they report", sum.over_reported);
  add("followed again in binary64", sum.in_double);
  add("left to the CPU", sum.left);
  add("views with a fault", sum.bad_views);
  add("scenes that go to the CPU, and say so", sum.scenes_on_cpu.size());
  for (const Json& row : rows_of(parts, "matrix")) {
    if (!row.at("missing").empty()) {
      text += "\nLeft out, for want of data: " + list_of(row.at("missing")) + ".\n";
    }
  }
  for (const Json& row : rows_of(parts, "truths")) {
    text += "\nOf the truth, " + std::to_string(row.at("carried").get<std::size_t>()) +
            " frames were carried along and " + std::to_string(row.at("made").get<std::size_t>()) +
            " were made there.\n";
  }
  if (sum.bad_views == 0) return text;
  constexpr int most = 40;
  int shown = 0;
  text += "\n| scene | fault |\n|---|---|\n";
  for (const Json& view : views) {
    for (const std::string fault : view.at("faults")) {
      if (++shown > most) continue;
      text += "| " + cell(view.at("scene")) + " | " + cell(fault) + " |\n";
    }
  }
  if (shown > most) text += bench::format("| and %d more | |\n", shown - most);
  return text;
}

std::string frames_section(const std::vector<Part>& parts) {
  struct Runs {
    std::string again = "–", first_run = "–";
  };
  std::map<std::string, Runs> scenes;
  const auto word = [](const Json& row, const char* name, std::string& target) {
    // What one of the runs found different stays so.
    if (!row.contains(name) || target == "**different**") return;
    target = row.at(name).get<bool>() ? "same" : "**different**";
  };
  for (const Json& row : rows_of(parts, "frame")) {
    Runs& runs = scenes[row.at("scene")];
    word(row, "same_again", runs.again);
    word(row, "same_as_first_run", runs.first_run);
  }
  if (scenes.empty()) return "";
  std::string text =
      "\n## Two runs\n\nBits of color, depth, error and grade.\n\n| frame | again in one process | "
      "in another process |\n|---|---|---|\n";
  for (const auto& [name, runs] : scenes) {
    text += "| " + cell(name) + " | " + runs.again + " | " + runs.first_run + " |\n";
  }
  return text;
}

/// The last of what each scene's measurement told.
std::vector<bench::Speed> speeds_of(const std::vector<Part>& parts) {
  std::vector<bench::Speed> speeds;
  for (const Json& row : rows_of(parts, "speed")) {
    bench::Speed speed = bench::speed_from_json(row);
    const auto same = std::ranges::find(speeds, speed.scene, &bench::Speed::scene);
    if (same == speeds.end()) {
      speeds.push_back(std::move(speed));
    } else {
      *same = std::move(speed);
    }
  }
  return speeds;
}

std::string speed_section(const std::vector<Part>& parts) {
  const std::vector<bench::Speed> speeds = speeds_of(parts);
  if (speeds.empty()) return "";
  std::string text = "\n## Frames per second\n\n";
  for (const Json& row : rows_of(parts, "data")) {
    const int points = row.at("points"), size = row.at("size");
    text += bench::format(
        "Data %d³, images %d × %d; errors: the largest over some pixels of the first "
        "frame. A dash: not measured.\n\n",
        points, size, size);
    break;
  }
  return text + bench::speed_markdown(speeds);
}

std::string kernel_section(const std::vector<Json>& kernels) {
  if (kernels.empty()) return "";
  std::string text =
      "\n## Kernels\n\nBy Nsight Compute: of each kernel, the launch that took longest.\n";
  for (const Json& kernel : kernels) {
    text += "\n- `" + kernel.at("kernel").get<std::string>() +
            "`, launches: " + std::to_string(kernel.at("launches").get<int>());
    for (const auto& [name, value] : kernel.items()) {
      if (name == "kernel" || name == "launches") continue;
      text += "\n  - " + name + ": " + value.get<std::string>();
    }
  }
  return text + "\n";
}

std::string devices_of(const std::vector<Part>& parts) {
  std::string text;
  for (const Json& row : rows_of(parts, "device")) text = row.at("name");
  return text.empty() ? "unknown" : text;
}

/// The text of a small file, in one line; empty if there is none.
std::string line_of(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return "";
  std::string text = read_text_file(file);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return cell(text);
}

}  // namespace

void write_tables(const std::filesystem::path& folder, const std::filesystem::path& json,
                  const std::filesystem::path& markdown, const std::string& commit) {
  const std::vector<Part> parts = read_parts(folder);
  const bench::Environment where = bench::environment(commit);
  const std::string device = devices_of(parts), driver = line_of(folder / "driver");
  std::vector<Json> kernels;
  if (const auto csv = folder / "kernels.csv"; std::filesystem::exists(csv)) {
    kernels = kernels_of(read_text_file(csv));
  }

  Json list = Json::array();
  for (const Part& part : parts) {
    list.push_back({{"name", part.name},
                    {"what", part.what},
                    {"state", part.state},
                    {"seconds", part.seconds},
                    {"limit", part.limit},
                    {"remark", part.remark},
                    {"rows", part.rows}});
  }
  const Json all{{"environment", bench::to_json(where)},
                 {"device", device},
                 {"driver", driver},
                 {"parts", list},
                 {"kernels", kernels}};
  write_text_file(json, all.dump(1) + "\n");

  std::string text = "# Device check: " + device + "\n\n" + bench::to_markdown(where);
  if (!driver.empty()) text += "\nThe driver says: " + driver + ".\n";
  text += "\n" + parts_table(parts) + matrix_section(parts) + frames_section(parts) +
          speed_section(parts) + kernel_section(kernels);
  write_text_file(markdown, text);
}

}  // namespace pellucid::device_check

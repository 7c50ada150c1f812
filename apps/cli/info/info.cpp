// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arguments/input.h"
#include "arguments/labels.h"
#include "arguments/mesh_input.h"
#include "arguments/output.h"
#include "commands.h"
#include "info_arrays.h"
#include "info_levels.h"
#include "info_mesh.h"
#include "info_numbers.h"
#include "info_series.h"
#include "orientation.h"
#include "pellucid/base/version.h"
#include "pellucid/io/dicom_series.h"
#include "pellucid/io/time_steps.h"
#include "pellucid/scene/labels.h"

namespace pellucid::cli {

namespace {

struct InfoArguments {
  std::string input;
  VolumeOptions volume;
  MeshOptions mesh;
  bool json = false;
};

/// Facts of a file, gathered once for the text and for the JSON.
struct Facts {
  std::size_t bytes = 0;     ///< bytes of all components
  std::vector<double> mean;  ///< of the finite values of each
  Vec3<double> world_lower, world_upper;
  std::string space;  ///< of the world, as the file names it
  bool anatomical = false;
  Orientation orientation;
  std::string unit;                                ///< of the values; empty: the file names none
  std::vector<std::optional<std::size_t>> labels;  ///< label_count of each component
  std::vector<double> times;                       ///< times of the steps; empty: there are none
};

double mean_of(const Volume& volume) {
  // Scaled before it is summed, so that finite values have a finite mean.
  const double count = static_cast<double>(volume.statistics().finite);
  double sum = 0;
  std::visit(
      [&](const auto& values) {
        for (const auto value : values) {
          const double x = static_cast<double>(value);
          if (std::isfinite(x)) sum += x / count;
        }
      },
      volume.data());
  return sum;
}

Facts facts_of(const std::vector<Volume>& components, const FieldSource& source) {
  Facts facts;
  for (const Volume& component : components) {
    facts.bytes += std::visit([](const auto& values) { return values.size() * sizeof(values[0]); },
                              component.data());
    facts.mean.push_back(mean_of(component));
    facts.labels.push_back(source.builtin.empty() ? label_count(component) : std::nullopt);
  }
  const Volume& volume = components.front();
  const auto corners = volume.world_corners();
  facts.world_lower = facts.world_upper = corners[0];
  for (const Vec3<double>& corner : corners) {
    for (int axis = 0; axis < 3; ++axis) {
      facts.world_lower[axis] = std::min(facts.world_lower[axis], corner[axis]);
      facts.world_upper[axis] = std::max(facts.world_upper[axis], corner[axis]);
    }
  }
  facts.times = source_times(source);
  if (source.builtin.empty()) facts.space = world_space(source.file, source.options);
  facts.anatomical = facts.space == "LPS";
  if (facts.anatomical) {
    facts.orientation = anatomical_orientation(volume.description().placement.direction);
  }
  if (source.builtin.empty() && is_dicom(source.file)) {
    facts.unit = dicom_unit(source.file, source.options.series);
  }
  return facts;
}

bool is_rectilinear(const Volume& volume) {
  const auto& coordinates = volume.description().coordinates;
  return std::any_of(coordinates.begin(), coordinates.end(),
                     [](const auto& axis) { return !axis.empty(); });
}

std::string readable_bytes(std::size_t bytes) {
  constexpr const char* units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  double amount = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (amount >= 1024 && unit + 1 < std::size(units)) {
    amount /= 1024;
    ++unit;
  }
  return unit == 0 ? fmt::format("{} B", bytes) : fmt::format("{:.1f} {}", amount, units[unit]);
}

/// Bars as long as log(1 + count): a rare material shows beside a thousand times as much air.
std::string bar_chart(const Histogram& histogram) {
  constexpr double longest_bar = 48;
  std::uint64_t most = 1;
  for (const std::uint64_t count : histogram.count) most = std::max(most, count);
  const double bins = static_cast<double>(histogram.count.size());
  const double bin_width = (histogram.upper - histogram.lower) / bins;
  std::string chart;
  for (std::size_t bin = 0; bin < histogram.count.size(); ++bin) {
    const std::uint64_t count = histogram.count[bin];
    const double share =
        std::log1p(static_cast<double>(count)) / std::log1p(static_cast<double>(most));
    const auto bar = static_cast<std::size_t>(std::ceil(share * longest_bar));
    const double begin = histogram.lower + static_cast<double>(bin) * bin_width;
    chart += count == 0
                 ? fmt::format("  {:>12} {:>12}\n", number(begin), count)
                 : fmt::format("  {:>12} {:>12} {}\n", number(begin), count, std::string(bar, '#'));
  }
  return chart;
}

/// Returns "3 (0, 0.5, 1)", or of many "100, from 0 to 49.5".
std::string times_text(const std::vector<double>& times) {
  constexpr std::size_t most = 12;
  if (times.size() > most) {
    return fmt::format("{}, from {} to {}", times.size(), number(times.front()),
                       number(times.back()));
  }
  std::string list;
  for (const double time : times) list += (list.empty() ? "" : ", ") + number(time);
  return fmt::format("{} ({})", times.size(), list);
}

std::string range_text(const VolumeStatistics& statistics) {
  return statistics.finite == 0
             ? "no finite value"
             : fmt::format("{} to {}", number(statistics.minimum), number(statistics.maximum));
}

std::string nan_text(const VolumeStatistics& statistics) {
  return fmt::format("{}{}", statistics.nan, statistics.nan > 0 ? " (rendered as vacuum)" : "");
}

std::string text_report(const std::vector<Volume>& components, const Facts& facts,
                        const std::string& name) {
  const Volume& volume = components.front();
  const auto& d = volume.description();
  const auto& placement = d.placement;
  std::string text;
  const auto line = [&](std::string_view label, const std::string& value) {
    text += fmt::format("{:<12} {}\n", label, value);
  };
  line("name", name);
  line("dimensions",
       fmt::format("{} x {} x {}", d.dimensions[0], d.dimensions[1], d.dimensions[2]));
  line("type", fmt::format("{}, {}", type_name(volume.data()), readable_bytes(facts.bytes)));
  line("centering", d.centering == Centering::point ? "point" : "cell");
  line("grid", is_rectilinear(volume) ? "rectilinear" : "uniform");
  line("spacing", triple(placement.spacing));
  line("origin", triple(placement.origin));
  line("x axis", triple(placement.direction.column[0]));
  line("y axis", triple(placement.direction.column[1]));
  line("z axis", triple(placement.direction.column[2]));
  if (facts.anatomical) {
    line("orientation",
         facts.orientation.code +
             (facts.orientation.oblique_by > 0.01
                  ? fmt::format(", oblique by {:.2f} degrees", facts.orientation.oblique_by)
                  : "") +
             " (directions of growing indices; the world is LPS)");
  } else if (!facts.space.empty()) {
    line("space", facts.space + " (the file's name for it, which is no patient's)");
  }
  line("world box", fmt::format("{} to {}", triple(facts.world_lower), triple(facts.world_upper)));
  if (!facts.times.empty()) line("times", times_text(facts.times));
  if (components.size() > 1) {
    line("components", std::to_string(components.size()));
    for (std::size_t c = 0; c < components.size(); ++c) {
      const VolumeStatistics& statistics = components[c].statistics();
      std::string about = range_text(statistics);
      if (statistics.finite > 0) about += ", mean " + number(facts.mean[c]);
      if (statistics.nan > 0) about += ", NaN " + nan_text(statistics);
      if (facts.labels[c]) about += ", " + labels_text(*facts.labels[c]);
      line(fmt::format("component {}", c), about);
    }
    return text;
  }
  const VolumeStatistics& statistics = volume.statistics();
  line("range", range_text(statistics));
  if (!facts.unit.empty()) line("unit", facts.unit);
  if (statistics.finite > 0) line("mean", number(facts.mean.front()));
  line("NaN", nan_text(statistics));
  if (facts.labels.front()) line("labels", labels_text(*facts.labels.front()));
  if (statistics.finite > 0) {
    text +=
        "histogram    lower end of each bin, number of values, bar on a logarithmic scale\n"
        "";
    text += bar_chart(volume.histogram(24));
  }
  return text;
}

/// Returns the facts of each component.
Json values_json(const Volume& volume, double mean, const std::optional<std::size_t>& labels) {
  const auto& statistics = volume.statistics();
  const bool any = statistics.finite > 0;
  Json json;
  json["range"] = any ? Json{statistics.minimum, statistics.maximum} : Json();
  json["mean"] = any ? Json(mean) : Json();
  json["nan"] = statistics.nan;
  json["labels"] = labels ? Json(*labels) : Json();
  if (any) {
    const Histogram histogram = volume.histogram(256);
    json["histogram"] = {
        {"lower", histogram.lower}, {"upper", histogram.upper}, {"count", histogram.count}};
  } else {
    json["histogram"] = Json();
  }
  return json;
}

Json json_report(const std::vector<Volume>& components, const Facts& facts, const std::string& name,
                 const std::string& input) {
  const Volume& volume = components.front();
  const auto& d = volume.description();
  Json json;
  json["pellucid"] = PELLUCID_VERSION_STRING;
  json["input"] = input;
  json["name"] = name;
  json["dimensions"] = dimensions_json(volume);
  json["type"] = type_name(volume.data());
  json["bytes"] = facts.bytes;
  json["centering"] = d.centering == Centering::point ? "point" : "cell";
  json["grid"] = is_rectilinear(volume) ? "rectilinear" : "uniform";
  json["spacing"] = to_json(d.placement.spacing);
  json["origin"] = to_json(d.placement.origin);
  json["direction"] = {to_json(d.placement.direction.column[0]),
                       to_json(d.placement.direction.column[1]),
                       to_json(d.placement.direction.column[2])};
  json["orientation"] = facts.anatomical ? Json(facts.orientation.code) : Json();
  json["oblique_degrees"] = facts.anatomical ? Json(facts.orientation.oblique_by) : Json();
  json["space"] = facts.space.empty() ? Json() : Json(facts.space);
  json["world_box"] = {to_json(facts.world_lower), to_json(facts.world_upper)};
  json["unit"] = facts.unit.empty() ? Json() : Json(facts.unit);
  json["times"] = facts.times;
  if (components.size() == 1) {
    json.update(values_json(volume, facts.mean.front(), facts.labels.front()));
    return json;
  }
  json["components"] = Json::array();
  for (std::size_t c = 0; c < components.size(); ++c) {
    json["components"].push_back(values_json(components[c], facts.mean[c], facts.labels[c]));
  }
  return json;
}

/// Chooses the array that the list marks, if its name is that of no other: a file of several arrays
/// may have none that is read by default.
void choose_shown(const std::vector<VolumeArray>& arrays, ReadOptions& options) {
  const auto shown = std::ranges::find_if(arrays, &VolumeArray::is_default);
  if (options.array || shown == arrays.end()) return;
  if (std::ranges::count(arrays, shown->name, &VolumeArray::name) == 1) options.array = shown->name;
}

int run_info(const InfoArguments& arguments) {
  if (is_mesh(arguments.input, arguments.mesh)) {
    arguments.volume.refuse("a mesh");
    print_mesh_info(mesh_source(arguments.input, arguments.mesh), arguments.json);
    return 0;
  }
  FieldSource source = field_source(arguments.input, arguments.volume);
  if (!source.builtin.empty()) arguments.mesh.refuse("a built-in field");
  arguments.mesh.refuse_q("a volume");
  arguments.mesh.set_time(source.options);
  if (print_series(source, arguments.input, arguments.json)) return 0;
  set_notes(source, false);
  std::vector<Volume> components;
  std::vector<VolumeArray> arrays;
  std::optional<Pyramid> pyramid;
  std::string chosen;
  if (source.builtin.empty()) {
    pyramid = describe_pyramid(source.file, source.options);
    arrays = list_arrays(source.file, source.options);
    choose_shown(arrays, source.options);
    NamedComponents read = read_named_components(source.file, source.options);
    components = std::move(read.components);
    chosen = read.array;
  } else {
    components.push_back(load_field(source));
  }
  const Facts facts = facts_of(components, source);
  // Several share the file's name.
  const std::string name =
      components.size() > 1 ? source.file.string() : components.front().description().name;
  if (arguments.json) {
    Json json = json_report(components, facts, name, arguments.input);
    if (!arrays.empty()) {
      json["array"] = chosen;
      json["arrays"] = arrays_json(arrays);
    }
    if (pyramid) json["pyramid"] = pyramid_json(*pyramid);
    print_json(json);
  } else {
    print_text(text_report(components, facts, name) + (pyramid ? pyramid_text(*pyramid) : "") +
               arrays_text(arrays, chosen));
  }
  return 0;
}

}  // namespace

Command add_info(CommandLine& app) {
  CommandLine& command = *app.add_subcommand("info", "Print what is in a volume or mesh file");
  const auto arguments = std::make_shared<InfoArguments>();
  command
      .add_option("INPUT", arguments->input,
                  input_help() + ", " + mesh_input_help() + " or builtin:NAME[:POINTS]")
      ->required();
  command.add_flag("--json", arguments->json,
                   "Print the same as JSON, with a histogram of 256 bins");
  arguments->volume.add_to(command);
  arguments->mesh.add_to(command, false);
  command.footer(
      "Examples:\n"
      "  pellucid info brain.nii.gz\n"
      "  pellucid info male.raw --dimensions 128,256,256 --type u8 --spacing 1.57,0.99,0.99\n"
      "  pellucid info disk_out_ref.ex2\n"
      "  pellucid info builtin:hydrogen:64 --json");
  return {&command, [arguments] { return run_info(*arguments); }};
}

}  // namespace pellucid::cli

// SPDX-License-Identifier: Apache-2.0
#include "info_series.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <vector>

#include "arguments/output.h"
#include "pellucid/base/version.h"
#include "pellucid/io/dicom_series.h"
#include "pellucid/io/time_steps.h"
#include "pellucid/scene/error.h"

namespace pellucid::cli {

namespace {

/// Returns the times of volumes that are steps; empty: the series are something else.
std::vector<double> times_of(const FieldSource& source) {
  try {
    return source_times(source);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

bool print_series(const FieldSource& source, const std::string& input, bool as_json) {
  if (source.options.series || source.options.time || !std::filesystem::is_directory(source.file) ||
      !is_dicom(source.file)) {
    return false;
  }
  std::vector<std::string> notes;
  const std::vector<DicomSeries> all =
      list_dicom_series(source.file, [&](const std::string& note) { notes.push_back(note); });
  if (all.size() < 2) return false;
  for (const std::string& note : notes) print_note(note);
  const std::vector<double> times = times_of(source);
  Json json;
  json["pellucid"] = PELLUCID_VERSION_STRING;
  json["input"] = input;
  json["times"] = times;
  json["series"] = Json::array();
  std::string text = fmt::format("{:<12} {}\n{:<12} {}; choose one by --series{}\n", "name", input,
                                 "DICOM series", all.size(), times.empty() ? "" : " or by --time");
  if (!times.empty()) text += fmt::format("{:<12} {}\n", "times", fmt::join(times, ", "));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const DicomSeries& s = all[i];
    json["series"].push_back(
        {{"number", i + 1},
         {"uid", s.uid},
         {"description", s.description},
         {"modality", s.modality},
         {"slices", s.slices},
         {"size", {s.columns, s.rows}},
         {"refused", s.unreadable_reason.empty() ? Json() : Json(s.unreadable_reason)}});
    text +=
        fmt::format("{:>12} {}, {}, {} x {} x {}, UID {}{}\n", i + 1,
                    s.description.empty() ? "no description" : s.description,
                    s.modality.empty() ? "no modality" : s.modality, s.columns, s.rows, s.slices,
                    s.uid, s.unreadable_reason.empty() ? "" : ", not read: " + s.unreadable_reason);
  }
  if (as_json) {
    print_json(json);
  } else {
    print_text(text);
  }
  return true;
}

}  // namespace pellucid::cli

// SPDX-License-Identifier: Apache-2.0
#include "info_series.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "arguments/output.h"
#include "pellucid/base/version.h"
#include "pellucid/io/dicom_series.h"

namespace pellucid::cli {

bool print_series(const FieldSource& source, const std::string& input, bool as_json) {
  if (source.options.series || !std::filesystem::is_directory(source.file) ||
      !is_dicom(source.file)) {
    return false;
  }
  std::vector<std::string> notes;
  const std::vector<DicomSeries> all =
      list_dicom_series(source.file, [&](const std::string& note) { notes.push_back(note); });
  if (all.size() < 2) return false;
  for (const std::string& note : notes) print_note(note);
  Json json;
  json["pellucid"] = PELLUCID_VERSION_STRING;
  json["input"] = input;
  json["series"] = Json::array();
  std::string text = fmt::format("{:<12} {}\n{:<12} {}; choose one by --series\n", "name", input,
                                 "DICOM series", all.size());
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

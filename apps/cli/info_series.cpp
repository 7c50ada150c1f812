// SPDX-License-Identifier: Apache-2.0
#include "info_series.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "output.h"
#include "pellucid/base/version.h"
#include "pellucid/io/dicom_series.h"

namespace pellucid::cli {

bool print_series(const FieldSource& source, const std::string& input, bool as_json) {
  if (source.options.series || !std::filesystem::is_directory(source.file) ||
      !is_dicom(source.file)) {
    return false;
  }
  const std::vector<DicomSeries> all = list_dicom_series(source.file);
  if (all.size() < 2) return false;
  Json json;
  json["pellucid"] = PELLUCID_VERSION_STRING;
  json["input"] = input;
  json["series"] = Json::array();
  std::string text = fmt::format("{:<12} {}\n{:<12} {}; choose one by --series\n", "name", input,
                                 "DICOM series", all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const DicomSeries& s = all[i];
    json["series"].push_back({{"number", i + 1},
                              {"uid", s.uid},
                              {"description", s.description},
                              {"modality", s.modality},
                              {"slices", s.slices},
                              {"size", {s.columns, s.rows}},
                              {"refused", s.refused.empty() ? Json() : Json(s.refused)}});
    text += fmt::format("{:>12} {}, {}, {} x {} x {}, UID {}{}\n", i + 1,
                        s.description.empty() ? "no description" : s.description,
                        s.modality.empty() ? "no modality" : s.modality, s.columns, s.rows,
                        s.slices, s.uid, s.refused.empty() ? "" : ", not read: " + s.refused);
  }
  if (as_json) {
    print_json(json);
  } else {
    print_text(text);
  }
  return true;
}

}  // namespace pellucid::cli

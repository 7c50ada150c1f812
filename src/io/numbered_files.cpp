// SPDX-License-Identifier: Apache-2.0
#include "numbered_files.h"

#include <algorithm>
#include <cstdint>
#include <system_error>
#include <utility>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view digits = "0123456789";
constexpr std::size_t most_digits = 15;

std::int64_t number_of(const fs::path& file) {
  const std::optional<NumberedName> name = numbered_name(file.filename().string());
  return name ? std::stoll(name->digits) : -1;
}

}  // namespace

std::optional<NumberedName> numbered_name(const std::string& name) {
  const std::size_t stem = std::min(name.rfind('.'), name.size());
  const std::size_t last = stem == 0 ? std::string::npos : name.find_last_of(digits, stem - 1);
  if (last == std::string::npos) return std::nullopt;
  const std::size_t around = name.find_last_not_of(digits, last);
  const std::size_t begin = around == std::string::npos ? 0 : around + 1;
  if (last + 1 - begin > most_digits) return std::nullopt;
  return NumberedName{name.substr(0, begin), name.substr(begin, last + 1 - begin),
                      name.substr(last + 1)};
}

std::vector<fs::path> in_order(const std::vector<fs::path>& files, const std::string& name) {
  std::vector<std::pair<std::int64_t, fs::path>> numbered;
  numbered.reserve(files.size());
  for (const fs::path& file : files) numbered.emplace_back(number_of(file), file);
  std::ranges::sort(numbered);
  std::vector<fs::path> ordered;
  ordered.reserve(files.size());
  for (const auto& [number, file] : numbered) ordered.push_back(file);
  std::int64_t step = 0;  // the least: what is missing makes a larger one
  for (std::size_t i = 1; i < numbered.size(); ++i) {
    const std::int64_t gap = numbered[i].first - numbered[i - 1].first;
    step = i == 1 ? gap : std::min(step, gap);
  }
  for (std::size_t i = 1; i < numbered.size(); ++i) {
    const std::int64_t gap = numbered[i].first - numbered[i - 1].first;
    if (gap == step && gap > 0) continue;
    throw Error(name + ": the numbers of its images go up by " + std::to_string(gap) + " from " +
                ordered[i - 1].filename().string() + " to " + ordered[i].filename().string() +
                (gap == 0 ? "" : ", but elsewhere by " + std::to_string(step)) +
                "; one is missing or too many");
  }
  return ordered;
}

bool NamePattern::matches(const std::string& name) const {
  if (name.size() <= before.size() + behind.size() || !name.starts_with(before) ||
      !name.ends_with(behind)) {
    return false;
  }
  std::string number = name.substr(before.size(), name.size() - before.size() - behind.size());
  if (number.size() < width) return false;
  const std::size_t begin =
      std::min(number.find_first_not_of(zeros ? '0' : ' '), number.size() - 1);
  // Only so far as the width asks for is a number filled up.
  if (begin > 0 && number.size() > width) return false;
  number.erase(0, begin);
  return number.size() <= most_digits && (number == "0" || !number.starts_with('0')) &&
         number.find_first_not_of(digits) == std::string::npos;
}

std::optional<NamePattern> name_pattern(const std::string& text) {
  const std::size_t percent = text.find('%');
  if (percent == std::string::npos) return std::nullopt;
  const std::size_t letter = text.find_first_not_of(digits, percent + 1);
  // A width of two digits at most.
  if (letter == std::string::npos || text[letter] != 'd' || letter - percent > 3 ||
      text.find('%', letter) != std::string::npos) {
    return std::nullopt;
  }
  const std::string width = text.substr(percent + 1, letter - percent - 1);
  return NamePattern{text.substr(0, percent), text.substr(letter + 1),
                     width.empty() ? 0 : std::stoul(width), width.starts_with('0')};
}

std::vector<fs::path> files_in(const fs::path& folder,
                               const std::function<bool(const std::string&)>& wanted,
                               std::size_t* others) {
  std::vector<fs::path> files;
  std::size_t left_out = 0;
  std::error_code error;
  fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error);
  for (const fs::directory_iterator end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_regular_file(ignored)) continue;
    const std::string name = entry->path().filename().string();
    if (wanted(name)) {
      files.push_back(folder / name);
    } else {
      ++left_out;
    }
  }
  if (error) {
    throw Error(folder.string() + ": cannot read the folder: " + error.message());
  }
  std::ranges::sort(files);
  if (others != nullptr) *others = left_out;
  return files;
}

}  // namespace pellucid

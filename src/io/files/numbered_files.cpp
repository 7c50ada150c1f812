// SPDX-License-Identifier: Apache-2.0
#include "numbered_files.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <utility>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view digits = "0123456789";
constexpr std::size_t max_digits = 15;

/// Returns a number at a scale that all of its files share, as text.
std::string scaled_text(std::int64_t value, int fraction_digits) {
  std::string text = std::to_string(std::abs(value));
  const auto digits_behind = static_cast<std::size_t>(fraction_digits);
  if (text.size() <= digits_behind) text.insert(0, digits_behind + 1 - text.size(), '0');
  if (digits_behind > 0) text.insert(text.size() - digits_behind, 1, '.');
  return value < 0 ? "-" + text : text;
}

/// Returns the number as printf writes it, whatever the locale.
std::string written(const NamePattern& pattern, const NameNumber& number) {
  std::string text = scaled_text(number.mantissa, number.fraction_digits);
  if (pattern.letter != 'd') {
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    std::array<char, 400> buffer;
    const auto end =
        pattern.letter == 'f'
            ? std::to_chars(buffer.begin(), buffer.end(), value, std::chars_format::fixed,
                            static_cast<int>(pattern.precision))
            : std::to_chars(buffer.begin(), buffer.end(), value, std::chars_format::general,
                            static_cast<int>(pattern.precision));
    text.assign(buffer.begin(), end.ptr);
  }
  if (pattern.plus && !text.starts_with('-')) text.insert(0, 1, '+');
  if (text.size() >= pattern.width) return text;
  const std::size_t missing = pattern.width - text.size();
  const bool has_sign = text.starts_with('-') || text.starts_with('+');
  const std::size_t at = pattern.zeros && has_sign ? 1 : 0;
  return text.insert(at, missing, pattern.zeros ? '0' : ' ');
}

struct Conversion {
  std::size_t begin = 0, end = 0;
  NamePattern pattern;
};

/// Returns the conversion that begins at a "%"; nothing where the text there is none.
std::optional<Conversion> conversion_at(const std::string& text, std::size_t percent) {
  Conversion found;
  found.begin = percent;
  std::size_t at = percent + 1;
  const auto number = [&](std::size_t& value) {
    const std::size_t begin = at;
    while (at < text.size() && digits.find(text[at]) != std::string_view::npos) ++at;
    if (at - begin > 2) return false;  // two digits at most
    if (at > begin) value = std::stoul(text.substr(begin, at - begin));
    return true;
  };
  for (; at < text.size() && (text[at] == '+' || text[at] == '0'); ++at) {
    (text[at] == '+' ? found.pattern.plus : found.pattern.zeros) = true;
  }
  if (!number(found.pattern.width)) return std::nullopt;
  const bool has_precision = at < text.size() && text[at] == '.';
  if (has_precision) {
    ++at;
    found.pattern.precision = 0;
    if (!number(found.pattern.precision)) return std::nullopt;
  }
  if (at == text.size()) return std::nullopt;
  const char letter = text[at] == 'i' || text[at] == 'u' ? 'd' : text[at];
  if ((letter != 'd' || has_precision) && letter != 'f' && letter != 'g') return std::nullopt;
  found.pattern.letter = letter;
  found.end = at + 1;
  return found;
}

}  // namespace

std::optional<NameNumber> name_number(std::string_view text) {
  const bool is_negative = text.starts_with('-');
  if (is_negative || text.starts_with('+')) text.remove_prefix(1);
  NameNumber number;
  const std::size_t dot = text.find('.');
  std::string all(text.substr(0, dot));
  if (all.empty()) return std::nullopt;
  if (dot != std::string_view::npos) {
    const std::string_view fraction = text.substr(dot + 1);
    if (fraction.empty()) return std::nullopt;
    all += fraction;
    number.fraction_digits = static_cast<int>(std::min(fraction.size(), max_digits));
  }
  if (all.size() > max_digits || all.find_first_not_of(digits) != std::string::npos) {
    return std::nullopt;
  }
  number.mantissa = std::stoll(all) * (is_negative ? -1 : 1);
  return number;
}

std::vector<fs::path> in_order(const std::vector<NumberedFile>& files, const std::string& name) {
  int fraction_digits = 0;
  for (const NumberedFile& file : files) {
    fraction_digits = std::max(fraction_digits, file.number.fraction_digits);
  }
  std::vector<std::pair<std::int64_t, fs::path>> numbered;
  numbered.reserve(files.size());
  for (const NumberedFile& file : files) {
    std::int64_t value = file.number.mantissa;
    constexpr std::int64_t largest = std::int64_t{1} << 58;
    for (int i = file.number.fraction_digits; i < fraction_digits; ++i) {
      if (std::abs(value) > largest / 10) {
        throw Error(name + ": the number of " + file.file.filename().string() +
                    " has too many digits beside the others; rename the files");
      }
      value *= 10;
    }
    numbered.emplace_back(value, file.file);
  }
  std::ranges::sort(numbered);
  std::vector<fs::path> ordered;
  ordered.reserve(files.size());
  for (const auto& [number, file] : numbered) ordered.push_back(file);
  std::int64_t step = 0;  // the least: what is missing makes a larger one
  for (std::size_t i = 1; i < numbered.size(); ++i) {
    const std::int64_t gap = numbered[i].first - numbered[i - 1].first;
    if (gap > 0 && (step == 0 || gap < step)) step = gap;
  }
  // Steps of decimals that are rounded differ by one of the last digit. A step that is missing is
  // twice as long.
  const std::int64_t rounding = fraction_digits > 0 && step >= 2 ? 1 : 0;
  for (std::size_t i = 1; i < numbered.size(); ++i) {
    const std::int64_t gap = numbered[i].first - numbered[i - 1].first;
    if (gap <= step + rounding && gap > 0) continue;
    if (gap == 0) {
      throw Error(name + ": " + ordered[i - 1].filename().string() + " and " +
                  ordered[i].filename().string() + " have the same number; take one of them out");
    }
    throw Error(name + ": the numbers of its images go up by " + scaled_text(gap, fraction_digits) +
                " from " + ordered[i - 1].filename().string() + " to " +
                ordered[i].filename().string() + ", but elsewhere by " +
                scaled_text(step, fraction_digits) + "; one is missing or too many");
  }
  return ordered;
}

std::optional<NameNumber> NamePattern::number(const std::string& name) const {
  if (name.size() <= before.size() + behind.size() || !name.starts_with(before) ||
      !name.ends_with(behind)) {
    return std::nullopt;
  }
  const std::string text = name.substr(before.size(), name.size() - before.size() - behind.size());
  const std::size_t blanks = zeros ? 0 : text.find_first_not_of(' ');
  if (blanks == std::string::npos) return std::nullopt;
  const auto found = name_number(std::string_view(text).substr(blanks));
  if (!found || (letter == 'd' && found->fraction_digits > 0)) return std::nullopt;
  return written(*this, *found) == text ? found : std::nullopt;
}

std::optional<NamePattern> name_pattern(const std::string& text, std::size_t* conversions) {
  std::optional<NamePattern> pattern;
  std::size_t count = 0;
  std::string around;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] != '%') {
      around += text[at++];
      continue;
    }
    if (text.substr(at, 2) == "%%") {
      around += '%';
      at += 2;
      continue;
    }
    const std::optional<Conversion> found = conversion_at(text, at);
    if (!found) {
      around += text[at++];
      continue;
    }
    if (++count == 1) {
      pattern = found->pattern;
      pattern->before = around;
      around.clear();
    }
    at = found->end;
  }
  if (conversions != nullptr) *conversions = count;
  if (count != 1) return std::nullopt;
  pattern->behind = around;
  return pattern;
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
    if (name.starts_with("._")) continue;
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

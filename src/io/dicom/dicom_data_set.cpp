// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "dicom_elements.h"

namespace pellucid {

namespace {

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view blanks(" \t\r\n\0", 5);
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

}  // namespace

std::string DicomDataSet::text(DicomTag tag) const {
  const auto found = values.find(tag);
  if (found == values.end()) return {};
  std::string text(without_blanks(found->second));
  // Character sets beyond ASCII are not looked up: only names of series would need them.
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

std::vector<double> DicomDataSet::decimals(DicomTag tag) const {
  const std::string whole = text(tag);
  std::vector<double> numbers;
  for (std::string_view rest = whole; !rest.empty();) {
    const std::size_t end = rest.find('\\');
    std::string_view part = without_blanks(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (part.starts_with('+')) part.remove_prefix(1);
    double value = 0;
    const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc{} || stop != part.data() + part.size() || !std::isfinite(value)) {
      return {};
    }
    numbers.push_back(value);
  }
  return numbers;
}

std::vector<double> DicomDataSet::reals(DicomTag tag) const {
  const auto found = values.find(tag);
  if (found == values.end()) return {};
  const std::string& raw = found->second;
  constexpr std::size_t size = sizeof(double);
  std::vector<double> numbers;
  for (std::size_t i = 0; i + size <= raw.size(); i += size) {
    std::array<char, size> bytes;
    std::copy_n(raw.begin() + static_cast<std::ptrdiff_t>(i), size, bytes.begin());
    if (big_endian == (std::endian::native == std::endian::little)) std::ranges::reverse(bytes);
    numbers.push_back(std::bit_cast<double>(bytes));
    if (!std::isfinite(numbers.back())) return {};
  }
  return numbers;
}

std::optional<int> DicomDataSet::number(DicomTag tag) const {
  const std::vector<int> all = whole_numbers(tag);
  return all.empty() ? std::nullopt : std::optional(all.front());
}

std::vector<int> DicomDataSet::whole_numbers(DicomTag tag) const {
  const auto found = values.find(tag);
  if (found == values.end()) return {};
  const std::string& raw = found->second;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(raw[i]); };
  std::vector<int> numbers;
  for (std::size_t i = 0; i + 2 <= raw.size(); i += 2) {
    numbers.push_back(big_endian ? byte(i) << 8 | byte(i + 1) : byte(i + 1) << 8 | byte(i));
  }
  return numbers;
}

std::vector<DicomTag> DicomDataSet::tags(DicomTag tag) const {
  const std::vector<int> halves = whole_numbers(tag);
  std::vector<DicomTag> list;
  for (std::size_t i = 0; i + 2 <= halves.size(); i += 2) {
    list.push_back(static_cast<DicomTag>(halves[i]) << 16 | static_cast<DicomTag>(halves[i + 1]));
  }
  return list;
}

const DicomDataSet* DicomDataSet::item(DicomTag tag) const {
  const auto found = sequences.find(tag);
  return found == sequences.end() || found->second.empty() ? nullptr : &found->second.front();
}

}  // namespace pellucid

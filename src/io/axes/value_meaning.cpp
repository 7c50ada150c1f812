// SPDX-License-Identifier: Apache-2.0
//
// https://cfconventions.org/Data/cf-conventions/cf-conventions-1.11/cf-conventions.html, 2.5.1 and
// 8.1; https://docs.unidata.ucar.edu/nug/current/attribute_conventions.html.
#include "value_meaning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "pellucid/scene/error.h"
#include "text/text.h"

namespace pellucid {

namespace {

const std::vector<double>* numbers_at(const VariableAttributes& attributes, std::string_view name) {
  const auto found = attributes.find(name);
  if (found == attributes.end() || found->second.is_text || found->second.numbers.empty()) {
    return nullptr;
  }
  return &found->second.numbers;
}

/// Returns numbers as they are meant: of unsigned bytes -1 is 255.
std::vector<double> as_stored(std::vector<double> numbers, const std::string& type) {
  if (type[0] != 'u') return numbers;
  const int bits = type == "u8" ? 8 : type == "u16" ? 16 : type == "u32" ? 32 : 64;
  for (double& number : numbers) {
    if (number < 0) number += std::exp2(bits);
  }
  return numbers;
}

void read_scale(const VariableAttributes& attributes, const char* attribute,
                const std::string& name, double& number) {
  if (!attributes.contains(attribute)) return;
  const std::vector<double>* const numbers = numbers_at(attributes, attribute);
  if (numbers == nullptr || !std::isfinite(numbers->front())) {
    throw Error("the " + std::string(attribute) + " of \"" + name +
                "\" is no finite number; mend the attribute");
  }
  if (numbers->size() > 1) {
    throw Error("the " + std::string(attribute) + " of \"" + name + "\" has " +
                std::to_string(numbers->size()) +
                " numbers, but one is needed; mend the attribute");
  }
  number = numbers->front();
}

void read_missing(const VariableAttributes& attributes, const std::string& type,
                  const std::string& name, ValueMeaning& meaning, std::vector<std::string>& notes) {
  for (const char* attribute : {"_FillValue", "missing_value"}) {
    if (!attributes.contains(attribute)) continue;
    const std::vector<double>* const numbers = numbers_at(attributes, attribute);
    if (numbers == nullptr) {
      notes.push_back("the " + std::string(attribute) + " of \"" + name +
                      "\" is no number and is not applied");
      continue;
    }
    const std::vector<double> stored = as_stored(*numbers, type);
    meaning.missing.insert(meaning.missing.end(), stored.begin(), stored.end());
  }
}

/// Reads valid_range, valid_min and valid_max. They are of packed numbers, unless those are whole
/// and they are not.
void read_range(const VariableAttributes& attributes, const std::string& type,
                const std::string& name, ValueMeaning& meaning, std::vector<std::string>& notes) {
  for (const auto& [attribute, count] :
       {std::pair{"valid_range", std::size_t{2}}, std::pair{"valid_min", std::size_t{1}},
        std::pair{"valid_max", std::size_t{1}}}) {
    const auto found = attributes.find(attribute);
    if (found == attributes.end()) continue;
    const std::vector<double>* const numbers = numbers_at(attributes, attribute);
    const bool is_usable = numbers != nullptr && numbers->size() == count &&
                           std::ranges::none_of(*numbers, [](double n) { return std::isnan(n); });
    if (!is_usable) {
      notes.push_back("the " + std::string(attribute) + " of \"" + name + "\" is no " +
                      (count == 2 ? "pair of numbers" : "number") + " and is not applied");
      continue;
    }
    const bool is_scaled = meaning.is_scaled() && type[0] != 'f' && found->second.is_real;
    const std::vector<double> stored = is_scaled ? *numbers : as_stored(*numbers, type);
    meaning.range_is_scaled = is_scaled;
    if (attribute != std::string_view("valid_max")) meaning.least = stored.front();
    if (attribute != std::string_view("valid_min")) meaning.most = stored.back();
  }
  if (meaning.least > meaning.most) {
    meaning.least = -std::numeric_limits<double>::infinity();
    meaning.most = std::numeric_limits<double>::infinity();
    notes.push_back("the valid range of \"" + name + "\" is empty and is not applied");
  }
}

/// The numbers that are missing in the type of the values: 1e20 as an attribute of double is
/// another number in float.
template <class Value>
class Missing {
 public:
  explicit Missing(const ValueMeaning& meaning)
      : meaning_(meaning), has_range_(meaning.has_range()) {
    for (const double number : meaning.missing) add(number);
    if (meaning.default_fill) {
      const std::size_t before = numbers_.size();
      add(*meaning.default_fill);
      if (numbers_.size() > before) default_ = numbers_.back();
    }
  }

  bool is_default(Value value) const { return default_ && value == *default_; }
  bool operator()(Value value) const {
    if (std::ranges::find(numbers_, value) != numbers_.end()) return true;
    if (!has_range_) return false;
    const double stored = static_cast<double>(value);
    const double number =
        meaning_.range_is_scaled ? meaning_.scale * stored + meaning_.offset : stored;
    return number < least() || number > most();
  }

 private:
  void add(double number) {
    if constexpr (std::is_floating_point_v<Value>) {
      const bool fits = std::abs(number) <= static_cast<double>(std::numeric_limits<Value>::max());
      if (fits) numbers_.push_back(static_cast<Value>(number));
    } else {
      const bool fits = number == std::floor(number) &&
                        number >= static_cast<double>(std::numeric_limits<Value>::lowest()) &&
                        number <= static_cast<double>(std::numeric_limits<Value>::max());
      if (fits) numbers_.push_back(static_cast<Value>(number));
    }
  }
  /// Rounds a bound to the precision of the values.
  double rounded(double bound) const {
    if constexpr (std::is_same_v<Value, float>) {
      const bool fits = std::abs(bound) <= static_cast<double>(std::numeric_limits<float>::max());
      if (fits && !meaning_.range_is_scaled) return static_cast<double>(static_cast<float>(bound));
    }
    return bound;
  }
  double least() const { return rounded(meaning_.least); }
  double most() const { return rounded(meaning_.most); }

  const ValueMeaning& meaning_;
  bool has_range_;
  std::vector<Value> numbers_;
  std::optional<Value> default_;
};

template <class Value>
using KeptValue =
    std::conditional_t<sizeof(Value) <= 2 || std::is_same_v<Value, float>, float, double>;

template <class Value>
bool misses_any(const DataArray<Value>& values, const Missing<Value>& is_missing) {
  return std::any_of(values.begin(), values.end(), is_missing);
}

template <class Value>
VolumeData with_meaning(DataArray<Value> values, const ValueMeaning& meaning, DefaultFills& fills) {
  using Kept = KeptValue<Value>;
  const Missing<Value> is_missing(meaning);
  const auto turned = [&](Value value) {
    if (is_missing(value)) {
      if (is_missing.is_default(value)) ++fills.count;
      return std::numeric_limits<Kept>::quiet_NaN();
    }
    return static_cast<Kept>(meaning.scale * static_cast<double>(value) + meaning.offset);
  };
  if constexpr (std::is_same_v<Value, Kept>) {
    for (Value& value : values.writable()) value = turned(value);
    return values;
  } else {
    DataArray<Kept> kept(values.size());
    std::transform(values.begin(), values.end(), kept.writable().begin(), turned);
    return kept;
  }
}

/// Returns a name in small letters and without what stands between its words.
std::string bare_name(const std::string& name) {
  std::string bare = in_small_letters(name);
  std::erase_if(bare, [](char letter) { return letter == '_' || letter == '-' || letter == ' '; });
  return bare;
}

/// Lists other_conventions() of attributes. Those that are applied are not among them.
std::string unread_of(const VariableAttributes& attributes) {
  constexpr auto applied =
      std::to_array<std::string_view>({"scale_factor", "add_offset", "_FillValue", "missing_value",
                                       "valid_range", "valid_min", "valid_max", "element_size_um"});
  std::vector<std::string> names;
  for (const auto& [name, value] : attributes) {
    if (std::ranges::find(applied, name) == applied.end()) names.push_back(name);
  }
  std::string list;
  for (const std::string& name : other_conventions(names))
    list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

bool ValueMeaning::has_range() const {
  return std::isfinite(least) || std::isfinite(most);
}

ValueMeaning value_meaning(const VariableAttributes& attributes, const std::string& type,
                           const std::string& name, std::vector<std::string>& notes) {
  ValueMeaning meaning;
  read_scale(attributes, "scale_factor", name, meaning.scale);
  read_scale(attributes, "add_offset", name, meaning.offset);
  read_missing(attributes, type, name, meaning, notes);
  read_range(attributes, type, name, meaning, notes);
  return meaning;
}

std::string type_with_meaning(const std::string& stored_type) {
  const bool fits_float =
      stored_type == "f32" || stored_type.ends_with("8") || stored_type.ends_with("16");
  return fits_float ? "f32" : "f64";
}

DefaultFills apply_meaning(std::span<VolumeData> components, const ValueMeaning& meaning) {
  DefaultFills fills{meaning.default_fill.value_or(0), 0};
  if (!meaning.is_scaled() && !meaning.may_miss()) return fills;
  const bool any_missing = std::ranges::any_of(components, [&](const VolumeData& data) {
    return std::visit(
        [&](const auto& values) {
          using Value = typename std::decay_t<decltype(values)>::value_type;
          return misses_any(values, Missing<Value>(meaning));
        },
        data);
  });
  if (!meaning.is_scaled() && !any_missing) return fills;
  for (VolumeData& data : components) {
    data = std::visit([&](auto& values) { return with_meaning(std::move(values), meaning, fills); },
                      data);
  }
  return fills;
}

void apply_meaning(std::span<double> positions, const std::string& type,
                   const ValueMeaning& meaning) {
  const Missing<double> is_missing(meaning);
  const Missing<float> is_missing_float(meaning);
  for (double& position : positions) {
    const bool missing =
        type == "f32" ? is_missing_float(static_cast<float>(position)) : is_missing(position);
    position = missing ? std::numeric_limits<double>::quiet_NaN()
                       : meaning.scale * position + meaning.offset;
  }
}

std::string note_of(const DefaultFills& fills, const std::string& name) {
  if (fills.count == 0) return {};
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%.16g", fills.number);
  return std::to_string(fills.count) + (fills.count == 1 ? " value" : " values") + " of \"" + name +
         "\" " + (fills.count == 1 ? "is " : "are ") + number.data() +
         ", which stands where nothing was written, and " + (fills.count == 1 ? "is" : "are") +
         " missing";
}

std::vector<std::string> other_conventions(const std::vector<std::string>& names) {
  constexpr auto known = std::to_array<std::string_view>(
      {"scalefactor",    "scale",        "scales",      "slope",
       "gain",           "multiplier",   "offset",      "addoffset",
       "intercept",      "bias",         "calibration", "missingvalue",
       "missing",        "fillvalue",    "fill",        "nodata",
       "nodatavalue",    "validrange",   "validmin",    "validmax",
       "spacing",        "origin",       "translation", "translate",
       "voxelsize",      "pixelsize",    "resolution",  "pixelresolution",
       "resolutionunit", "affine",       "transform",   "direction",
       "orientation",    "dx",           "dy",          "dz",
       "axes",           "axisorder",    "axisnames",   "dims",
       "dimensions",     "elementsizeum"});
  std::vector<std::string> found;
  for (const std::string_view bare : known) {
    for (const std::string& name : names) {
      if (bare_name(name) == bare) found.push_back(name);
    }
  }
  return found;
}

std::vector<std::string> notes_on_unread(const VariableAttributes& attributes,
                                         const std::string& name) {
  std::vector<std::string> notes;
  const auto labels = attributes.find("flag_meanings");
  if (labels != attributes.end() || attributes.contains("flag_values") ||
      attributes.contains("flag_masks")) {
    const std::string text =
        labels == attributes.end() ? std::string() : labels->second.text.substr(0, 80);
    notes.push_back("the values of \"" + name + "\" are labels (flag_values" +
                    (text.empty() ? "" : ": " + text) + ") and no amounts");
  }
  if (const std::string list = unread_of(attributes); !list.empty()) {
    notes.push_back("\"" + name + "\" has attributes that are not applied (" + list + ")");
  }
  return notes;
}

std::string note_on_group(const VariableAttributes& attributes, const std::string& group,
                          const std::string& name) {
  std::string list = unread_of(attributes);
  // A variable's own are applied.
  for (const char* attribute : {"scale_factor", "add_offset", "element_size_um", "axistags"}) {
    if (attributes.contains(attribute)) list += (list.empty() ? "" : ", ") + std::string(attribute);
  }
  if (list.empty()) return {};
  return "\"" + name + "\" is in the group \"" + group +
         "\", which has attributes that are not applied (" + list + ")";
}

}  // namespace pellucid

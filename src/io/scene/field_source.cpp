// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/field_source.h"

#include <algorithm>
#include <charconv>

#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"

namespace pellucid {

FieldSource parse_field_source(std::string_view text) {
  constexpr std::string_view prefix = "builtin:";
  FieldSource source;
  if (!text.starts_with(prefix)) {
    if (text.empty()) throw Error("the name of the field is empty; give a file or builtin:NAME");
    source.file = text;
    return source;
  }
  std::string_view name = text.substr(prefix.size());
  if (const std::size_t colon = name.find(':'); colon != std::string_view::npos) {
    const std::string_view number = name.substr(colon + 1);
    name = name.substr(0, colon);
    const char* const end = number.data() + number.size();
    const auto result = std::from_chars(number.data(), end, source.points);
    if (result.ec != std::errc() || result.ptr != end || source.points < 2 ||
        source.points > 2048) {
      throw Error("field " + printable(text) + ": \"" + printable(number) +
                  "\" points per axis, but must be an integer from 2 to 2048");
    }
  }
  const auto& names = builtin_field_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    std::string known;
    for (const std::string_view n : names) known += (known.empty() ? "" : ", ") + std::string(n);
    throw Error("field " + printable(text) + ": no built-in field of that name" +
                did_you_mean(name, names) + "; known: " + known);
  }
  source.builtin = name;
  return source;
}

Volume load_field(const FieldSource& source) {
  return source.builtin.empty() ? read_volume(source.file, source.options)
                                : make_builtin_field(source.builtin, source.points);
}

}  // namespace pellucid

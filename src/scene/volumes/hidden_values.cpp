// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/hidden_values.h"

#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <variant>

namespace pellucid {

VolumeData without_hidden(const VolumeData& data, const std::vector<bool>& hidden, int components) {
  return std::visit(
      [&](const auto& values) -> VolumeData {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        // Whole numbers of up to 16 bits fit float.
        using Number =
            std::conditional_t<sizeof(Value) <= 2 || std::is_same_v<Value, float>, float, double>;
        DataArray<Number> with_nan(values.size());
        const std::span<Number> to = with_nan.writable();
        for (std::size_t i = 0; i < values.size(); ++i) {
          to[i] = hidden[i / static_cast<std::size_t>(components)]
                      ? std::numeric_limits<Number>::quiet_NaN()
                      : static_cast<Number>(values[i]);
        }
        return with_nan;
      },
      data);
}

}  // namespace pellucid

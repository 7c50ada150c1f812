// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Returns values that another process wrote, in place: whoever has them keeps all its bytes.
/// `offset` is a multiple of the type's size.
inline VolumeData child_values(const std::shared_ptr<std::byte>& all, std::size_t offset,
                               std::size_t count, const std::string& type) {
  VolumeData data = make_volume_data(type, 0);
  std::visit(
      [&](auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        const auto* const first = reinterpret_cast<const Value*>(all.get() + offset);
        values = DataArray<Value>(std::shared_ptr<const Value>(all, first), count);
      },
      data);
  return data;
}

}  // namespace pellucid

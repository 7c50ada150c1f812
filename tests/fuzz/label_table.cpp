// SPDX-License-Identifier: Apache-2.0

// Tables of labels: any bytes give looks that a table can be made of, or an Error of one line.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "pellucid/io/label_table.h"
#include "pellucid/scene/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  try {
    const std::vector<pellucid::LabelStyle> styles = pellucid::parse_label_table(text, "fuzz", 0.5);
    if (styles.empty()) std::abort();
    for (const pellucid::LabelStyle& style : styles) {
      if (!(style.extinction >= 0 && style.extinction <= 0.5)) std::abort();
    }
    const pellucid::LabelTable table(styles);
    if (table.styles().size() != styles.size()) std::abort();
  } catch (const pellucid::Error& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) std::abort();
  }
  return 0;
}

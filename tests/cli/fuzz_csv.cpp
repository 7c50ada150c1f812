// SPDX-License-Identifier: Apache-2.0

// The parser of tables: any bytes give a table whose numbers are finite, or an Error of one line.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "arguments/parse.h"
#include "charts/csv.h"
#include "pellucid/scene/error.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

template <class Attempt>
void attempt(Attempt&& parse) {
  try {
    parse();
  } catch (const pellucid::Error& error) {
    const std::string message = error.what();
    require(message.starts_with("fuzz: ") && message.size() < 1000);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  for (const char c : pellucid::cli::one_line(text)) {
    require(static_cast<unsigned char>(c) >= 0x20 && c != '\x7f');
  }
  attempt([&] {
    const pellucid::cli::CsvTable table(text, "fuzz");
    require(!table.columns().empty());
    for (std::size_t row = 0; row < table.rows(); ++row) {
      for (std::size_t column = 0; column < table.columns().size(); ++column) {
        attempt([&] { require(std::isfinite(table.number<float>(row, column))); });
        attempt([&] {
          for (const double x : table.list<double>(row, column)) require(std::isfinite(x));
        });
      }
    }
    attempt([&] { (void)table.column("x"); });
  });
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include "page_messages.h"

#include <memory>
#include <utility>

namespace pellucid::view {

PageMessage text_message(const Json& json) {
  // A byte of a file's name that is not UTF-8 must not end the program.
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return {PageMessage::Kind::text, false, std::make_shared<const std::string>(std::move(text))};
}

PageMessage error_message(std::string_view what) {
  return text_message({{"type", "error"}, {"message", what}});
}

PageMessage progress_message(std::size_t layer, double fraction) {
  return text_message({{"type", "progress"}, {"layer", layer}, {"fraction", fraction}});
}

PageMessage binary_message(const Json& header, const std::vector<std::string_view>& parts) {
  std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::size_t size = 4 + text.size();
  for (const std::string_view part : parts) size += part.size();
  std::string bytes;
  bytes.reserve(size);
  for (int shift = 0; shift < 32; shift += 8) {
    bytes += static_cast<char>((text.size() >> shift) & 255);
  }
  bytes += text;
  for (const std::string_view part : parts) bytes += part;
  return {PageMessage::Kind::binary, false, std::make_shared<const std::string>(std::move(bytes))};
}

std::string_view as_text(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace pellucid::view

// SPDX-License-Identifier: Apache-2.0
#include "access_control.h"

#include <unistd.h>

#include <array>
#include <utility>

#include "pellucid/scene/error.h"

namespace pellucid::view {

AccessControl::AccessControl(std::string token, std::uint16_t port) : token_(std::move(token)) {
  // Browsers leave out the port that they take for HTTP anyway.
  const std::string suffix = port == 80 ? "" : ":" + std::to_string(port);
  local_name_ = "localhost" + suffix;
  local_number_ = "127.0.0.1" + suffix;
}

std::optional<std::string_view> AccessControl::admit(const Caller& caller) const noexcept {
  if (!caller.host || (*caller.host != local_name_ && *caller.host != local_number_)) return {};
  constexpr std::string_view scheme = "http://";
  if (caller.origin) {
    if (!caller.origin->starts_with(scheme) ||
        caller.origin->substr(scheme.size()) != *caller.host) {
      return {};
    }
  } else if (caller.upgrades) {
    return {};
  }
  const std::string_view target = caller.target;
  const std::size_t path = 1 + token_.size();
  if (target.size() <= path || target[0] != '/' || target[path] != '/') return {};
  if (!equal_in_constant_time(target.substr(1, token_.size()), token_)) return {};
  return target.substr(path);
}

std::string AccessControl::address() const {
  return "http://" + local_number_ + "/" + token_ + "/";
}

std::string make_token() {
  std::array<unsigned char, 32> random{};
  if (getentropy(random.data(), random.size()) != 0) {
    throw Error("the operating system gives no random numbers, so the page would not be safe");
  }
  constexpr char digits[] = "0123456789abcdef";
  std::string token;
  for (const unsigned char byte : random) {
    token += digits[byte >> 4];
    token += digits[byte & 15];
  }
  return token;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) noexcept {
  if (a.size() != b.size()) return false;
  unsigned char different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    different = static_cast<unsigned char>(different | (a[i] ^ b[i]));
  }
  return different == 0;
}

}  // namespace pellucid::view

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pellucid::view {

/// Origin of a request, by its headers. A header that is missing is absent; one that is repeated
/// counts as an empty text, which nothing admits.
struct Caller {
  std::string_view target;                 ///< of the request line, such as "/TOKEN/style.css"
  std::optional<std::string_view> host;    ///< Host
  std::optional<std::string_view> origin;  ///< Origin
  bool upgrades = false;                   ///< whether it asks for a WebSocket
};

/// Decides which requests come from a page of this program.
///
/// - The token in the address keeps out other users of the machine.
/// - Host must name the loopback interface: a name of somebody else that resolves to it does not
///   pass (DNS rebinding).
/// - Origin, where it is given, must be our own. A WebSocket must have one, because browsers let
///   any page open one (cross-site WebSocket hijacking).
class AccessControl {
 public:
  AccessControl(std::string token, std::uint16_t port);

  /// Returns the path behind the token, such as "/style.css", or none if the request is refused.
  std::optional<std::string_view> admit(const Caller& caller) const noexcept;
  /// Returns the address of the page.
  std::string address() const;

 private:
  std::string token_, local_name_, local_number_;
};

/// Returns 256 random bits of the operating system as 64 hexadecimal digits. Throws Error.
std::string make_token();
/// Compares in a time that depends on the lengths alone.
bool equal_in_constant_time(std::string_view a, std::string_view b) noexcept;

}  // namespace pellucid::view

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace pellucid::view {

/// A page that is connected; never used twice.
using PageId = std::uint64_t;

/// A message to pages. Several pages share its bytes.
struct PageMessage {
  enum class Kind { text, binary };
  Kind kind = Kind::text;
  /// A frame takes the place of an older one that has not been sent yet.
  bool is_frame = false;
  std::shared_ptr<const std::string> bytes;
};

/// Events of a server's pages. Called by the thread that runs it.
struct PageEvents {
  std::function<void(PageId)> opened;
  std::function<void(PageId, std::string_view)> received;
  /// The second argument is the number of pages that are left.
  std::function<void(PageId, std::size_t)> closed;
  /// Returns where a file of so many bytes is to be written, given the path behind "/upload/".
  /// Throws Error, whose text the page is told. Empty: nothing is uploaded.
  std::function<std::filesystem::path(std::string_view path, std::uint64_t bytes)> uploaded{};
};

/// Limits on what clients may ask of the server.
struct ServerLimits {
  std::size_t connections = 32;
  /// Until a request or a handshake must be complete, and until a message must be accepted.
  int request_seconds = 10;
  int message_seconds = 30;
  std::size_t header_bytes = 8192;
  std::size_t message_bytes = std::size_t(2) << 20;
  /// Bytes that wait for one page. A page that lets more gather is disconnected.
  std::size_t waiting_bytes = std::size_t(256) << 20;
};

/// Serves the page and its WebSockets on the loopback interface, to those whom the AccessControl
/// admits. Others are answered 403 without a word. One thread runs it.
class PageServer {
 public:
  /// Binds the port; 0: any that is free. Throws Error if that fails. `frame_ancestors`: who may
  /// show the page in a frame (ViewerOptions).
  PageServer(std::uint16_t port, PageEvents events, ServerLimits limits = {},
             const std::string& frame_ancestors = {});
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// Returns the address of the page, with its token.
  const std::string& address() const noexcept;
  /// Serves until `ended`, which is asked ten times a second, is true.
  void run(const std::function<bool()>& ended);

  // Safe to call from any thread. Messages arrive in the order of the calls:

  void send(PageId page, PageMessage message);
  /// Sends it to the pages that have had a message of their own.
  void send_to_all(PageMessage message);

  struct State;  ///< server_state.h

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pellucid::view

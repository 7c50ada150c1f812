// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "access_control.h"
#include "page_server.h"

namespace pellucid::view {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;

using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;
using HeaderParser = http::request_parser<http::empty_body>;
/// Limit of a body that is none. Boost 1.74 takes a missing limit for 0.
inline constexpr std::uint64_t any_length = std::numeric_limits<std::uint64_t>::max();

/// A WebSocket of a page (page_socket.cpp).
class PageSocket {
 public:
  virtual ~PageSocket() = default;
  virtual void send(PageMessage message) = 0;
  virtual void close() = 0;

  /// Set by the first message of its own; until then it gets none that goes to all.
  bool is_greeted = false;
};

/// A message on its way to one page, or to all if none is given.
struct Outgoing {
  std::optional<PageId> page;
  PageMessage message;
};

/// State that the connections of a server share. All of it but the outbox belongs to the thread
/// that runs `context`.
struct PageServer::State : std::enable_shared_from_this<PageServer::State> {
  State(net::io_context& on, PageEvents of_pages, ServerLimits to_keep)
      : context(on), events(std::move(of_pages)), limits(to_keep), acceptor(on), timer(on) {}

  net::io_context& context;
  PageEvents events;
  ServerLimits limits;
  std::unique_ptr<AccessControl> gate;
  std::string address;
  std::string frame_ancestors = "'none'";  ///< for the Content Security Policy
  net::ip::tcp::acceptor acceptor;
  net::steady_timer timer;
  std::size_t connections = 0;  ///< of any kind
  PageId next_page = 1;
  std::map<PageId, std::shared_ptr<PageSocket>> pages;
  std::mutex outbox_mutex;  ///< of the following
  /// Messages in the order in which they were sent. What the context's own thread posts to it is
  /// carried out behind what other threads post later, so that posting messages may exchange them.
  std::deque<Outgoing> outbox;

  void accept();
  /// Queues a message; safe to call from any thread.
  void send(Outgoing message);

 private:
  void deliver();
};

/// Handlers that wait in the context own the state, so that the context is the last to go.
struct PageServer::Parts {
  net::io_context context{1};
  std::shared_ptr<State> state;
};

/// Counts a connection for as long as it lives.
class ConnectionCount {
 public:
  explicit ConnectionCount(std::shared_ptr<PageServer::State> state);
  ~ConnectionCount();
  ConnectionCount(const ConnectionCount&) = delete;
  ConnectionCount& operator=(const ConnectionCount&) = delete;

  PageServer::State& state() const noexcept { return *state_; }

 private:
  std::shared_ptr<PageServer::State> state_;
};

/// Reads requests, answers them with files of the page, and turns into a WebSocket if asked to.
void serve_requests(net::ip::tcp::socket socket, std::shared_ptr<ConnectionCount> count);
/// Writes the body of a request to a file, answers, and closes the connection. `path`: behind
/// "/upload/". `buffer` has what was read behind the header.
void receive_upload(beast::tcp_stream stream, beast::flat_buffer buffer, HeaderParser&& header,
                    std::string_view path, std::shared_ptr<ConnectionCount> count);
/// Completes the handshake of a WebSocket, and serves it until it is closed.
void serve_socket(beast::tcp_stream stream, Request request,
                  std::shared_ptr<ConnectionCount> count);

}  // namespace pellucid::view

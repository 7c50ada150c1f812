// SPDX-License-Identifier: Apache-2.0
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "page_files.h"
#include "server_state.h"

namespace pellucid::view {

namespace {

constexpr std::string_view upload_path = "/upload/";

std::optional<std::string_view> header_of(const Request& request, http::field field) {
  const auto [first, last] = request.equal_range(field);
  if (first == last) return {};
  if (std::next(first) != last) return std::string_view();
  return std::string_view(first->value().data(), first->value().size());
}

std::string_view target_of(const Request& request) {
  return {request.target().data(), request.target().size()};
}

/// The page may load what comes from here, and nothing else. Only those who are named may show it
/// in a frame. It may not tell others its address, which has the token.
void add_policies(Response& response, std::string_view host, const std::string& frame_ancestors) {
  const std::string socket = "ws://" + std::string(host);
  response.set("Content-Security-Policy",
               "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
               "connect-src 'self' " +
                   socket + "; base-uri 'none'; form-action 'none'; frame-ancestors " +
                   frame_ancestors);
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set(http::field::cache_control, "no-store");
}

class RequestReader : public std::enable_shared_from_this<RequestReader> {
 public:
  RequestReader(net::ip::tcp::socket socket, std::shared_ptr<ConnectionCount> count)
      : stream_(std::move(socket)), count_(std::move(count)) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(limits().header_bytes));
    parser_->body_limit(any_length);  // answer() looks at it
    stream_.expires_after(std::chrono::seconds(limits().request_seconds));
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](beast::error_code error, std::size_t) {
                              // A request that is wrong or too long is not worth an answer.
                              if (!error) self->answer();
                            });
  }

 private:
  const ServerLimits& limits() const { return count_->state().limits; }

  void answer() {
    const Request& request = parser_->get();
    const bool upgrades = beast::websocket::is_upgrade(request);
    const bool has_body = parser_->chunked() || parser_->content_length().value_or(0) > 0;
    const std::optional<std::string_view> host = header_of(request, http::field::host);
    const auto origin = header_of(request, http::field::origin);
    const auto path = count_->state().gate->admit({target_of(request), host, origin, upgrades});
    if (path && request.method() == http::verb::put && path->starts_with(upload_path)) {
      // Browsers tell the origin of whatever changes something.
      if (!origin) return respond({http::status::forbidden, request.version()}, false);
      const std::string name(path->substr(upload_path.size()));
      return receive_upload(std::move(stream_), std::move(buffer_), std::move(*parser_), name,
                            std::move(count_));
    }
    if (has_body) return;  // which nothing else takes
    if (!path) return respond({http::status::forbidden, request.version()}, false);
    if (upgrades) {
      if (*path != "/socket") return respond({http::status::not_found, request.version()}, false);
      stream_.expires_never();
      return serve_socket(std::move(stream_), parser_->release(), std::move(count_));
    }
    send_file(request, *path, *host);
  }

  void send_file(const Request& request, std::string_view path, std::string_view host) {
    const PageFile* const file = find_page_file(path);
    if (request.method() != http::verb::get) {
      return respond({http::status::method_not_allowed, request.version()}, false);
    }
    if (file == nullptr) return respond({http::status::not_found, request.version()}, false);
    Response response{http::status::ok, request.version()};
    add_policies(response, host, count_->state().frame_ancestors);
    response.set(http::field::content_type,
                 boost::string_view(file->content_type.data(), file->content_type.size()));
    response.body() = file->content;
    respond(std::move(response), request.keep_alive());
  }

  void respond(Response response, bool keep_alive) {
    response.keep_alive(keep_alive);
    response.prepare_payload();
    const auto sent = std::make_shared<Response>(std::move(response));
    stream_.expires_after(std::chrono::seconds(limits().request_seconds));
    http::async_write(
        stream_, *sent, [self = shared_from_this(), sent](beast::error_code error, std::size_t) {
          if (error) return;
          if (sent->keep_alive()) return self->read();
          beast::error_code ignored;
          self->stream_.socket().shutdown(net::ip::tcp::socket::shutdown_send, ignored);
        });
  }

  beast::tcp_stream stream_;
  std::shared_ptr<ConnectionCount> count_;
  beast::flat_buffer buffer_;
  std::optional<HeaderParser> parser_;
};

}  // namespace

void serve_requests(net::ip::tcp::socket socket, std::shared_ptr<ConnectionCount> count) {
  std::make_shared<RequestReader>(std::move(socket), std::move(count))->read();
}

}  // namespace pellucid::view

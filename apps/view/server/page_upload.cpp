// SPDX-License-Identifier: Apache-2.0
#include <boost/beast/http/file_body.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "server_state.h"

namespace pellucid::view {

namespace {

/// Writes the body of one request to its file.
class UploadReader : public std::enable_shared_from_this<UploadReader> {
 public:
  UploadReader(beast::tcp_stream stream, beast::flat_buffer buffer, HeaderParser&& header,
               std::shared_ptr<ConnectionCount> count)
      : stream_(std::move(stream)),
        count_(std::move(count)),
        buffer_(std::move(buffer)),
        parser_(std::move(header)) {
    parser_.body_limit(any_length);  // the limit is that of all files
  }

  void open(std::string_view path) {
    if (!count_->state().events.uploaded) return respond(http::status::method_not_allowed, "");
    const auto length = parser_.content_length();
    if (!length) return respond(http::status::length_required, "upload: the length is missing");
    try {
      const std::filesystem::path file = count_->state().events.uploaded(path, *length);
      beast::error_code error;
      parser_.get().body().open(file.c_str(), beast::file_mode::write_new, error);
      if (error) return respond(http::status::bad_request, "upload: " + error.message());
    } catch (const std::exception& error) {
      return respond(http::status::bad_request, error.what());
    }
    read();
  }

 private:
  /// Part by part, so that a slow line is no reason to give up while something comes.
  void read() {
    if (parser_.is_done()) return finish();
    stream_.expires_after(std::chrono::seconds(count_->state().limits.message_seconds));
    http::async_read_some(stream_, buffer_, parser_,
                          [self = shared_from_this()](beast::error_code error, std::size_t) {
                            if (error == http::error::end_of_stream) return;
                            if (error)
                              return self->respond(http::status::bad_request,
                                                   "upload: " + error.message());
                            self->read();
                          });
  }

  void finish() {
    parser_.get().body().close();
    respond(http::status::ok, "");
  }

  /// A body that was not read to its end makes the connection useless.
  void respond(http::status status, std::string text) {
    const auto sent = std::make_shared<Response>(status, 11);
    sent->set(http::field::content_type, "text/plain; charset=utf-8");
    sent->set(http::field::cache_control, "no-store");
    sent->set("X-Content-Type-Options", "nosniff");
    sent->body() = std::move(text);
    sent->keep_alive(false);
    sent->prepare_payload();
    stream_.expires_after(std::chrono::seconds(count_->state().limits.request_seconds));
    http::async_write(
        stream_, *sent, [self = shared_from_this(), sent](beast::error_code error, std::size_t) {
          beast::error_code ignored;
          if (!error) self->stream_.socket().shutdown(net::ip::tcp::socket::shutdown_send, ignored);
          if (!error && !self->parser_.is_done()) self->discard();
        });
  }

  /// Reads what still comes for a while: a client that is cut off while it sends sees no answer.
  void discard() {
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(65536),
                            [self = shared_from_this()](beast::error_code error, std::size_t) {
                              if (!error) self->discard();
                            });
  }

  beast::tcp_stream stream_;
  std::shared_ptr<ConnectionCount> count_;
  beast::flat_buffer buffer_;
  http::request_parser<http::file_body> parser_;
};

}  // namespace

void receive_upload(beast::tcp_stream stream, beast::flat_buffer buffer, HeaderParser&& header,
                    std::string_view path, std::shared_ptr<ConnectionCount> count) {
  std::make_shared<UploadReader>(std::move(stream), std::move(buffer), std::move(header),
                                 std::move(count))
      ->open(path);
}

}  // namespace pellucid::view

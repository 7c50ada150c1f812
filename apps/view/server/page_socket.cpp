// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <deque>
#include <utility>

#include "server_state.h"

namespace pellucid::view {

namespace {

namespace websocket = beast::websocket;

class Socket : public PageSocket, public std::enable_shared_from_this<Socket> {
 public:
  Socket(beast::tcp_stream stream, std::shared_ptr<ConnectionCount> count)
      : stream_(std::move(stream)), count_(std::move(count)), id_(state().next_page++) {}

  void open(Request request) {
    websocket::stream_base::timeout timeout{};
    timeout.handshake_timeout = std::chrono::seconds(state().limits.request_seconds);
    timeout.idle_timeout = std::chrono::seconds(state().limits.message_seconds);
    timeout.keep_alive_pings = true;
    stream_.set_option(timeout);
    stream_.read_message_max(state().limits.message_bytes);
    stream_.auto_fragment(false);
    const auto kept = std::make_shared<Request>(std::move(request));
    stream_.async_accept(*kept, [self = shared_from_this(), kept](beast::error_code error) {
      if (error) return;
      self->state().pages.emplace(self->id_, self);
      self->state().events.opened(self->id_);
      self->read();
    });
  }

  void send(PageMessage message) override {
    if (closed_) return;
    // What is being written stands in front, and stays.
    const auto waiting = waiting_.begin() + (writing_ ? 1 : 0);
    if (message.is_frame) {
      const auto older = std::find_if(waiting, waiting_.end(),
                                      [](const PageMessage& other) { return other.is_frame; });
      if (older != waiting_.end()) {
        waiting_bytes_ -= older->bytes->size();
        waiting_.erase(older);
      }
    }
    // What waits already: a single message may be larger.
    if (waiting_bytes_ > state().limits.waiting_bytes) return close();
    waiting_bytes_ += message.bytes->size();
    waiting_.push_back(std::move(message));
    if (!writing_) write();
  }

  void close() override {
    if (std::exchange(closed_, true)) return;
    // A child of this process may hold the socket, too.
    beast::error_code ignored;
    beast::get_lowest_layer(stream_).socket().shutdown(net::socket_base::shutdown_both, ignored);
    beast::get_lowest_layer(stream_).close();
    if (state().pages.erase(id_) > 0) state().events.closed(id_, state().pages.size());
  }

 private:
  PageServer::State& state() const { return count_->state(); }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (error) return self->close();
      const auto data = self->buffer_.cdata();
      self->state().events.received(self->id_,
                                    {static_cast<const char*>(data.data()), data.size()});
      self->buffer_.consume(self->buffer_.size());
      if (!self->closed_) self->read();
    });
  }

  void write() {
    writing_ = true;
    const PageMessage& message = waiting_.front();
    stream_.binary(message.kind == PageMessage::Kind::binary);
    stream_.async_write(net::buffer(*message.bytes),
                        [self = shared_from_this()](beast::error_code error, std::size_t) {
                          self->written(error);
                        });
  }

  void written(beast::error_code error) {
    writing_ = false;
    if (error) return close();
    waiting_bytes_ -= waiting_.front().bytes->size();
    waiting_.pop_front();
    if (!closed_ && !waiting_.empty()) write();
  }

  websocket::stream<beast::tcp_stream> stream_;
  std::shared_ptr<ConnectionCount> count_;
  PageId id_;
  beast::flat_buffer buffer_;
  std::deque<PageMessage> waiting_;
  std::size_t waiting_bytes_ = 0;
  bool writing_ = false, closed_ = false;
};

}  // namespace

void serve_socket(beast::tcp_stream stream, Request request,
                  std::shared_ptr<ConnectionCount> count) {
  std::make_shared<Socket>(std::move(stream), std::move(count))->open(std::move(request));
}

}  // namespace pellucid::view

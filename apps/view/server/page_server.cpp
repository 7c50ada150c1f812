// SPDX-License-Identifier: Apache-2.0
#include "page_server.h"

#include <fcntl.h>
#include <sys/socket.h>

#include <boost/asio/post.hpp>
#include <chrono>
#include <utility>
#include <vector>

#include "pellucid/scene/error.h"
#include "server_state.h"

namespace pellucid::view {

using net::ip::tcp;

ConnectionCount::ConnectionCount(std::shared_ptr<PageServer::State> state)
    : state_(std::move(state)) {
  ++state_->connections;
}

ConnectionCount::~ConnectionCount() {
  --state_->connections;
}

namespace {

/// Programs that this one starts do not keep the socket.
void close_on_exec(int descriptor) {
  fcntl(descriptor, F_SETFD, FD_CLOEXEC);
}

}  // namespace

void PageServer::State::accept() {
  acceptor.async_accept([self = shared_from_this()](beast::error_code error, tcp::socket socket) {
    if (error == net::error::operation_aborted) return;
    if (!error) close_on_exec(socket.native_handle());
    if (!error && self->connections < self->limits.connections) {
      serve_requests(std::move(socket), std::make_shared<ConnectionCount>(self));
    }
    // One connection too many is closed by its destructor.
    if (!error) return self->accept();
    // Such as too many open files: later there may be fewer.
    self->timer.expires_after(std::chrono::milliseconds(200));
    self->timer.async_wait([self](beast::error_code stopped) {
      if (!stopped) self->accept();
    });
  });
}

void PageServer::State::send(Outgoing message) {
  bool is_first = false;
  {
    const std::lock_guard lock(outbox_mutex);
    is_first = outbox.empty();
    outbox.push_back(std::move(message));
  }
  if (is_first) net::post(context, [self = shared_from_this()] { self->deliver(); });
}

void PageServer::State::deliver() {
  std::deque<Outgoing> messages;
  {
    const std::lock_guard lock(outbox_mutex);
    messages.swap(outbox);
  }
  for (const auto& [page, message] : messages) {
    // A socket that closes leaves the list.
    std::vector<std::shared_ptr<PageSocket>> sockets;
    for (const auto& [id, socket] : pages) {
      if (page == id) socket->is_greeted = true;
      if (page == id || (!page && socket->is_greeted)) sockets.push_back(socket);
    }
    for (const auto& socket : sockets) socket->send(message);
  }
}

PageServer::PageServer(std::uint16_t port, PageEvents events, ServerLimits limits,
                       const std::string& frame_ancestors)
    : parts_(std::make_unique<Parts>()) {
  parts_->state = std::make_shared<State>(parts_->context, std::move(events), limits);
  State& state = *parts_->state;
  if (!frame_ancestors.empty()) state.frame_ancestors = frame_ancestors;
  const tcp::endpoint endpoint(net::ip::address_v4::loopback(), port);
  try {
    state.acceptor.open(endpoint.protocol());
    close_on_exec(state.acceptor.native_handle());
    state.acceptor.set_option(net::socket_base::reuse_address(true));
    state.acceptor.bind(endpoint);
    state.acceptor.listen();
  } catch (const boost::system::system_error& error) {
    throw Error("port " + std::to_string(port) + ": " + error.code().message() +
                "; choose another one by --port, or leave it out");
  }
  state.gate =
      std::make_unique<AccessControl>(make_token(), state.acceptor.local_endpoint().port());
  state.address = state.gate->address();
}

PageServer::~PageServer() {
  parts_->state->events.closed = [](PageId, std::size_t) {};
  // A child of this process may hold the socket, too.
  ::shutdown(parts_->state->acceptor.native_handle(), SHUT_RDWR);
  // A page that is closed leaves the list.
  while (!parts_->state->pages.empty()) {
    const std::shared_ptr<PageSocket> socket = parts_->state->pages.begin()->second;
    socket->close();
  }
}

const std::string& PageServer::address() const noexcept {
  return parts_->state->address;
}

void PageServer::run(const std::function<bool()>& ended) {
  parts_->state->accept();
  while (!ended()) {
    parts_->context.run_for(std::chrono::milliseconds(100));
    if (parts_->context.stopped()) parts_->context.restart();
  }
}

void PageServer::send(PageId page, PageMessage message) {
  parts_->state->send({page, std::move(message)});
}

void PageServer::send_to_all(PageMessage message) {
  parts_->state->send({{}, std::move(message)});
}

}  // namespace pellucid::view

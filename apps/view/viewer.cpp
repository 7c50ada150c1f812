// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <chrono>
#include <new>
#include <optional>
#include <utility>

#include "page_messages.h"
#include "page_server.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/scene/error.h"
#include "studio.h"

namespace pellucid::view {

namespace {

using Clock = std::chrono::steady_clock;

/// A page that is loaded again is away for less than this.
constexpr std::chrono::seconds reload_time{3};

}  // namespace

void run_viewer(SceneDescription description, Scene scene, const ViewerOptions& options,
                const std::function<void(const std::string& address)>& started,
                const std::function<bool()>& ended) {
  const int threads = options.threads > 0 ? options.threads : default_thread_count();
  // The events refer to the studio, which is made after the server that it sends through.
  Studio* receiver = nullptr;
  std::optional<Clock::time_point> left;
  PageEvents events;
  PageServer* server_of_pages = nullptr;
  events.opened = [&](PageId page) {
    left.reset();
    receiver->page_opened(page);
  };
  events.received = [&](PageId page, std::string_view message) {
    try {
      receiver->receive(page, parse_command(message), message.size());
    } catch (const Error& error) {
      server_of_pages->send(page, error_message(error.what()));
    } catch (const std::bad_alloc&) {
      server_of_pages->send(page, error_message("there is not enough memory for this message"));
    }
  };
  events.closed = [&](PageId, std::size_t pages) {
    receiver->pages_left(pages);
    if (pages == 0) left = Clock::now();
  };
  PageServer server(options.port, std::move(events), {}, options.frame_ancestors);
  server_of_pages = &server;
  Studio studio(
      SceneState(std::move(description), std::move(scene), parallel_for(threads)),
      options.keeps_camera, threads, options.changed,
      [&server](std::optional<PageId> page, PageMessage message) {
        if (page) {
          server.send(*page, std::move(message));
        } else {
          server.send_to_all(std::move(message));
        }
      },
      options.quick_layers);
  receiver = &studio;
  started(server.address());
  server.run([&] {
    return ended() || (options.ends_with_page && left && Clock::now() - *left > reload_time);
  });
}

}  // namespace pellucid::view

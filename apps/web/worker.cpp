// SPDX-License-Identifier: Apache-2.0
//
// The studio of a page in its worker, in the place of the program and its server: the same commands
// come, and the same messages go (apps/web/page/worker.js).
#include <emscripten/em_js.h>
#include <emscripten/emscripten.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "pellucid/cpu/threads.h"
#include "pellucid/scene/error.h"
#include "view/command.h"
#include "view/server/page_messages.h"
#include "view/studio.h"
#include "view/view_input.h"

EM_JS(void, pellucid_post_text, (const char* bytes, std::size_t size),
      { postMessage(UTF8ToString(bytes, size)); });
EM_JS(void, pellucid_post_bytes, (const char* bytes, std::size_t size), {
  const copy = HEAPU8.slice(bytes, bytes + size).buffer;
  postMessage(copy, [copy]);
});

namespace pellucid::view {

namespace {

/// The only page that there is.
constexpr PageId page = 1;
/// Folders of a page's files (apps/web/page/worker.js).
constexpr const char* folder_of_scene = "/scene";
constexpr const char* folder_of_uploads = "/uploads";
/// Bytes of files for which a heap of 2 GiB has room, beside what is made of them.
constexpr std::uint64_t most_upload_bytes = std::uint64_t{1} << 29;

/// Returns how many threads there are to work: those that meet here within two seconds.
int count_threads() {
  const int most = default_thread_count();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  std::atomic<int> here{0}, met{1};
  // So few are not split further (parallel_for()), so that a thread waits with one part.
  constexpr int part = 64;
  parallel_for(most)(part * most, [&](int, int) {
    const int now = ++here;
    for (int seen = met; seen < now && !met.compare_exchange_weak(seen, now);) {
    }
    while (met < most && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    --here;
  });
  return met;
}

class WorkerViewer {
 public:
  /// Makes the threads, and returns how many there are.
  int make_threads() { return threads_ = count_threads(); }

  /// Tells the page what there is: the scene that it came with, or nothing yet.
  void start(const std::string& input) {
    send(text_message({{"type", "start"},
                       {"page", page},
                       {"has_scene", !input.empty()},
                       {"can_open", true},
                       {"can_list", false},
                       {"upload_bytes", most_upload_bytes}}));
    if (!input.empty()) try_to([&] { show(input, folder_of_scene); });
  }

  void receive(std::string_view message) {
    ++number_;
    bool is_for_studio = false;
    try_to([&] {
      Command command = parse_command(message);
      if (open(command)) return;
      is_for_studio = studio_ != nullptr;
      if (is_for_studio) studio_->receive(page, std::move(command), message.size(), number_);
    });
    if (!is_for_studio && studio_) studio_->skip(page, number_);
  }

  /// Returns whether there is more to do.
  bool advance(double seconds) {
    const bool has_more = studio_ && studio_->advance(seconds);
    post();
    return has_more;
  }

 private:
  /// Sends a message, at the end of the turn where another thread than the worker's says it: only
  /// that one reaches the page.
  void send(PageMessage message) {
    {
      const std::lock_guard lock(mutex_);
      outgoing_.push_back(std::move(message));
    }
    if (std::this_thread::get_id() == own_thread_) post();
  }

  void post() {
    std::vector<PageMessage> messages;
    {
      const std::lock_guard lock(mutex_);
      messages.swap(outgoing_);
    }
    for (const PageMessage& message : messages) post(message);
  }

  static void post(const PageMessage& message) {
    const std::string& bytes = *message.bytes;
    if (message.kind == PageMessage::Kind::text) {
      pellucid_post_text(bytes.data(), bytes.size());
    } else {
      pellucid_post_bytes(bytes.data(), bytes.size());
    }
  }

  template <class Work>
  void try_to(const Work& work) {
    try {
      work();
    } catch (const std::bad_alloc&) {
      send(error_message("there is not enough memory for this in a page; take the program"));
    } catch (const std::exception& error) {
      send(error_message(error.what()));
    }
  }

  /// Returns false if the command is for the studio.
  bool open(const Command& command) {
    if (std::holds_alternative<ListFolder>(command)) return true;  // a page has no folders
    if (const auto* const file = std::get_if<OpenFile>(&command)) {
      replace(file->input, file->input, "");
      return true;
    }
    const auto* const upload = std::get_if<OpenUpload>(&command);
    if (upload == nullptr) return false;
    const std::filesystem::path folder =
        std::filesystem::path(folder_of_uploads) / std::to_string(upload->set);
    replace((folder / upload->name).string(), upload->name.empty() ? "the files" : upload->name,
            folder);
    return true;
  }

  void replace(const std::string& input, const std::string& name,
               const std::filesystem::path& folder) {
    send(text_message({{"type", "opening"}, {"name", name}}));
    try {
      ViewedScene scene = view_input(input, parallel_for(threads_));
      studio_.reset();
      send(text_message({{"type", "opened"}, {"name", name}}));
      show(std::move(scene), folder);
      keep_uploads(folder);
    } catch (...) {
      send(text_message({{"type", "opening"}, {"name", nullptr}}));
      std::error_code ignored;
      if (!folder.empty()) std::filesystem::remove_all(folder, ignored);
      throw;
    }
  }

  /// Removes the files of all other sets, which take memory.
  static void keep_uploads(const std::filesystem::path& folder) {
    std::error_code ignored;
    std::vector<std::filesystem::path> others;
    for (const auto& set : std::filesystem::directory_iterator(folder_of_uploads, ignored)) {
      if (set.path() != folder) others.push_back(set.path());
    }
    for (const std::filesystem::path& other : others) {
      std::filesystem::remove_all(other, ignored);
    }
  }

  void show(const std::string& input, const std::filesystem::path& folder) {
    show(view_input(input, parallel_for(threads_)), folder);
  }

  /// Shows a scene. `folder`: where its files are, which a saved scene names by themselves.
  void show(ViewedScene scene, const std::filesystem::path& folder) {
    SceneState state(std::move(scene.description), std::move(scene.scene), parallel_for(threads_));
    if (!folder.empty()) state.set_temporary_folder(folder);
    studio_ = std::make_unique<Studio>(
        std::move(state), scene.keeps_camera, threads_, SceneChanged{},
        [this](std::optional<PageId>, PageMessage message) { send(std::move(message)); },
        std::vector<std::size_t>{}, Studio::Worker::caller);  // a better fit would hold up the page
    studio_->page_opened(page, number_);
  }

  const std::thread::id own_thread_ = std::this_thread::get_id();
  int threads_ = 1;
  std::uint64_t number_ = 0;  ///< of messages of the page
  std::mutex mutex_;          ///< guards outgoing_
  std::vector<PageMessage> outgoing_;
  std::unique_ptr<Studio> studio_;
};

WorkerViewer& viewer() {
  static WorkerViewer one;
  return one;
}

}  // namespace

}  // namespace pellucid::view

extern "C" {

/// Makes the threads that work from here on, and returns how many there are, this one among them.
EMSCRIPTEN_KEEPALIVE int pellucid_make_threads() {
  return pellucid::view::viewer().make_threads();
}

/// Begins with a scene of the page's files, or with none where `input` is empty.
EMSCRIPTEN_KEEPALIVE void pellucid_start(const char* input) {
  pellucid::view::viewer().start(input);
}

/// Takes a message of the page.
EMSCRIPTEN_KEEPALIVE void pellucid_receive(const char* bytes, std::size_t size) {
  pellucid::view::viewer().receive({bytes, size});
}

/// Works for some seconds. Returns 1 while there is more to do.
EMSCRIPTEN_KEEPALIVE int pellucid_advance(double seconds) {
  return pellucid::view::viewer().advance(seconds) ? 1 : 0;
}
}

// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <charconv>
#include <chrono>
#include <map>
#include <memory>
#include <new>
#include <utility>

#include "pellucid/cpu/threads.h"
#include "pellucid/scene/error.h"
#include "server/opener.h"
#include "server/page_messages.h"
#include "server/page_server.h"
#include "server/uploads.h"
#include "studio.h"

namespace pellucid::view {

namespace {

using Clock = std::chrono::steady_clock;

/// A page that is loaded again is away for less than this.
constexpr std::chrono::seconds reload_time{3};

/// The server, the scene that its pages see, and how they choose another one. The thread that runs
/// the server owns all of it.
class Viewer {
 public:
  Viewer(std::optional<ViewedScene> scene, const ViewerOptions& options)
      : options_(options),
        threads_(options.threads > 0 ? options.threads : default_thread_count()),
        uploads_(options.upload_bytes),
        server_(options.port, events(), {}, options.frame_ancestors) {
    if (scene) show(std::move(*scene), nullptr);
    if (options_.open) opener_.emplace(options_.open, sender());
  }

  void run(const std::function<void(const std::string&)>& started,
           const std::function<bool()>& ended) {
    started(server_.address());
    server_.run([&] {
      if (opener_) show_opened();
      const bool is_left = left_ && Clock::now() - *left_ > reload_time;
      return ended() || (options_.ends_with_page && is_left);
    });
  }

 private:
  PageEvents events() {
    PageEvents events;
    events.opened = [this](PageId page) { page_opened(page); };
    events.received = [this](PageId page, std::string_view message) { receive(page, message); };
    events.closed = [this](PageId page, std::size_t pages) { page_closed(page, pages); };
    if (options_.open) {
      events.uploaded = [this](std::string_view path, std::uint64_t bytes) {
        return place_of_upload(path, bytes);
      };
    }
    return events;
  }

  Send sender() {
    return [this](std::optional<PageId> page, PageMessage message) {
      if (page) {
        server_.send(*page, std::move(message));
      } else {
        server_.send_to_all(std::move(message));
      }
    };
  }

  void page_opened(PageId page) {
    left_.reset();
    received_[page] = 0;
    server_.send(page, text_message({{"type", "start"},
                                     {"page", page},
                                     {"has_scene", studio_ != nullptr},
                                     {"can_open", static_cast<bool>(options_.open)},
                                     {"can_list", static_cast<bool>(options_.open)},
                                     {"upload_bytes", options_.upload_bytes}}));
    if (studio_) studio_->page_opened(page, 0);
  }

  void page_closed(PageId page, std::size_t pages) {
    received_.erase(page);
    if (studio_) studio_->page_closed(page, pages);
    if (pages == 0) left_ = Clock::now();
  }

  void receive(PageId page, std::string_view message) {
    const std::uint64_t number = ++received_[page];
    try {
      Command command = parse_command(message);
      if (ask_opener(page, command)) {
        if (studio_) studio_->skip(page, number);
      } else if (studio_) {
        studio_->receive(page, std::move(command), message.size(), number);
      }
    } catch (const Error& error) {
      refuse(page, number, error.what());
    } catch (const std::bad_alloc&) {
      refuse(page, number, "there is not enough memory for this message");
    }
  }

  void refuse(PageId page, std::uint64_t number, std::string_view why) {
    server_.send(page, error_message(why));
    if (studio_) studio_->skip(page, number);
  }

  /// Returns false if the command is for the studio.
  bool ask_opener(PageId page, const Command& command) {
    const auto* const folder = std::get_if<ListFolder>(&command);
    const auto* const file = std::get_if<OpenFile>(&command);
    const auto* const upload = std::get_if<OpenUpload>(&command);
    if (folder == nullptr && file == nullptr && upload == nullptr) return false;
    if (!opener_) throw Error("this page shows the scene of a program, and opens no files");
    if (folder != nullptr) opener_->list(page, folder->folder);
    if (file != nullptr) opener_->open(page, {file->input, file->input});
    if (upload != nullptr) {
      const std::filesystem::path path = uploads_.find(upload->set, upload->name);
      const std::string name = upload->name.empty() ? "the files" : upload->name;
      opener_->open(page, {path.string(), name, uploads_.folder(upload->set), upload->set});
    }
    return true;
  }

  std::filesystem::path place_of_upload(std::string_view path, std::uint64_t bytes) {
    const std::size_t slash = path.find('/');
    int set = -1;
    const char* const end = path.data() + std::min(slash, path.size());
    if (slash == path.npos || std::from_chars(path.data(), end, set).ptr != end || set < 0) {
      throw Error("upload: the address has no number of a set");
    }
    return uploads_.place(set, percent_decoded(path.substr(slash + 1)), bytes);
  }

  void show_opened() {
    std::optional<OpenedFile> opened = opener_->take();
    if (!opened) return;
    uploads_.keep(opened->request.set);
    studio_.reset();  // its last messages come before the next one
    folder_ = opened->request.folder;
    server_.send_to_all(text_message({{"type", "opened"}, {"name", opened->request.name}}));
    show(std::move(opened->scene), folder_.get());
    for (const auto& [page, number] : received_) studio_->page_opened(page, number);
  }

  /// `folder`: where the data are, for as long as they are shown; null: where they stay.
  void show(ViewedScene scene, const TemporaryFolder* folder) {
    SceneState state(std::move(scene.description), std::move(scene.scene), parallel_for(threads_));
    if (folder != nullptr) state.set_temporary_folder(folder->path());
    studio_ = std::make_unique<Studio>(std::move(state), scene.keeps_camera, threads_,
                                       options_.changed, sender(), std::move(scene.quick_layers),
                                       Studio::Worker::own_thread, std::move(scene.asked));
  }

  ViewerOptions options_;
  int threads_;
  Uploads uploads_;
  std::shared_ptr<const TemporaryFolder> folder_;
  std::optional<Clock::time_point> left_;
  std::map<PageId, std::uint64_t> received_;  ///< number of messages of each page
  PageServer server_;
  std::unique_ptr<Studio> studio_;
  std::optional<Opener> opener_;
};

}  // namespace

void run_viewer(std::optional<ViewedScene> scene, const ViewerOptions& options,
                const std::function<void(const std::string& address)>& started,
                const std::function<bool()>& ended) {
  Viewer(std::move(scene), options).run(started, ended);
}

}  // namespace pellucid::view

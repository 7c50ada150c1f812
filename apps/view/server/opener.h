// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "page_server.h"
#include "pellucid/io/internal/temporary_folder.h"
#include "view/viewer.h"

namespace pellucid::view {

/// A file to be read for the pages.
struct OpenRequest {
  std::string input, name;  ///< name: how pages call it
  /// The folder of files that were uploaded, and the number of their set; null: they were not.
  std::shared_ptr<const TemporaryFolder> folder{};
  int set = -1;
};
/// A file that was read.
struct OpenedFile {
  OpenRequest request;
  ViewedScene scene;
};

/// Lists folders and reads files on a thread of its own, so that pages are served meanwhile.
class Opener {
 public:
  using Send = std::function<void(std::optional<PageId>, PageMessage)>;

  Opener(OpenInput open, Send send);
  /// Waits for the file that is being read.
  ~Opener();
  Opener(const Opener&) = delete;
  Opener& operator=(const Opener&) = delete;

  // Safe to call from any thread:

  /// Sends the page a list of the folder.
  void list(PageId page, std::string folder);
  /// Reads a file; tells all pages that it begins, and the page what fails.
  void open(PageId page, OpenRequest request);
  /// Returns a file that was read since the last call, if any.
  std::optional<OpenedFile> take();

 private:
  void run();
  void carry_out(const std::function<void()>& task, PageId page);
  void read(OpenRequest request);

  OpenInput open_;
  Send send_;
  std::mutex mutex_;  ///< of the following
  std::condition_variable wakes_;
  std::deque<std::pair<PageId, std::function<void()>>> tasks_;
  std::optional<OpenedFile> opened_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace pellucid::view

// SPDX-License-Identifier: Apache-2.0
#include "opener.h"

#include <exception>
#include <new>
#include <utility>

#include "folders.h"
#include "page_messages.h"
#include "pellucid/scene/error.h"

namespace pellucid::view {

namespace {

/// A page that asks for more, while a file is read, is not ours.
constexpr std::size_t max_waiting = 64;

}  // namespace

Opener::Opener(OpenInput open, Send send) : open_(std::move(open)), send_(std::move(send)) {
  thread_ = std::thread([this] { run(); });
}

Opener::~Opener() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  wakes_.notify_one();
  thread_.join();
}

void Opener::list(PageId page, std::string folder) {
  const std::lock_guard lock(mutex_);
  if (tasks_.size() >= max_waiting) return;
  tasks_.emplace_back(page, [this, page, folder = std::move(folder)] {
    send_(page, text_message(folder_json(folder)));
  });
  wakes_.notify_one();
}

void Opener::open(PageId page, OpenRequest request) {
  const std::lock_guard lock(mutex_);
  if (tasks_.size() >= max_waiting) return;
  tasks_.emplace_back(page, [this, request = std::move(request)] { read(request); });
  wakes_.notify_one();
}

std::optional<OpenedFile> Opener::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(opened_, {});
}

void Opener::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    wakes_.wait(lock, [this] { return ended_ || !tasks_.empty(); });
    if (ended_) return;
    const auto [page, task] = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    carry_out(task, page);
    lock.lock();
  }
}

void Opener::carry_out(const std::function<void()>& task, PageId page) {
  std::string failure;
  try {
    return task();
  } catch (const Error& error) {
    failure = error.what();
  } catch (const std::bad_alloc&) {
    failure = "there is not enough memory for this file";
  } catch (const std::exception& error) {
    failure = std::string(error.what()) + "; this is a defect of pellucid, please report it";
  }
  send_({}, text_message({{"type", "opening"}, {"name", nullptr}}));
  send_(page, error_message(failure));
}

void Opener::read(OpenRequest request) {
  send_({}, text_message({{"type", "opening"}, {"name", request.name}}));
  ViewedScene scene = open_(request.input);
  const std::lock_guard lock(mutex_);
  opened_.emplace(OpenedFile{std::move(request), std::move(scene)});
}

}  // namespace pellucid::view

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "pellucid/cpu/threads.h"
#include "tests/cuda/device_matrix.h"
#include "tests/device_check/parts.h"
#include "tests/device_check/rows.h"

namespace pellucid::device_check {
namespace {

using scenes::GalleryEntry;

/// Every n-th scene whose file is there.
std::vector<GalleryEntry> chosen_scenes(const Arguments& arguments,
                                        std::vector<std::string>& missing) {
  std::vector<GalleryEntry> chosen;
  int number = 0;
  for (GalleryEntry& entry : scenes::gallery()) {
    if (number++ % arguments.every != 0) continue;
    if (!entry.why_missing().empty()) {
      missing.push_back(entry.name);
    } else {
      chosen.push_back(std::move(entry));
    }
  }
  return chosen;
}

/// Calls body(entry, exhibit, camera) on all threads, the first cameras of all scenes first. Throws
/// the first exception of a body, after the calls that have begun.
template <class Body>
void for_each_view(const std::vector<GalleryEntry>& entries, const Arguments& arguments,
                   const Body& body) {
  const std::size_t views = entries.size() * static_cast<std::size_t>(arguments.cameras);
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failed;
  const auto work = [&] {
    for (std::size_t i = next++; i < views; i = next++) {
      try {
        const GalleryEntry& entry = entries[i % entries.size()];
        const scenes::Exhibit exhibit = entry.make(arguments.size);
        const std::size_t camera = i / entries.size();
        if (camera < exhibit.cameras.size()) body(entry, exhibit, camera);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failed) failed = std::current_exception();
        next = views;
      }
    }
  };
  const int threads = arguments.threads > 0 ? arguments.threads : default_thread_count();
  std::vector<std::jthread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  others.clear();  // joins them
  if (failed) std::rethrow_exception(failed);
}

std::size_t files_in(const std::filesystem::path& folder) {
  if (folder.empty() || !std::filesystem::exists(folder)) return 0;
  const std::filesystem::directory_iterator files(folder);
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

}  // namespace

bool make_truths(const Arguments& arguments) {
  std::vector<std::string> missing;
  const std::vector<GalleryEntry> entries = chosen_scenes(arguments, missing);
  for_each_view(entries, arguments, [&](const auto&, const auto& exhibit, std::size_t camera) {
    scenes::make_truth(exhibit, camera, arguments.size, arguments.truths);
  });
  for (const std::string& name : missing) std::printf("without the scene %s\n", name.c_str());
  return true;
}

bool check_matrix(const Arguments& arguments) {
  RowWriter rows(arguments.rows);
  std::vector<std::string> missing;
  const std::vector<GalleryEntry> entries = chosen_scenes(arguments, missing);
  const std::size_t carried = files_in(arguments.truths);
  rows.add({{"kind", "matrix"}, {"scenes", entries.size()}, {"missing", missing}});
  std::atomic<int> bad{0}, on_device{0};
  for_each_view(entries, arguments,
                [&](const GalleryEntry& entry, const scenes::Exhibit& exhibit, std::size_t camera) {
                  const scenes::DeviceRow row = scenes::check_on_device(
                      entry, exhibit, camera, arguments.device, arguments.size, arguments.truths);
                  if (!row.faults.empty()) ++bad;
                  if (row.on_device) ++on_device;
                  for (const std::string& fault : row.faults) {
                    std::printf("%s, %s\n", row.scene.c_str(), fault.c_str());
                  }
                  rows.add({{"kind", "view"},
                            {"scene", row.scene},
                            {"camera", row.camera},
                            {"on_device", row.on_device},
                            {"frames", row.frames},
                            {"pixels", row.pixels},
                            {"in_double", row.in_double},
                            {"left", row.left},
                            {"over", row.over},
                            {"over_reported", row.over_reported},
                            {"faults", row.faults}});
                });
  rows.add(
      {{"kind", "truths"}, {"carried", carried}, {"made", files_in(arguments.truths) - carried}});
  return bad == 0 && on_device > 0;
}

}  // namespace pellucid::device_check

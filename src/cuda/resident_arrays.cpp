// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cuda/resident_arrays.h"

#include <type_traits>
#include <vector>

namespace pellucid {
namespace {

/// Frames after which an array that is not used is released: some looks may take turns.
constexpr std::uint64_t frames_kept = 4;

template <class T>
std::size_t bytes_of(const T*, std::int64_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  return sizeof(T) * static_cast<std::size_t>(count);
}

}  // namespace

ResidentArrays::~ResidentArrays() {
  clear();
}

void* ResidentArrays::find(const Key& key, const void* from,
                           const std::shared_ptr<const void>& owner) {
  if (const auto found = entries_.find(key); found != entries_.end()) {
    found->second.owner = owner;
    found->second.last_used = frame_;
    return found->second.memory;
  }
  void* const memory = backend_.allocate(key.second);
  try {
    backend_.upload(memory, from, key.second);
    entries_.emplace(key, Entry{memory, owner, frame_});
  } catch (...) {
    backend_.release(memory);
    throw;
  }
  uploaded_ += key.second;
  kept_ += key.second;
  return memory;
}

DeviceScene ResidentArrays::resident(const DeviceScene& host,
                                     const std::shared_ptr<const void>& owner) {
  DeviceScene scene = host;
  const auto move = [&]<class T>(const T*& pointer, std::int64_t count) {
    pointer = static_cast<const T*>(find({pointer, bytes_of(pointer, count)}, pointer, owner));
  };
  for_each_array(scene, move);
  if (host.function.tables > 0) {
    const ChannelTable<double>* const tables = host.function.table;
    std::vector<ChannelTable<double>> moved(tables, tables + host.function.tables);
    for (ChannelTable<double>& table : moved) for_each_table_array(table, move);
    const std::size_t bytes = bytes_of(tables, host.function.tables);
    scene.function.table =
        static_cast<const ChannelTable<double>*>(find({tables, bytes}, moved.data(), owner));
  }
  return scene;
}

void ResidentArrays::end_frame() {
  ++frame_;
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    if (entry->second.last_used + frames_kept >= frame_) {
      ++entry;
      continue;
    }
    backend_.release(entry->second.memory);
    kept_ -= entry->first.second;
    entry = entries_.erase(entry);
  }
}

void ResidentArrays::clear() noexcept {
  for (const auto& [key, entry] : entries_) backend_.release(entry.memory);
  entries_.clear();
  kept_ = 0;
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include "device_cache.h"

#include <utility>

namespace pellucid {

CachedDevice::CachedDevice(std::unique_ptr<DeviceBackend> backend)
    : backend_(std::move(backend)), arrays_(*backend_) {}

CachedDevice::~CachedDevice() {
  for (Buffer* buffer : {&color_, &depth_, &error_, &proved_, &in_double_, &left_, &counts_}) {
    if (buffer->memory != nullptr) backend_->release(buffer->memory);
  }
}

template <class T>
T* CachedDevice::fit(Buffer& buffer, std::size_t count) {
  const std::size_t bytes = sizeof(T) * count;
  if (buffer.bytes < bytes) {
    if (buffer.memory != nullptr) backend_->release(buffer.memory);
    buffer = {};
    buffer.memory = backend_->allocate(bytes);
    buffer.bytes = bytes;
  }
  return static_cast<T*>(buffer.memory);
}

DeviceTask CachedDevice::prepare(ImageSize size, bool depth, bool error) {
  const std::size_t pixels =
      static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  DeviceTask task;
  task.image.width = size.width;
  task.image.color = fit<float>(color_, 4 * pixels);
  backend_->clear(task.image.color, 4 * pixels * sizeof(float));
  if (depth) {
    task.image.depth = fit<float>(depth_, pixels);
    backend_->clear(task.image.depth, pixels * sizeof(float));
  }
  if (error) {
    task.image.error = fit<float>(error_, pixels);
    task.image.proved = fit<std::uint8_t>(proved_, pixels);
    backend_->clear(task.image.error, pixels * sizeof(float));
    backend_->clear(task.image.proved, pixels);
  }
  task.in_double.pixel = fit<std::uint32_t>(in_double_, pixels);
  task.left.pixel = fit<std::uint32_t>(left_, pixels);
  task.counts = fit<DeviceCounts>(counts_, 1);
  return task;
}

std::shared_ptr<CachedDevice> DeviceCache::find(Device device) {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<CachedDevice>& kept = device == Device::cuda ? cuda_ : emulated_;
  if (!kept) {
    kept = std::make_shared<CachedDevice>(device == Device::cuda ? make_cuda_backend()
                                                                 : make_emulated_backend());
  }
  return kept;
}

void DeviceCache::clear() {
  const std::lock_guard lock(mutex_);
  cuda_.reset();
  emulated_.reset();
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace pellucid {

/// The values of a volume in one contiguous array. The array owns its buffer or shares memory that
/// someone else owns, such as a mapped file. Copies share the values until one of them is written
/// to.
template <class T>
class DataArray {
 public:
  using value_type = T;
  static_assert(std::is_arithmetic_v<T>);

  DataArray() = default;
  /// Allocates `count` zeros, which take no memory before they are written to. Throws
  /// std::bad_alloc.
  explicit DataArray(std::size_t count) : size_(count) {
    if (count == 0) return;
    writable_ = static_cast<T*>(std::calloc(count, sizeof(T)));
    if (writable_ == nullptr) throw std::bad_alloc();
    elements_ = std::shared_ptr<const T>(writable_, [](const T* p) {
      std::free(const_cast<T*>(p));  // as calloc gave it
    });
  }
  /// Takes ownership of the vector's buffer, without a copy.
  DataArray(std::vector<T> values) : size_(values.size()) {
    const auto kept = std::make_shared<std::vector<T>>(std::move(values));
    writable_ = kept->data();
    elements_ = std::shared_ptr<const T>(kept, writable_);
  }
  /// Shares `count` elements, which must not change while any owner lives.
  DataArray(std::shared_ptr<const T> elements, std::size_t count)
      : elements_(std::move(elements)), size_(count) {}

  DataArray(const DataArray&) = default;
  DataArray& operator=(const DataArray&) = default;
  DataArray(DataArray&& other) noexcept { swap(other); }
  DataArray& operator=(DataArray&& other) noexcept {
    DataArray(std::move(other)).swap(*this);
    return *this;
  }
  ~DataArray() = default;

  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }
  const T* data() const noexcept { return elements_.get(); }
  const T* begin() const noexcept { return data(); }
  const T* end() const noexcept { return data() + size_; }
  const T& operator[](std::size_t i) const noexcept { return data()[i]; }

  /// Returns the elements for writing. Copies them first if they are shared or owned by someone
  /// else.
  std::span<T> writable() {
    if (size_ > 0 && (writable_ == nullptr || elements_.use_count() > 1)) {
      *this = DataArray(std::vector<T>(begin(), end()));
    }
    return {writable_, size_};
  }

  friend bool operator==(const DataArray& a, const DataArray& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  void swap(DataArray& other) noexcept {
    std::swap(elements_, other.elements_);
    std::swap(writable_, other.writable_);
    std::swap(size_, other.size_);
  }

  std::shared_ptr<const T> elements_;
  T* writable_ = nullptr;  ///< the same elements; null: not ours to write
  std::size_t size_ = 0;
};

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace pellucid {

/// Lets `work` fill so many bytes in a process of its own, for libraries that a damaged file brings
/// down, and gives them. Null where it returns false, throws anything but Error, crashes, or takes
/// far more time or memory than the bytes, and a file of `file_bytes`, may need: 3 s of a
/// processor, 300 s in which it neither runs nor waits for a processor, and a second more of both
/// for each 10 MB of bytes or 160 kB of the file; twice the bytes, 64 times the file and 1 GiB. It
/// ends with the thread that waits. What it prints is not seen. Throws Error where `work` does,
/// with the same words (of 1000 bytes at most), and std::bad_alloc where there is no memory for the
/// bytes or no process to be had.
///
/// Libraries that `work` needs are best loaded by it, as modules: locks that threads of this
/// process hold are held for ever in the other one, and many a library has threads from its first
/// moment. That takes 20 to 60 ms each time. A program whose own threads load libraries (dlopen) at
/// the same moment may still leave the loader's lock held there, and wait for the 300 s.
std::shared_ptr<std::byte> run_in_child(std::size_t bytes,
                                        const std::function<bool(std::span<std::byte>)>& work,
                                        std::uintmax_t file_bytes = 0);

/// Bytes that another process wrote; none where it failed.
struct ChildBytes {
  std::shared_ptr<std::byte> data;
  std::size_t size = 0;
  explicit operator bool() const noexcept { return data != nullptr; }
  std::span<const std::byte> span() const noexcept { return {data.get(), size}; }
};
/// Makes room for the answer, once, in zeros. Throws std::bad_alloc.
using MakeAnswer = std::function<std::span<std::byte>(std::size_t bytes)>;

/// Runs `work` like run_in_child() where it alone knows how long its answer is. It may take
/// `memory` bytes, its answer among them; the seconds grow with the answer too. Returns no bytes
/// where run_in_child() returns null, or where the work makes no answer.
ChildBytes answer_in_child(const std::function<bool(const MakeAnswer&)>& work,
                           std::uintmax_t file_bytes, std::uintmax_t memory);

}  // namespace pellucid

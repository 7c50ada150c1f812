// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>

#include "mpi_module.h"
#include "pellucid/cluster/communicator.h"
#include "pellucid/io/internal/module.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

constexpr Module module{"pellucid_mpi.so", "passes messages between ranks",
                        "MPI (Debian: libopenmpi-dev)"};

const MpiModule& functions() {
  return *reinterpret_cast<GetMpiModule*>(module_function(module, mpi_module_name))();
}

class MpiCommunicator : public Communicator {
 public:
  explicit MpiCommunicator(std::optional<int> handle) : mpi_(functions()) {
    std::string error;
    link_ = mpi_.open(handle ? &*handle : nullptr, error);
    check(error);
  }
  ~MpiCommunicator() override { mpi_.close(link_); }

  int rank() const noexcept override { return mpi_.rank(link_); }
  int size() const noexcept override { return mpi_.size(link_); }

  std::vector<std::string> gather_all(const std::string& own,
                                      const std::function<void()>& waiting) override {
    std::vector<std::string> all;
    std::string error;
    mpi_.gather_all(link_, own, waiting, all, error);
    check(error);
    return all;
  }
  void reduce_all(std::span<double> values, Reduction reduction) override {
    std::string error;
    mpi_.reduce_all(link_, values.data(), values.size(), reduction, error);
    check(error);
  }
  void broadcast(std::span<float> values) override {
    std::string error;
    mpi_.broadcast(link_, values.data(), values.size(), error);
    check(error);
  }
  void composite(std::span<RayPixel> pixels, int place) override {
    composite(pixels, place, false);
  }
  void composite_in_front(std::span<RayPixel> pixels, int place) override {
    composite(pixels, place, true);
  }
  [[noreturn]] void abort(int status) noexcept override {
    mpi_.abort(link_, status);
    std::_Exit(status);
  }
  void send(int to, const RankSignal& signal) override {
    std::string error;
    mpi_.send(link_, to, signal, error);
    check(error);
  }
  std::optional<RankSignal> receive() override {
    RankSignal signal;
    std::string error;
    const bool came = mpi_.receive(link_, signal, error);
    check(error);
    return came ? std::optional(signal) : std::nullopt;
  }

 private:
  static void check(const std::string& error) {
    if (!error.empty()) throw Error("MPI: " + error);
  }
  void composite(std::span<RayPixel> pixels, int place, bool in_front) {
    std::string error;
    mpi_.composite(link_, pixels.data(), pixels.size(), place, in_front, error);
    check(error);
  }

  const MpiModule& mpi_;
  void* link_ = nullptr;
};

}  // namespace

std::unique_ptr<Communicator> mpi_communicator(std::optional<int> handle) {
  return std::make_unique<MpiCommunicator>(handle);
}

}  // namespace pellucid

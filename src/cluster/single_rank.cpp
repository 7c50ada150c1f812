// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>

#include "pellucid/cluster/communicator.h"

namespace pellucid {
namespace {

class SingleRank : public Communicator {
 public:
  int rank() const noexcept override { return 0; }
  int size() const noexcept override { return 1; }
  std::vector<std::string> gather_all(const std::string& own,
                                      const std::function<void()>& /*waiting*/) override {
    return {own};
  }
  void reduce_all(std::span<double> /*values*/, Reduction /*reduction*/) override {}
  void broadcast(std::span<float> /*values*/) override {}
  void composite(std::span<RayPixel> /*pixels*/, int /*place*/) override {}
  void composite_in_front(std::span<RayPixel> pixels, int /*place*/) override {
    std::ranges::fill(pixels, RayPixel{});
  }
  [[noreturn]] void abort(int status) noexcept override { std::_Exit(status); }
  void send(int /*to*/, const RankSignal& /*signal*/) override {}
  std::optional<RankSignal> receive() override { return {}; }
};

}  // namespace

std::unique_ptr<Communicator> single_rank() {
  return std::make_unique<SingleRank>();
}

bool is_under_mpi() noexcept {
  // As Open MPI, MPICH and its kin, and Slurm's PMI set it.
  for (const char* const name :
       {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK", "MPI_LOCALNRANKS"}) {
    if (std::getenv(name) != nullptr) return true;
  }
  return false;
}

}  // namespace pellucid

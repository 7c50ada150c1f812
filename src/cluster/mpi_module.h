// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "pellucid/cluster/communicator.h"

namespace pellucid {

/// The message passing that the module pellucid_mpi.so does with MPI. A program that does not use
/// it links no MPI, and does not load it. No exception leaves a function: what goes wrong is put
/// into `error`. `link` is what open() returned.
struct MpiModule {
  void* (*open)(const int* fortran_handle, std::string& error);
  void (*close)(void* link);
  int (*rank)(void* link);
  int (*size)(void* link);
  void (*gather_all)(void* link, const std::string& own, const std::function<void()>& waiting,
                     std::vector<std::string>& all, std::string& error);
  void (*reduce_all)(void* link, double* values, std::size_t count,
                     Communicator::Reduction reduction, std::string& error);
  void (*broadcast)(void* link, float* values, std::size_t count, std::string& error);
  void (*composite)(void* link, RayPixel* pixels, std::size_t count, int place, bool in_front,
                    std::string& error);
  void (*abort)(void* link, int status);
  void (*send)(void* link, int to, const RankSignal& signal, std::string& error);
  bool (*receive)(void* link, RankSignal& signal, std::string& error);
};

/// The module's only function, by this name, which has its version.
using GetMpiModule = const MpiModule*();
inline constexpr const char* mpi_module_name = "pellucid_mpi_module_1";

}  // namespace pellucid

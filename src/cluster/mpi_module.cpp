// SPDX-License-Identifier: Apache-2.0
//
// The module's functions. No exception leaves them.
#include "mpi_module.h"

#include <exception>

#include "mpi_link.h"

namespace pellucid {
namespace {

template <class Work>
void answer(std::string& error, const Work& work) {
  try {
    work();
  } catch (const std::exception& e) {
    error = e.what();
  }
}

MpiLink& of(void* link) {
  return *static_cast<MpiLink*>(link);
}

void* open(const int* fortran_handle, std::string& error) {
  void* link = nullptr;
  answer(error, [&] { link = new MpiLink(fortran_handle); });
  return link;
}
void close(void* link) {
  delete static_cast<MpiLink*>(link);
}
int rank(void* link) {
  return of(link).rank();
}
int size(void* link) {
  return of(link).size();
}
void gather_all(void* link, const std::string& own, const std::function<void()>& waiting,
                std::vector<std::string>& all, std::string& error) {
  answer(error, [&] { all = of(link).gather_all(own, waiting); });
}
void reduce_all(void* link, double* values, std::size_t count, Communicator::Reduction reduction,
                std::string& error) {
  answer(error, [&] { of(link).reduce_all({values, count}, reduction); });
}
void broadcast(void* link, float* values, std::size_t count, std::string& error) {
  answer(error, [&] { of(link).broadcast({values, count}); });
}
void composite(void* link, RayPixel* pixels, std::size_t count, int place, bool in_front,
               std::string& error) {
  answer(error, [&] { of(link).composite({pixels, count}, place, in_front); });
}
void abort(void* link, int status) {
  of(link).abort(status);
}
void send(void* link, int to, const RankSignal& signal, std::string& error) {
  answer(error, [&] { of(link).send(to, signal); });
}
bool receive(void* link, RankSignal& signal, std::string& error) {
  bool came = false;
  answer(error, [&] { came = of(link).receive(signal); });
  return came;
}

constexpr MpiModule functions{open,      close,     rank,  size, gather_all, reduce_all,
                              broadcast, composite, abort, send, receive};

}  // namespace
}  // namespace pellucid

extern "C" __attribute__((visibility("default"))) const pellucid::MpiModule*
pellucid_mpi_module_1() {
  return &pellucid::functions;
}

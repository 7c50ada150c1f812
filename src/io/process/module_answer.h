// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <new>
#include <string>

namespace pellucid {

/// Does a module's work; what goes wrong is put into words, for no exception leaves a module.
/// `remedy`: what to do where there is not enough memory.
template <class Work>
void answer(std::string& error, const char* remedy, const Work& work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    error = std::string("not enough memory for the data; ") + remedy;
  } catch (const std::exception& e) {
    error = e.what();
  }
}

}  // namespace pellucid

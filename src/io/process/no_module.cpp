// SPDX-License-Identifier: Apache-2.0
//
// Stands in for module.cpp where a program loads no modules: in a page.
#include "pellucid/io/internal/module.h"
#include "pellucid/scene/error.h"

namespace pellucid {

std::mutex& loading_modules() {
  static std::mutex mutex;
  return mutex;
}

std::filesystem::path module_file(const Module& module) {
  throw Error(std::string("a page has no module that ") + module.does +
              "; take the program for it");
}

void* module_function(const Module& module, const char*) {
  module_file(module);
  return nullptr;
}

}  // namespace pellucid

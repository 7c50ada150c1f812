// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/internal/module.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

// A build without any module does not name their folders.
#ifndef PELLUCID_MODULES_INSTALLED
#define PELLUCID_MODULES_FROM_PROGRAM ""
#define PELLUCID_MODULES_INSTALLED ""
#define PELLUCID_MODULES_PACKAGED ""
#endif

/// Returns the folder of the shared object that holds this code; empty if it is the program.
fs::path folder_of_object(const fs::path& program) {
  Dl_info info{};
  std::error_code error;
  if (dladdr(reinterpret_cast<const void*>(&loading_modules), &info) == 0) return {};
  const fs::path object = fs::canonical(info.dli_fname, error);
  return error || object == program ? fs::path() : object.parent_path();
}

std::array<fs::path, 6> folders() {
  const char* const named = std::getenv("PELLUCID_MODULES");
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path object = folder_of_object(program);
  // The Python module is lib/python3.N/dist-packages/pellucid/_pellucid.so of an installation, or
  // has the modules below it in a wheel.
  return {named == nullptr ? fs::path() : fs::path(named),
          object.empty() ? fs::path() : object / "modules",
          object.empty() ? fs::path() : object / "../../../pellucid",
          program.empty() ? fs::path() : program.parent_path() / PELLUCID_MODULES_FROM_PROGRAM,
          PELLUCID_MODULES_INSTALLED,
          PELLUCID_MODULES_PACKAGED};
}

/// Returns whether the loader says that there is no memory for a library.
bool is_of_memory(const std::string& why) {
  constexpr std::array said{"failed to map segment", "annot allocate memory",
                            "annot map zero-fill"};
  return std::ranges::any_of(said, [&](const char* part) { return why.find(part) != why.npos; });
}

}  // namespace

std::mutex& loading_modules() {
  static std::mutex mutex;
  return mutex;
}

fs::path module_file(const Module& module) {
  for (const fs::path& folder : folders()) {
    std::error_code error;
    fs::path file = folder / module.file;
    if (folder.is_absolute() && fs::exists(file, error)) return file;
  }
  throw Error(std::string("the module ") + module.file + ", which " + module.does +
              ", is not there; build it, which needs " + module.needs +
              ", or name its folder in the environment variable PELLUCID_MODULES");
}

void* module_function(const Module& module, const char* name) {
  const fs::path file = module_file(module);
  const std::lock_guard lock(loading_modules());
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const std::string why = dlerror();
    throw Error(std::string("the module ") + module.file + ", which " + module.does +
                ", does not load: " + why +
                (is_of_memory(why) ? "; there is too little memory for it: make room, or raise the "
                                     "limit of address space (ulimit -v)"
                                   : std::string("; install ") + module.needs));
  }
  void* const function = dlsym(library, name);
  if (function == nullptr) {
    throw Error(file.string() + ": is of another version; install them together");
  }
  return function;
}

}  // namespace pellucid

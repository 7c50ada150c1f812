// SPDX-License-Identifier: Apache-2.0
#include "vtk_module.h"

#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <system_error>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

constexpr const char* file_name = "pellucid_vtk.so";

#ifdef PELLUCID_HAVE_VTK
constexpr bool built = true;
#else
constexpr bool built = false;
#define PELLUCID_MODULES_FROM_PROGRAM ""
#define PELLUCID_MODULES_INSTALLED ""
#endif

std::array<fs::path, 3> folders() {
  const char* const named = std::getenv("PELLUCID_MODULES");
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return {named == nullptr ? fs::path() : fs::path(named),
          program.empty() ? fs::path() : program.parent_path() / PELLUCID_MODULES_FROM_PROGRAM,
          PELLUCID_MODULES_INSTALLED};
}

ReadWithVtk& load() {
  if (!built) {
    throw Error(
        "this build does not read VTK's and Exodus files; build with VTK (Debian: libvtk9-dev) and "
        "-DPELLUCID_WITH_VTK=ON");
  }
  for (const fs::path& folder : folders()) {
    std::error_code error;
    if (!folder.is_absolute() || !fs::exists(folder / file_name, error)) continue;
    // Never unloaded: what it read is freed by its code.
    void* const module = dlopen((folder / file_name).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) throw Error(std::string("VTK does not load: ") + dlerror());
    void* const function = dlsym(module, read_with_vtk_name);
    if (function == nullptr) {
      throw Error((folder / file_name).string() + ": is of another version; install them together");
    }
    return *reinterpret_cast<ReadWithVtk*>(function);
  }
  throw Error(std::string("the module ") + file_name +
              " that reads VTK's and Exodus files is not there; install it, or name its folder in "
              "the environment variable PELLUCID_MODULES");
}

}  // namespace

ReadWithVtk& vtk_module() {
  static ReadWithVtk& function = load();
  return function;
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>

namespace pellucid {

/// A part of this library in a file of its own, which is loaded when it is needed: the libraries
/// that it is linked to would otherwise multiply the time that every start of a program takes.
struct Module {
  const char* file;   ///< "pellucid_vtk.so"
  const char* does;   ///< "reads VTK's and Exodus files"
  const char* needs;  ///< the library that it is built with: "VTK (Debian: libvtk9-dev)"
};

/// Finds the module's file: in the folder that the environment variable PELLUCID_MODULES names,
/// then where an installation has it as seen from the shared object that holds this code, and from
/// the program, then where this library was to be installed, then where the Debian package has it.
/// Throws Error where it is in none of them.
std::filesystem::path module_file(const Module& module);

/// Returns a function of the module, loaded by the first call and kept, never unloaded: what it
/// read is freed by its code. Throws Error as module_file(), where it does not load, or where it
/// lacks the function, whose name has its version.
void* module_function(const Module& module, const char* name);

/// Returns the lock that is held while a module is loaded, and by whoever forks a process that
/// loads one: the loader's own lock, held by another thread at that moment, would be held there for
/// ever.
std::mutex& loading_modules();

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkLogger.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <memory>
#include <mutex>
#include <string>

namespace pellucid {

/// While it lives, what VTK would print is kept instead. One at a time: others wait.
class VtkMessages {
 public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  /// Returns the first error so far, on one line, without the place in VTK's sources; empty: none.
  std::string error() const;
  /// Throws Error with it, where there is one.
  void check() const;

 private:
  class Window;

  std::unique_lock<std::mutex> lock_;
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkSmartPointer<Window> window_;
  vtkLogger::Verbosity verbosity_;
};

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#include "vtk_messages.h"

#include <vtkObjectFactory.h>

#include <algorithm>
#include <string_view>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

/// Leaves out the addresses of objects: "vtkReader(0x5)".
void erase_addresses(std::string& text) {
  for (std::size_t at = 0; (at = text.find("(0x", at)) != std::string::npos;) {
    const std::size_t end = text.find(')', at);
    if (end == std::string::npos) return;
    text.erase(at, end - at + 1);
  }
}

/// "ERROR: In FILE, line 9\nvtkReader (0x5): what is wrong\n\n": what is wrong.
std::string what_is_wrong(std::string text) {
  if (text.starts_with("Generic Warning")) {
    text.erase(0, text.find('\n'));
  } else if (const std::size_t object = text.find("): "); object != std::string::npos) {
    text.erase(0, object + 3);
  }
  erase_addresses(text);
  std::string line;
  for (const char c : text) {
    const bool space = static_cast<unsigned char>(c) <= ' ' || c == '\x7f';
    if (!space) {
      line += static_cast<unsigned char>(c) < 0x80 ? c : '?';  // bytes of a damaged file
    } else if (!line.empty() && line.back() != ' ') {
      line += ' ';
    }
  }
  constexpr std::size_t longest = 240;
  if (line.size() > longest) line = line.substr(0, longest) + "...";
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  return line;
}

}  // namespace

class VtkMessages::Window : public vtkOutputWindow {
 public:
  static Window* New();

  void DisplayText(const char*) override {}
  void DisplayWarningText(const char* text) override { take_warning(text); }
  void DisplayGenericWarningText(const char* text) override { take_warning(text); }
  void DisplayDebugText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    const std::lock_guard lock(mutex_);
    if (error_.empty() && text != nullptr) error_ = text;
  }

  std::string error() {
    const std::lock_guard lock(mutex_);
    return error_;
  }

 private:
  /// Takes a warning for an error where VTK gives what memory holds: for a legacy text that is cut
  /// off.
  void take_warning(const char* text) {
    if (text != nullptr && std::string_view(text).find("Error reading") != std::string_view::npos) {
      DisplayErrorText(text);
    }
  }

  std::mutex mutex_;
  std::string error_;
};

vtkStandardNewMacro(VtkMessages::Window)

    VtkMessages::VtkMessages()
    : lock_(one_at_a_time()),
      before_(vtkOutputWindow::GetInstance()),
      window_(vtkSmartPointer<Window>::New()),
      verbosity_(vtkLogger::GetCurrentVerbosityCutoff()) {
  vtkOutputWindow::SetInstance(window_);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
}

VtkMessages::~VtkMessages() {
  vtkLogger::SetStderrVerbosity(verbosity_);
  vtkOutputWindow::SetInstance(before_);
}

std::string VtkMessages::error() const {
  return what_is_wrong(window_->error());
}

void VtkMessages::check() const {
  if (const std::string what = error(); !what.empty()) {
    throw Error("the file is cut off or damaged (VTK says: " + what + ")");
  }
}

}  // namespace pellucid

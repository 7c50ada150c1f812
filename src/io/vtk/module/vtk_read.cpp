// SPDX-License-Identifier: Apache-2.0
#include <vtkAlgorithm.h>
#include <vtkInformation.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <string>
#include <vector>

#include "pellucid/scene/error.h"
#include "process/module_answer.h"
#include "vtk/vtk_module.h"
#include "vtk_readers.h"

namespace pellucid {

void refuse_time(const MeshReadOptions& options) {
  if (options.time) throw Error("the file has no steps in time; leave the time out");
}

std::vector<double> times_of(vtkAlgorithm& reader) {
  vtkInformation* const about = reader.GetOutputInformation(0);
  vtkInformationDoubleVectorKey* const steps = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  if (about == nullptr || about->Has(steps) == 0 || about->Length(steps) < 1) return {};
  return {about->Get(steps), about->Get(steps) + about->Length(steps)};
}

void update(vtkAlgorithm& reader, const MeshReadOptions& options, const std::vector<double>& times,
            const VtkMessages& messages, MeshFile& file) {
  if (!times.empty()) {
    file.times = times;
    file.time = file.times[nearest_step(file.times, options.time)];
    reader.UpdateTimeStep(*file.time);
  } else {
    refuse_time(options);
    reader.Update();
  }
  messages.check();
  if (reader.GetErrorCode() != 0) throw Error("the file is cut off or damaged");
}

void update(vtkAlgorithm& reader, const MeshReadOptions& options, const VtkMessages& messages,
            MeshFile& file) {
  reader.UpdateInformation();
  messages.check();
  update(reader, options, times_of(reader), messages, file);
}

}  // namespace pellucid

extern "C" __attribute__((visibility("default"))) void pellucid_read_with_vtk_4(
    const std::filesystem::path& path, pellucid::VtkFormat format,
    const pellucid::MeshReadOptions& options, const pellucid::CheckVtkXml& check,
    pellucid::VtkAnswer& answer) {
  using pellucid::VtkFormat;
  pellucid::answer(answer.error, "the file may be damaged, or split it", [&] {
    const pellucid::VtkMessages messages;
    if (format == VtkFormat::xml) {
      pellucid::read_xml(path, options, check, messages, answer.mesh);
    } else if (format == VtkFormat::legacy) {
      pellucid::read_legacy(path, options, messages, answer.mesh);
    } else {
      pellucid::read_exodus(path, options, messages, answer.mesh);
    }
  });
}

extern "C" __attribute__((visibility("default"))) void pellucid_read_exodus_times_1(
    const std::filesystem::path& path, std::vector<double>& times, std::string& error) {
  pellucid::answer(error, "the file may be damaged, or split it", [&] {
    const pellucid::VtkMessages messages;
    times = pellucid::exodus_times(path, messages);
  });
}

// SPDX-License-Identifier: Apache-2.0
#include <vtkAlgorithm.h>
#include <vtkInformation.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <string>

#include "module_answer.h"
#include "pellucid/scene/error.h"
#include "vtk_module.h"
#include "vtk_readers.h"

namespace pellucid {

void refuse_time(const MeshReadOptions& options) {
  if (options.time) throw Error("the file has no steps in time; leave the time out");
}

void update(vtkAlgorithm& reader, const MeshReadOptions& options, const VtkMessages& messages,
            MeshFile& file) {
  reader.UpdateInformation();
  messages.check();
  vtkInformation* const about = reader.GetOutputInformation(0);
  vtkInformationDoubleVectorKey* const steps = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  if (about != nullptr && about->Has(steps) != 0 && about->Length(steps) > 0) {
    file.times.assign(about->Get(steps), about->Get(steps) + about->Length(steps));
    file.time = file.times[nearest_step(file.times, options.time)];
    reader.UpdateTimeStep(*file.time);
  } else {
    refuse_time(options);
    reader.Update();
  }
  messages.check();
  if (reader.GetErrorCode() != 0) throw Error("the file is cut off or damaged");
}

}  // namespace pellucid

extern "C" __attribute__((visibility("default"))) void pellucid_read_with_vtk_1(
    const std::filesystem::path& path, pellucid::VtkFormat format,
    const pellucid::MeshReadOptions& options, pellucid::VtkAnswer& answer) {
  using pellucid::VtkFormat;
  pellucid::answer(answer.error, "the file may be damaged, or split it", [&] {
    const pellucid::VtkMessages messages;
    const auto read = format == VtkFormat::xml      ? pellucid::read_xml
                      : format == VtkFormat::legacy ? pellucid::read_legacy
                                                    : pellucid::read_exodus;
    read(path, options, messages, answer.mesh);
  });
}

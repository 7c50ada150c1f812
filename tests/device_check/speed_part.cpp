// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "tests/device_check/parts.h"
#include "tests/device_check/rows.h"

namespace pellucid::device_check {

bool check_speed(const Arguments& arguments) {
  RowWriter rows(arguments.rows);
  bench::SpeedOptions options = arguments.speed;
  options.device = arguments.device;
  options.threads = arguments.threads;
  options.cache = arguments.truths;
  std::vector<std::string> missing;
  const std::vector<scenes::NamedScene> list = bench::speed_scenes(
      arguments.points, {arguments.size, arguments.size}, arguments.scenes, missing);
  rows.add({{"kind", "data"},
            {"points", arguments.points},
            {"size", arguments.size},
            {"missing", missing}});
  bool good = !list.empty();
  for (const scenes::NamedScene& named : list) {
    const bench::Speed speed =
        bench::measure_speed(named, options, [&](const bench::Speed& so_far) {
          Json row = bench::to_json(so_far);
          row["kind"] = "speed";
          rows.add(row);
        });
    const bool on_device = !speed.device.starts_with("rendered by the CPU");
    if (on_device && speed.exact_error <= speed.tolerance) continue;
    good = false;
    std::printf("%s: an error of %g; %s\n", named.name.c_str(), speed.exact_error,
                speed.device.c_str());
  }
  for (const std::string& name : missing) std::printf("no data: %s\n", name.c_str());
  return good;
}

}  // namespace pellucid::device_check

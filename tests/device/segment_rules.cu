// SPDX-License-Identifier: Apache-2.0
#include "kernel.h"
#include "pellucid/segment/segment_rule.h"

namespace pellucid {

template <class T>
__device__ void segment_rules(const T* in, T* out) {
  const Material<T> front{in[0], {in[1], in[2], in[3]}}, back{in[4], {in[5], in[6], in[7]}};
  const float psi[] = {1, 0, 0, 0}, entry[16]{};
  const auto rule = static_cast<SegmentRule>(threadIdx.x);
  const SegmentResult<T> of_materials =
      takes_data(rule) ? SegmentResult<T>{}
                       : material_segment(rule, PsiTable{psi, 2}, front, front, back, in[8]);
  MultivariateTransfer<T> transfer;
  const Material<T> material[] = {front, back};
  const ChannelTable<T> table{0, {in + 9, material, 2}};
  transfer.table = &table;
  transfer.tables = 1;
  const SegmentResult<T> of_data = data_segment(rule, PreintegratedTable{entry, 2, 0, 1, 0, 1},
                                                in[8], transfer, in + 11, in + 12, in[8]);
  out[0] = of_materials.opacity + of_data.opacity;
  out[1] = of_materials.radiance.r + of_data.radiance.r;
}
PELLUCID_DEVICE_KERNEL(segment_rules)

}  // namespace pellucid

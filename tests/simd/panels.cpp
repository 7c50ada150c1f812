// SPDX-License-Identifier: Apache-2.0
#include "tests/simd/panels.h"

#include "pellucid/segment/multivariate_panel.h"
#include "pellucid/simd/batch.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid {
namespace {

using simd_panels::Task;

template <class T>
struct Numbers {
  static T load(const double* x) { return T::load(x); }
  static void store(T x, double* y) { x.store(y); }
};
template <>
struct Numbers<double> {
  static double load(const double* x) { return *x; }
  static void store(double x, double* y) { *y = x; }
};

template <class T>
void panel(const Task& task, const double* const in[10], double* const out[simd_panels::outputs]) {
  Gaussian<double> all[8];
  for (int i = 0; i < task.count; ++i) {
    const double* number = task.primitives + 10 * i;
    Gaussian<double>& g = all[i];
    g.channels = g.rows = 2;
    for (int k = 0; k < 2; ++k) {
      g.center[k] = number[k];
      g.matrix[0][k] = number[2 + k];
      g.matrix[1][k] = number[4 + k];
    }
    g.peak = number[6];
    g.color = {number[7], number[8], number[9]};
  }
  MultivariateTransfer<double> transfer;
  transfer.channels = 2;
  transfer.gaussians = {all, task.count};
  Material<double> material[3];
  ChannelTable<double> table;
  if (task.table != nullptr) {
    for (int i = 0; i < 3; ++i) material[i] = {task.table[3 + i], {1, 0.5 * i, 0}};
    table.table = {task.table, material, 3};
    transfer.table = &table;
    transfer.tables = 1;
  }
  MultivariateSpan<T> span;
  for (int c = 0; c < 2; ++c) {
    for (int k = 0; k < 4; ++k) span.data[c].b[k] = Numbers<T>::load(in[4 * c + k]);
  }
  span.length = Numbers<T>::load(in[8]);
  PanelDemand<T> demand;
  demand.grade = task.proved ? Grade::proved : Grade::estimated;
  demand.last_resort = Numbers<T>::load(in[9]) > T(0.0);
  PanelWorkspace<T> room;
  const PanelSegment<T> found = integrate_multivariate_panel(
      transfer, span, demand, [&](T) { return T(task.tolerance); }, room);
  Numbers<T>::store(found.found.segment.opacity, out[simd_panels::opacity]);
  Numbers<T>::store(found.found.segment.radiance.r, out[simd_panels::red]);
  Numbers<T>::store(found.found.segment.radiance.g, out[simd_panels::green]);
  Numbers<T>::store(found.found.segment.optical_depth, out[simd_panels::optical_depth]);
  Numbers<T>::store(found.error(T(1.0)), out[simd_panels::error]);
  Numbers<T>::store(select(found.done, T(1.0), T(0.0)), out[simd_panels::done]);
  Numbers<T>::store(found.cut, out[simd_panels::cut]);
}

constexpr simd_panels::Panels panels = {PELLUCID_LANES, panel<Batch<double, PELLUCID_LANES>>,
                                        panel<double>};

}  // namespace
}  // namespace pellucid

extern "C" const simd_panels::Panels* PELLUCID_ENTRY(pellucid_simd_panels)() {
  return &pellucid::panels;
}

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/cubic_roots.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// Calls visit(interval, t_begin, t_end, value_begin, value_end), front to back, for the parts of
/// [0,1] in which the data stay in one interval of the transfer function. The parts tile [0,1]:
/// each begins with the same number at which the previous one ended, and with exactly the control
/// value that was crossed there. A part may contain extrema of the data.
///
/// On each monotone piece the control values between the values of its ends are crossed in order,
/// so that no search in the table is needed (specification, 3.8). A jump (two equal control values)
/// is one crossing. Data that only touch a control value do not cross it.
template <class T, class Visit>
PELLUCID_HD void for_each_interval(const CubicBernstein<T>& data, const PiecewiseLinear<T>& table,
                                   Visit&& visit) noexcept {
  const CriticalPoints<T> turn = critical_points(data);
  int interval = table.interval(data.b[0]);
  T t_begin = T(0), value_begin = data.b[0];
  T t_crossed = T(0), value_crossed = data.b[0];
  const auto cut = [&](T t, T value) noexcept {
    if (t > t_begin) visit(interval, t_begin, t, value_begin, value);
    t_begin = t;
    value_begin = value;
  };

  T ta = T(0), value_a = data.b[0];
  for (int k = 0; k <= turn.count; ++k) {
    const bool last = k == turn.count;
    const T tb = last ? T(1) : turn.t[k];
    const T value_b = last ? data.b[3] : evaluate(data, tb);
    const bool rising = value_b > value_a;
    t_crossed = ta;
    value_crossed = value_a;
    for (;;) {
      T control;
      if (rising) {
        if (!(interval < table.count && table.value[interval] < value_b)) break;
        control = table.value[interval];
      } else {
        if (!(interval > 0 && table.value[interval - 1] > value_b)) break;
        control = table.value[interval - 1];
      }
      if (rising ? control > value_crossed : control < value_crossed) {
        t_crossed = find_crossing(data, control, t_crossed, tb, rising);
        value_crossed = control;
      }
      cut(t_crossed, control);
      interval += rising ? 1 : -1;
    }
    ta = tb;
    value_a = value_b;
  }
  cut(T(1), data.b[3]);
}

}  // namespace pellucid

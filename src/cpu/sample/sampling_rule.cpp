// SPDX-License-Identifier: Apache-2.0
#include "sampling_rule.h"

namespace pellucid {

SamplingRule sampling_rule(Method method) noexcept {
  switch (method) {
    case Method::rectangle:
      return SamplingRule::rectangle;
    case Method::taylor:
      return SamplingRule::taylor;
    case Method::midpoint:
      return SamplingRule::midpoint;
    case Method::trapezoid:
      return SamplingRule::trapezoid;
    case Method::simpson:
      return SamplingRule::simpson;
    case Method::linear:
    case Method::preintegrated:
    case Method::kniss:
    case Method::gaussian:
    case Method::homogeneous:
    case Method::average:
    case Method::partial:
    case Method::exact:
      break;
  }
  return SamplingRule::linear;
}

}  // namespace pellucid

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Mark of the symbols that the shared library exports.
#define PELLUCID_VTK_EXPORT __attribute__((visibility("default")))

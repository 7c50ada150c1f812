// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the shared library gives to others.
#define PELLUCID_VTK_EXPORT __attribute__((visibility("default")))

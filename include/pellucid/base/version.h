// SPDX-License-Identifier: Apache-2.0
#pragma once

// The version; CMake reads it from here.
#define PELLUCID_VERSION_MAJOR 0
#define PELLUCID_VERSION_MINOR 1
#define PELLUCID_VERSION_PATCH 0
#define PELLUCID_VERSION_STRING "0.1.0"

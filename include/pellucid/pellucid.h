// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Headers for a first picture: data from files, scenes, renderers, and pictures into files. Of the
/// components `cpu` and `io`.

#include "pellucid/cpu/render.h"
#include "pellucid/cpu/renderer.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/look.h"

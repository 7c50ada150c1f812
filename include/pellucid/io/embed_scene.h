// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/io/scene_json.h"

namespace pellucid {

/// A file of an embedded scene.
struct EmbeddedFile {
  std::string name;  ///< relative to the scene's folder: "head.npz"
  std::string bytes;
};

/// A scene and all that it is made of, for a place that has no files of this machine, such as a
/// page. Its data are archives of numpy: write_volume(); of meshes "points", "tetrahedra" and an
/// array for each channel.
struct EmbeddedScene {
  std::string scene;  ///< a document that parse_scene() reads
  std::vector<EmbeddedFile> files;
  std::string note = {};  ///< told by the page, one line; may be empty
};

/// Returns the scene with its data as they were loaded: the values in their own types, the part,
/// the component and the step that the description chooses, channels without those that are
/// computed from others. Layers that are hidden stay. `description` is complete
/// (complete_description()), and `scene` was made from it. Throws Error for what cannot be
/// embedded, by its layer: fields of one's own, grids whose rectilinear axes are turned or have
/// their values in cells, a backdrop; and where the files have more than `most_bytes`.
EmbeddedScene embed_scene(const SceneDescription& description, const Scene& scene,
                          std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

/// Threads that a page has for rendering: one, or as many as its machine has cores where its server
/// lets it share memory (docs/how-to/pages.md), else one. For the latter it holds two renderers.
enum class PageThreads { one, where_allowed };

/// Returns a page that shows the scene in a browser, on its own: HTML with the viewer, the renderer
/// as WebAssembly and the data. It asks for no other file. Throws Error if the page that it is made
/// of was not built (scripts/build-web) or is of another version.
std::string page_of(const EmbeddedScene& scene, PageThreads threads = PageThreads::one);

/// Returns the page without a scene, which asks for a file. Throws Error likewise.
std::string empty_page(PageThreads threads = PageThreads::one);

/// Page whose data may be coarser than those of its scene.
struct ReducedPage {
  std::string page;
  std::string note;  ///< sizes to which data were reduced, as the page tells; empty: none were
};

/// Returns the page of a scene, with coarser data until it has no more than `most_bytes`: the
/// largest get half their resolution along each axis of 16 values or more, by the means of values
/// that are numbers, or by the most common label. Their boxes stay where they are. Meshes stay as
/// they are, so that the page may still be larger. Throws Error as embed_scene() and page_of() do.
ReducedPage reduced_page(const SceneDescription& description, const Scene& scene,
                         std::uint64_t most_bytes, PageThreads threads = PageThreads::one);

}  // namespace pellucid

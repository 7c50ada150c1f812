// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common.h"
#include "pellucid/io/scene_json.h"
#include "pellucid/scene/scene.h"

namespace pellucid::python {

/// A Python scene as the library's, with what each layer's data and function came from. A camera
/// that the scene leaves out is not set.
struct PythonScene {
  Scene scene;
  SceneDescription description;
  bool has_camera = false, is_transparent = false;
};

/// Reads pellucid.Camera. Throws Error that names the attribute.
Camera camera_of(const py::object& camera);
/// Reads pellucid.Scene. Throws Error that names the attribute.
PythonScene read_scene(const py::object& scene);
/// Reads pellucid.Scene, and completes it for rendering: the camera, if it has none, and opacity
/// tables for its tolerance. Lets go of the interpreter's lock for that.
Scene complete_scene(const py::object& scene);
PythonScene complete_python_scene(const py::object& scene);
/// Returns the description of all that the scene says, with its camera if it has one. Data that are
/// arrays have sources without a file.
SceneDescription described(const PythonScene& scene);
/// Returns the Python object of a scene that make_scene() made from a description.
py::object to_python(const Scene& scene, const SceneDescription& description);
/// Returns pellucid.Camera.
py::object to_python(const Camera& camera);
/// Returns pellucid.HeadLight, DirectionalLight or PointLight.
py::object to_python(const Light& light);
/// Returns pellucid.ClipPlane, ClipBox, ClipSphere or ClipCylinder.
py::object to_python(const Clip& clip);
/// Returns the arguments of pellucid.Layer for all of a layer but its data, functions and labels.
py::dict look_arguments(const Layer& layer);

}  // namespace pellucid::python

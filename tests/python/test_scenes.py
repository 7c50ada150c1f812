# SPDX-License-Identifier: Apache-2.0
"""Scenes of all kinds beside the program, scene files, transfer functions and messages."""
import copy
import json
import os
import warnings

import numpy
import pytest

import pellucid
from conftest import SIZE, assert_same_bits, render, smooth

POINTS = [(0, 0, "#000000"), (40, 0.1, (0.2, 0.4, 1)), (100, 2, "#ffcc99")]


@pytest.fixture
def ball(tmp_path):
    path = tmp_path / "ball.npy"
    numpy.save(path, smooth())
    return path


def as_program(program, tmp_path, scene):
    """Saves the scene and has the program render it."""
    path = tmp_path / "scene.json"
    scene.size = (SIZE, SIZE)
    scene.save(path)
    return program.render(path)


def both(program, tmp_path, scene):
    """The scene's picture is the program's of the saved scene, and that of the scene read again."""
    expected = as_program(program, tmp_path, scene)
    assert expected.rgba[..., 3].max() > 0
    assert_same_bits(render(scene), expected)
    assert_same_bits(render(pellucid.load_scene(tmp_path / "scene.json")), expected)


def test_a_file_alone(program, ball):
    assert_same_bits(render(ball), program.render(ball))
    assert_same_bits(render(str(ball)), program.render(ball))
    assert_same_bits(render("builtin:shells:40"), program.render("builtin:shells:40"))


@pytest.mark.parametrize("preset", [each.name for each in pellucid.presets()])
def test_presets(program, ball, preset):
    if next(each for each in pellucid.presets() if each.name == preset).hounsfield:
        with pytest.raises(pellucid.Error, match="is for Hounsfield units"):
            render(ball, preset=preset)
        return
    assert_same_bits(render(ball, preset=preset), program.render(ball, "--preset", preset))


@pytest.mark.parametrize("view", ["front", "left", "bottom", "oblique"])
def test_views(program, ball, view):
    assert_same_bits(render(ball, view=view), program.render(ball, "--view", view))


def test_tolerance_and_background(program, ball):
    expected = program.render(ball, "--tolerance", "1e-5", "--background", "#336699")
    assert_same_bits(render(ball, tolerance=1e-5, background="#336699"), expected)


@pytest.mark.parametrize("projection", ["maximum", "minimum", "mean", "sum"])
def test_projections(program, ball, projection):
    image = render(ball, projection=projection, values=True)
    expected = program.render(ball, "--projection", projection)
    for name in ("rgba", "error", "proved"):
        assert numpy.array_equal(getattr(image, name), getattr(expected, name)), name
    assert image.values.shape == (SIZE, SIZE) and numpy.nanmax(image.values) > 20


def test_everything_of_one_layer(program, tmp_path, ball):
    layer = pellucid.Layer(
        pellucid.read(ball), POINTS, name="ball",
        transform=[[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 2, 0]],
        shading=pellucid.Shading(ambient=0.3, specular=0.4, gradient="field"),
        gradient_opacity=pellucid.GradientOpacity([(0, 0.2), (30, 1)]),
        isosurfaces=[pellucid.Isosurface(60, "#ff8800", 0.5)],
        slices=[pellucid.Slice((8, 4, 6), (0, 0, 1), 0.7)],
        clips=[pellucid.ClipPlane((9, 4, 6), (-1, 0.2, 0)),
               pellucid.ClipSphere((10, 4, 6), 1.5, "outside")])
    scene = pellucid.Scene(
        [layer], lights=[pellucid.HeadLight((0.5, 0.5, 0.5)), pellucid.PointLight((0, 0, 90)),
                         pellucid.DirectionalLight((1, 1, -1), "#8899aa")],
        clips=[pellucid.ClipBox((0, 0, 0), (12, 30, 9.5)),
               pellucid.ClipCylinder((0, 0, 0), (1, 0, 0), 0.5, "outside")],
        background=(0.1, 0.2, 0.3), samples=2,
        camera=pellucid.Camera((40, -30, 30), (10, 4, 6), (0, 0, 1)))
    both(program, tmp_path, scene)


def test_several_layers(program, tmp_path, ball):
    labels = tmp_path / "labels.npy"
    numpy.save(labels, (smooth() > 60).astype("u1") + 2 * (smooth() > 90))
    looks = pellucid.LabelTable({1: "#ff0000", 3: ((0, 1, 0), 2.0, "core")}, extinction=0.5)
    segmentation = pellucid.LabelVolume(pellucid.read(labels))
    assert segmentation.labels == [0, 1, 3]
    scene = pellucid.Scene([
        pellucid.Layer(pellucid.read(ball), POINTS),
        pellucid.Layer(segmentation, labels=looks,
                       transform=[[1, 0, 0, 6], [0, 1, 0, 0], [0, 0, 1, 0]]),
        pellucid.Layer(pellucid.builtin_field("shells", 30), visible=False)],
        camera=pellucid.Camera((5, -40, 20), (5, 4, 3), (0, 0, 1), projection="orthographic",
                               parallel_scale=9))
    both(program, tmp_path, scene)


def test_masks(program, tmp_path, ball):
    labels = tmp_path / "labels.npy"
    numpy.save(labels, (smooth() > 60).astype("u1"))
    mask = pellucid.LabelMask(pellucid.LabelVolume(pellucid.read(labels)),
                              {1: pellucid.TransferFunction([(0, 1, "#00ff00")])})
    scene = pellucid.Scene([pellucid.Layer(pellucid.read(ball), POINTS, mask=mask)])
    both(program, tmp_path, scene)


def test_several_variables(program, tmp_path, ball):
    other = tmp_path / "other.npy"
    numpy.save(other, smooth("i2")[::-1])
    channels = pellucid.Channels(a=pellucid.read(ball), b=pellucid.read(other))
    assert channels.names == ["a", "b"] and channels["b"].type == "i16"
    gaussians = ["a=80~30, b=60~40; extinction 2; color #ffcc99",
                 pellucid.Gaussian((20, 30), 0.5, "#0000ff", covariance=[[90, 10], [10, 60]])]
    scene = pellucid.Scene([pellucid.Layer(channels, gaussians)])
    both(program, tmp_path, scene)
    # The same of arrays.
    arrays = pellucid.Channels({"a": smooth(), "b": smooth("i2")[::-1]}, units={"a": "K"})
    again = pellucid.Scene([pellucid.Layer(arrays, gaussians)], size=(SIZE, SIZE))
    assert_same_bits(render(again), program.render(tmp_path / "scene.json"))


def test_opacity_tables(program, tmp_path, ball):
    table = pellucid.OpacityTable([(0, 0, "#000000"), (50, 0.1, "#ff0000"), (100, 0.9, "#ffffff")],
                                  unit_distance=2)
    for tolerance in (1e-2, 1e-5):
        scene = pellucid.scene_of(pellucid.read(ball), table, tolerance=tolerance)
        both(program, tmp_path, scene)


def test_meshes(program, tmp_path):
    vtk = pytest.importorskip("vtkmodules.all")
    from test_libraries import unstructured, write

    path = write(vtk.vtkXMLUnstructuredGridWriter(), unstructured(vtk), tmp_path / "a.vtu")
    assert_same_bits(render(path), program.render(path))
    both(program, tmp_path, pellucid.scene_of(pellucid.read_mesh(path, channels=["w=v"])))


def test_backdrops(program, tmp_path, ball):
    behind = pellucid.render(pellucid.builtin_field("sphere", 20), size=SIZE, depth=True)
    camera = pellucid.Camera((20, -20, 10), (5, 4, 3), (0, 0, 1))
    scene = pellucid.scene_of(ball, camera=camera, size=SIZE)
    scene.backdrop = behind
    behind.save(tmp_path / "behind.exr")
    camera_file = tmp_path / "camera.json"
    camera_file.write_text(json.dumps({"position": [20, -20, 10], "focal_point": [5, 4, 3],
                                       "up": [0, 0, 1]}))
    expected = program.render(ball, "--backdrop", tmp_path / "behind.exr", "--camera", camera_file)
    assert_same_bits(render(scene), expected)
    with pytest.raises(pellucid.Error, match="backdrop"):
        scene.save(tmp_path / "scene.json")


def test_examples(program):
    folder = os.path.join(os.environ["PELLUCID_SOURCE_DIR"], "examples")
    for name in ("marschner_lobb.json", "shells.json"):
        scene = pellucid.load_scene(os.path.join(folder, name))
        assert_same_bits(render(scene), program.render(os.path.join(folder, name)))


def test_sampling_methods(program, ball):
    scene = pellucid.scene_of(ball, look="haze")
    scene.integration = pellucid.Integration(method="midpoint", step=0.25)
    image = render(scene)
    expected = program.render(ball, "--look", "haze", "--method", "midpoint", "--step", "0.25")
    assert image.error is None and image.tolerance is None
    assert numpy.array_equal(image.rgba, expected.rgba)


def test_proved(program, ball):
    scene = pellucid.scene_of(ball)
    scene.integration = pellucid.Integration(grade="proved")
    image = render(scene)
    assert image.proved.all()
    assert_same_bits(image, program.render(ball, "--grade", "proved"))


def test_the_reference_agrees():
    scene = pellucid.scene_of(smooth(), POINTS, size=8, tolerance=1e-4)
    image = pellucid.Renderer().render(scene)
    reference = pellucid.render_reference(scene, progress=lambda done: None)
    difference = image.compare(reference)
    assert difference.largest <= 1e-4 and difference.over_errors == 0
    with pytest.raises(KeyError):
        pellucid.render_reference(pellucid.scene_of(smooth(shape=(20, 20, 20)), POINTS, size=300),
                                  progress=lambda done: {}[0])


def test_frames_share_what_stays():
    renderer = pellucid.Renderer(threads=1)
    scene = pellucid.scene_of(smooth(), POINTS, size=SIZE)
    first = renderer.render(scene)
    scene.camera = pellucid.default_camera(scene)
    assert numpy.array_equal(renderer.render(scene).rgba, first.rgba)
    scene.camera.position = numpy.array(scene.camera.position) + 1
    assert not numpy.array_equal(renderer.render(scene).rgba, first.rgba)


def test_arrays_cannot_be_saved(tmp_path):
    with pytest.raises(pellucid.Error, match="layer 1: its data are arrays"):
        pellucid.scene_of(smooth()).save(tmp_path / "scene.json")


def test_histograms(program, tmp_path, ball):
    counts, (edges,) = pellucid.histogram(pellucid.read(ball), bins=32)
    expected, _ = numpy.histogram(smooth(), bins=edges)
    assert counts.sum() == smooth().size and abs(counts.astype(int) - expected).max() <= 1
    channels = pellucid.Channels(a=smooth(), b=smooth("u1")[::-1])
    joint, edges = pellucid.histogram(channels, which=["a", "b"], bins=16)
    assert joint.shape == tuple(len(e) - 1 for e in edges)
    assert numpy.array_equal(joint.sum(axis=1), pellucid.histogram(channels, ["a"], 16)[0])


def test_suggestions():
    values = pellucid.builtin_field("shells", 40)
    channels = pellucid.Channels(value=values, gradient=values.gradient_magnitude())
    mixture = pellucid.suggest(channels, which=["value"])
    assert len(mixture) > 0 and mixture.channels == ["value", "gradient"]
    boundaries = pellucid.suggest_boundaries(channels, "value", "gradient")
    image = render(pellucid.Layer(channels, boundaries))
    assert image.rgba[..., 3].max() > 0.05
    with pytest.raises(pellucid.Error, match="there is no channel \"c\"; there are: value"):
        pellucid.suggest(channels, which=["c"])


@pytest.mark.filterwarnings("ignore::pellucid.Note")
def test_import_and_export(program, tmp_path, ball):
    table = pellucid.OpacityTable([(0, 0, "#000000"), (100, 0.5, "#ffffff")])
    for kind in ("slicer", "paraview", "table"):
        path = tmp_path / ("a.csv" if kind == "table" else f"{kind}.vp.json")
        path.write_text(pellucid.export_transfer_function(table, kind))
        imported = pellucid.import_transfer_function(path)
        assert isinstance(imported.transfer_function, pellucid.OpacityTable)
        assert imported.format and isinstance(imported.notes, list)
        render(ball, transfer_function=imported.transfer_function)
    with pytest.raises(pellucid.Error, match="format"):
        pellucid.export_transfer_function(table, "vtk")


def test_derived_channels():
    ramp = pellucid.builtin_field("ramp", 16)
    assert numpy.allclose(ramp.gradient_magnitude().array, 1, atol=1e-6)
    assert numpy.allclose(ramp.second_derivative().array, 0, atol=1e-4)
    assert ramp.smoothed(0.2).shape == (16, 16, 16)


def test_volumes_are_written(tmp_path):
    volume = pellucid.Volume(smooth("i2"), spacing=(1, 2, 3), origin=(4, 5, 6))
    for name in ("a.nrrd", "a.nii", "a.vti"):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", pellucid.Note)  # .nii has no centering
            volume.write(tmp_path / name)
        again = pellucid.read(tmp_path / name)
        assert numpy.array_equal(again.array, volume.array)
        assert numpy.allclose(again.spacing, (1, 2, 3)) and numpy.allclose(again.origin, (4, 5, 6))
    with pytest.raises(pellucid.Error):
        volume.write(tmp_path / "a.png")


@pytest.mark.parametrize("change, words", [
    (lambda s: setattr(s, "size", (0, 5)), "size"),
    (lambda s: setattr(s, "size", (2.5, 5)), "size: width: expected a whole number"),
    (lambda s: setattr(s, "size", (1 << 40, 5)), "size"),
    (lambda s: setattr(s, "samples", 0), "samples"),
    (lambda s: setattr(s, "background", "red"), "background: expected three linear numbers"),
    (lambda s: setattr(s, "background", "#12345g"), "background"),
    (lambda s: setattr(s, "background", (1, 2)), "background"),
    (lambda s: setattr(s, "layers", []), "layer"),
    (lambda s: setattr(s, "layers", [7]), "layer 1: expected a pellucid.Layer, got 7"),
    (lambda s: setattr(s, "lights", [7]), "light 1: expected HeadLight"),
    (lambda s: setattr(s, "lights", 7), "light: expected a list"),
    (lambda s: setattr(s, "clips", [pellucid.ClipPlane(normal=(0, 0, 0))]), "clip 1"),
    (lambda s: setattr(s, "clips", [pellucid.ClipPlane(keep="both")]), "clip 1.keep: expected one"),
    (lambda s: setattr(s, "camera", pellucid.Camera(up=(0, 0, 1))), "up"),
    (lambda s: setattr(s, "camera", pellucid.Camera(position="there")), "camera.position"),
    (lambda s: setattr(s, "camera", pellucid.Camera(projection="fisheye")), "camera.projection"),
    (lambda s: setattr(s.integration, "tolerance", 0), "tolerance"),
    (lambda s: setattr(s.integration, "tolerance", float("nan")), "tolerance"),
    (lambda s: setattr(s.integration, "tolerance", "1 %"), "tolerance: expected a number"),
    (lambda s: setattr(s.integration, "grade", "sure"), "grade: expected one of"),
    (lambda s: setattr(s.integration, "method", "magic"), "method: expected"),
    (lambda s: setattr(s.layers[0], "transform", numpy.zeros((3, 4))), "transform"),
    (lambda s: setattr(s.layers[0], "transform", numpy.eye(3)), "transform: expected three rows"),
    (lambda s: setattr(s.layers[0], "projection", "median"), "projection"),
    (lambda s: setattr(s.layers[0], "transfer_function", None), "transfer_function: expected"),
    (lambda s: setattr(s.layers[0], "data", None), "layer 1: data: expected"),
    (lambda s: s.layers[0].isosurfaces.append(pellucid.Isosurface(float("nan"))), "isosurface"),
    (lambda s: setattr(s.layers[0], "shading", pellucid.Shading(power=0)), "power"),
])
def test_what_is_refused_is_refused_in_one_line(change, words):
    scene = pellucid.scene_of(smooth(), POINTS, size=SIZE)
    change(scene)
    with pytest.raises(pellucid.Error, match=words) as error:
        pellucid.Renderer().render(scene)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("part, key, number", [
    ("camera", "vertical_angle", 500), ("camera", "vertical_angle", float("nan")),
    ("integration", "tolerance", 2), ("integration", "tolerance", 1e-9),
    ("integration", "step", 0), ("shading", "ambient", -1), ("shading", "power", 0.5),
    ("isosurface", "opacity", 1.5), ("slice", "opacity", -0.5),
])
def test_no_scene_is_saved_with_numbers_that_a_file_refuses(tmp_path, part, key, number):
    scene = pellucid.scene_of(smooth(), POINTS, size=SIZE, camera=pellucid.Camera(),
                              shading=pellucid.Shading(),
                              isosurfaces=[pellucid.Isosurface(0.5)],
                              slices=[pellucid.Slice()])
    layer = scene.layers[0]
    parts = {"camera": scene.camera, "integration": scene.integration, "shading": layer.shading,
             "isosurface": layer.isosurfaces[0], "slice": layer.slices[0]}
    setattr(parts[part], key, number)
    path = tmp_path / "scene.json"
    with pytest.raises(pellucid.Error, match=f"{key}: expected a number .*, got {number}"):
        scene.save(path)
    assert not path.exists()


@pytest.mark.parametrize("call, words", [
    (lambda: pellucid.TransferFunction([]), "no"),
    (lambda: pellucid.TransferFunction("viridis"), "points: expected a list"),
    (lambda: pellucid.TransferFunction([(0, 1)]), r"point 1: expected \(value, extinction, col"),
    (lambda: pellucid.TransferFunction([(0, "a", "#000000")]), "point 1: extinction: expected a n"),
    (lambda: pellucid.TransferFunction([(1, 1, "#000000"), (0, 1, "#000000")]), "sort"),
    (lambda: pellucid.TransferFunction([(0, -1, "#000000")]), "extinction"),
    (lambda: pellucid.OpacityTable([(0, 2, "#000000")]), "opacity"),
    (lambda: pellucid.make_preset("none", pellucid.Volume(smooth())), "ct-bone"),
    (lambda: pellucid.render(smooth(), preset="x", transfer_function=POINTS), "drop one"),
    (lambda: pellucid.render(smooth(), view="above"), "view: expected front"),
    (lambda: pellucid.render("there.nii"), "there.nii"),
    (lambda: pellucid.render(pellucid.Channels(a=smooth(), b=smooth())), "suggest"),
    (lambda: pellucid.Channels(), "channel"),
    (lambda: pellucid.Channels(a=smooth(), b=smooth(shape=(3, 3, 3))), "grid"),
    (lambda: pellucid.Gaussians([pellucid.Gaussian((1,), 1)], ["a"]), "give one of widths"),
    (lambda: pellucid.Gaussians(["a=1~0; extinction 1"], ["a"]), "width"),
    (lambda: pellucid.Gaussians(["c=1~1; extinction 1"], ["a"]), "c"),
    (lambda: pellucid.LabelVolume(smooth() + 0.5), "whole"),
    (lambda: pellucid.LabelTable({1: "#ffffff"}), "label 1: has no extinction"),
    (lambda: pellucid.builtin_field("cube"), "cube"),
    (lambda: pellucid.Renderer(-1), "threads"),
    (lambda: pellucid.render(smooth(), camera={}), "camera: expected a pellucid.Camera, got {}"),
    (lambda: pellucid.render(smooth(), isosurfaces=["a"]), "isosurface 1: expected a"),
    (lambda: pellucid.render(smooth(), slices=[3]), "expected a pellucid.Slice"),
    (lambda: pellucid.render(smooth(), shading=3), "shading: expected a pellucid.Shading"),
    (lambda: pellucid.render(pellucid.Volume(smooth()), spacing=2), "spacing are for arrays"),
    (lambda: pellucid.Renderer().render(smooth()), "scene: expected a pellucid.Scene"),
    (lambda: pellucid.Renderer().start(pellucid.scene_of(smooth()), preview=99), "preview"),
])
def test_wrong_arguments_are_refused_in_one_line(call, words):
    with pytest.raises(pellucid.Error, match=words) as error:
        call()
    assert "\n" not in str(error.value)
    assert isinstance(error.value, ValueError)


def test_places_of_arrays():
    placed = pellucid.Volume(smooth(), spacing=(1, 2, 3), centering="cell")
    image = pellucid.render(smooth(), size=SIZE, depth=True, spacing=(1, 2, 3), centering="cell")
    assert_same_bits(image, render(placed))


def test_scenes_are_copied_without_their_data():
    scene = pellucid.scene_of(smooth(), POINTS, size=SIZE)
    other = copy.deepcopy(scene)
    other.layers[0].visible = False
    assert other.layers[0].data is scene.layers[0].data and scene.layers[0].visible
    assert other.layers[0].transfer_function is scene.layers[0].transfer_function


def test_numbers_of_numpy_are_numbers():
    image = pellucid.render(smooth(), size=numpy.int64(8), tolerance=numpy.float32(0.01),
                            background=numpy.array([0, 0.5, 1]))
    assert image.width == 8
    scene = pellucid.scene_of(smooth(), camera=pellucid.Camera(
        position=numpy.array([30, 0, 0]), focal_point=[4, 4, 4], up=numpy.eye(3)[2]))
    scene.size = numpy.array([8, 6])
    assert pellucid.Renderer().render(scene).height == 6


def test_unknown_keywords():
    with pytest.raises(TypeError, match=r"^render\(\) got .* 'tolerence'"):
        pellucid.render(smooth(), tolerence=1)
    with pytest.raises(TypeError, match=r"^scene_of\(\) got .* 'tolerence'"):
        pellucid.scene_of(smooth(), tolerence=1)


def test_gaussians_are_of_the_channels_of_the_data():
    data = pellucid.Channels(x=pellucid.builtin_field("sphere", 12),
                             y=pellucid.builtin_field("ramp", 12))
    gaussian = pellucid.Gaussian((0.5,), 5.0, widths=(0.2,), channels=["x"])
    pellucid.render(data, pellucid.Gaussians([gaussian], channels=["x", "y"]), size=4)
    for others in (["y", "x"], ["x", "z"]):
        with pytest.raises(pellucid.Error, match="but the data have x, y"):
            pellucid.render(data, pellucid.Gaussians([gaussian], channels=others), size=4)


def test_a_factor_gives_one_channel_the_opacity(tmp_path):
    """Two equal channels, one with the color and one with the opacity, are one variable."""
    volume = pellucid.Volume(smooth(numpy.float32))
    low, high = volume.statistics["minimum"], volume.statistics["maximum"]
    colors = pellucid.TransferFunction([(low, 1, (0, 0, 1)), (high, 1, (1, 0.5, 0))])
    function = pellucid.Gaussians([], ["color", "opacity"], {"color": colors},
                                  ("opacity", [(low, 0), (high, 0.7)]))
    assert function.factor == ("opacity", [(low, 0), (high, 0.7)])
    assert pellucid.Gaussians([], ["color"], {"color": colors}).factor is None
    several = pellucid.Channels(color=volume, opacity=volume)
    one = pellucid.TransferFunction([(low, 0, (0, 0, 1)), (high, 0.7, (1, 0.5, 0))])
    found = pellucid.render(several, function, size=16, tolerance=1e-5)
    truth = pellucid.render(volume, one, size=16, tolerance=1e-5)
    assert truth.rgba[..., 3].max() > 0.3
    assert abs(found.rgba - truth.rgba).max() <= 2e-5
    with pytest.raises(pellucid.Error, match="factor"):
        pellucid.Gaussians([], ["color"], {"color": colors}, ("other", [(0, 1)]))


def test_numbers_do_not_wrap_round():
    volume = pellucid.builtin_field("sphere", 8)
    for size in ((2**32 + 16, 8), (-2**32 + 5, 8), (2**70, 8)):
        with pytest.raises(pellucid.Error):
            pellucid.render(volume, size=size)
    for threads in (-1, 100000):
        with pytest.raises(pellucid.Error, match="threads"):
            pellucid.render(volume, size=4, threads=threads)


def test_none_is_no_function():
    with pytest.raises(pellucid.Error):
        pellucid.Gaussians([], channels=["x"], tables={"x": None})
    with pytest.raises((pellucid.Error, TypeError)):
        pellucid.segments.piecewise_linear_segment(None, 0, 1, 1)


def test_one_grid_in_several_memory_orders():
    a, b = smooth(numpy.float32), smooth(numpy.uint8, (7, 9, 11))
    place = {"spacing": (2, 3, 4), "origin": (1, 2, 3),
             "direction": [[0, 0, 1], [1, 0, 0], [0, 1, 0]]}
    gaussians = [pellucid.Gaussian((50, 50), 0.3, widths=(20, 20), channels=("a", "b"))]
    one = pellucid.Volume(a, **place)
    pictures = []
    for order in (lambda x: x, numpy.asfortranarray,
                  lambda x: numpy.ascontiguousarray(x.transpose(1, 0, 2)).transpose(1, 0, 2)):
        other = pellucid.Volume(order(b), **place)
        assert numpy.array_equal(other.array, b)
        channels = pellucid.Channels({"a": one, "b": other})
        assert numpy.array_equal(channels["b"].array, b)
        pictures.append(pellucid.render(pellucid.Layer(channels, gaussians), size=24))
        mask = pellucid.LabelMask(
            pellucid.LabelVolume(pellucid.Volume(order((b > 50).astype(numpy.uint8)), **place)),
            {1: pellucid.TransferFunction([(0, 1, (0, 0, 1)), (100, 2, (0, 1, 0))])})
        for data in (one, pellucid.Volume(numpy.asfortranarray(a), **place)):
            pictures.append(pellucid.render(data, [(0, 0, (1, 0, 0)), (100, 1, (1, 1, 1))],
                                            mask=mask, size=24))
    assert all(pictures[0].compare(each).largest == 0 for each in pictures[::3])
    # The memory order changes how rays are cut, and so the last bits.
    for each in pictures[1::3] + pictures[2::3]:
        assert pictures[1].compare(each).largest < 1 / 512
    assert pictures[1].rgba[..., 2].max() > 0.1


def test_a_tolerance_as_a_share():
    haze = pellucid.scene_of("builtin:shells:24", [(0.2, 0, "#ffffff"), (1, 0.01, "#ffffff")],
                             size=32)
    image = pellucid.render(haze, tolerance="1%")
    largest = image.rgba.max()
    assert 0.002 < largest < 0.1
    assert 0.003 * largest < image.tolerance <= 0.01 * largest * 1.0001
    haze.integration.tolerance = 1e-7
    assert image.compare(pellucid.render(haze)).largest <= 0.01 * largest
    for wrong in ("1", "x%", "0%", "200%", "nan%", ""):
        with pytest.raises(pellucid.Error, match="tolerance: "):
            pellucid.render(haze, tolerance=wrong)

    # A backdrop larger than the small pictures by which the largest channel is found.
    wide = pellucid.scene_of("builtin:shells:24", size=(120, 100))
    backdrop = pellucid.render(wide, depth=True)
    wide.backdrop = backdrop
    told = []
    image = pellucid.render(wide, tolerance="2%", progress=told.append)
    assert image.report["largest_error"] <= 0.02 * image.rgba.max()
    assert told == sorted(told) and told[-1] == 1

    class Stop(Exception):
        pass

    def stop(_done):
        raise Stop

    big = pellucid.scene_of("builtin:shells:90", size=700)
    with pytest.raises(Stop):
        pellucid.render(big, tolerance="0.01%", progress=stop)


def test_bad_backgrounds_and_backdrops():
    scene = pellucid.scene_of("builtin:sphere:8", size=8)
    for wrong in ((0, -1, 0), (float("nan"), 0, 0), (0, 0, float("inf"))):
        scene.background = wrong
        with pytest.raises(pellucid.Error, match="background: "):
            pellucid.render(scene)
    scene.background, scene.backdrop = None, "picture.exr"
    with pytest.raises(pellucid.Error, match="backdrop: expected an Image"):
        pellucid.render(scene)


def test_lengths_that_overflow_end():
    huge = pellucid.Volume(numpy.ones((3, 3, 3), numpy.float32), spacing=1e37)
    scene = pellucid.scene_of(huge, [(0, 1e8, (1, 1, 1)), (2, 1e9, (1, 1, 1))], size=2)
    try:
        pellucid.render_reference(scene)
    except pellucid.Error as error:
        assert "\n" not in str(error)

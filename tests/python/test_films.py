# SPDX-License-Identifier: Apache-2.0
"""Films: frames() and animate()."""
import json
import math
import os
import shutil
import signal
import time

import numpy
import pytest

import pellucid
from pellucid import Camera, Error, Isosurface, Layer, Scene, TransferFunction

CAMERA = Camera((4, 0, 0), (0, 0, 0), (0, 0, 1))


def scene_of(data, **more):
    function = TransferFunction([(0.0, 0.1, (1, 1, 1)), (1.0, 0.5, (1, 0, 0))])
    return Scene([Layer(data, function)], CAMERA, size=(24, 24), **more)


def array():
    return numpy.random.default_rng(1).random((6, 5, 4), dtype=numpy.float32)


@pytest.mark.parametrize("data", [pellucid.builtin_field("shells", 12), array()],
                         ids=["file", "array"])
def test_a_turntable_turns_the_camera(data):
    made = pellucid.frames(scene_of(data), {"seconds": 1, "fps": 4, "turntable": {"turns": 1}})
    assert len(made) == 4
    for i, each in enumerate(made):
        angle = i * math.pi / 2
        position = each.camera.position
        assert numpy.allclose(position, (4 * math.cos(angle), 4 * math.sin(angle), 0), atol=1e-12)
    assert numpy.allclose(made[-1].camera.position, (0, -4, 0), atol=1e-12)
    first = pellucid.render(made[0])
    assert numpy.array_equal(first.rgba, pellucid.render(scene_of(data)).rgba)


def test_tracks_change_layers_and_clips():
    scene = scene_of(pellucid.builtin_field("shells", 12))
    scene.layers[0].isosurfaces = [Isosurface(0.5)]
    scene.animation = {"seconds": 1, "fps": 2, "tracks": [
        {"target": "/layers/0/isosurfaces/0/value",
         "keys": [{"at": 0, "value": 0.25}, {"at": 1, "value": 0.75}]},
        {"target": "/clip", "easing": "hold", "keys": [
            {"at": 0, "value": []},
            {"at": 0.5, "value": [{"sphere": {"center": [0, 0, 0], "radius": 0.5}}]}]}]}
    first, second = pellucid.frames(scene)
    assert first.layers[0].isosurfaces[0].value == 0.25
    assert second.layers[0].isosurfaces[0].value == 0.5
    assert first.clips == [] and second.clips[0].radius == 0.5
    # The data are the same, not read again.
    assert numpy.shares_memory(first.layers[0].data.array, second.layers[0].data.array)


def test_a_scene_file_keeps_its_animation(tmp_path):
    scene = scene_of(pellucid.builtin_field("shells", 12))
    scene.animation = {"seconds": 2, "fps": 3, "turntable": {"turns": -0.5, "axis": [0, 1, 0]}}
    scene.save(tmp_path / "scene.json")
    read = pellucid.load_scene(tmp_path / "scene.json")
    assert read.animation == scene.animation
    assert len(pellucid.frames(read)) == 6


def test_steps_in_time_move(tmp_path):
    rows = [" ".join([str(value)] * 8) for value in (1, 5, 3)]
    arrays = "".join(f'<DataArray type="Float32" Name="a" format="ascii" TimeStep="{i}">{row}'
                     '</DataArray>' for i, row in enumerate(rows))
    (tmp_path / "run.vti").write_text(
        '<VTKFile type="ImageData"><ImageData WholeExtent="0 1 0 1 0 1" Origin="0 0 0" '
        'Spacing="1 1 1" TimeValues="0 7 2"><Piece Extent="0 1 0 1 0 1"><PointData Scalars="a">'
        + arrays + "</PointData></Piece></ImageData></VTKFile>")
    volume = pellucid.read_volume(tmp_path / "run.vti", time=2)
    assert volume.array.max() == 3
    made = pellucid.frames(scene_of(volume), {"seconds": 3, "fps": 1, "time": "steps"})
    assert [each.layers[0].data.array.max() for each in made] == [1, 3, 5]
    made = pellucid.frames(scene_of(volume), {"seconds": 4, "fps": 1, "time": [0, 6]})
    assert [each.layers[0].data.array.max() for each in made] == [1, 3, 3, 5]


def test_pictures_are_written_and_kept(tmp_path):
    scene = scene_of(pellucid.builtin_field("shells", 12),
                     animation={"seconds": 1, "fps": 3, "turntable": {}})
    path = tmp_path / "f" / "%02d.exr"
    told = []
    pellucid.animate(scene, path, progress=lambda *done: told.append(done))
    assert told == [(1, 3), (2, 3), (3, 3)]
    pictures = sorted((tmp_path / "f").iterdir())
    assert [each.name for each in pictures] == ["00.exr", "01.exr", "02.exr"]
    for picture, each in zip(pictures, pellucid.frames(scene)):
        assert numpy.array_equal(pellucid.read_image(picture).rgba,
                                 pellucid.render(each).rgba)
    times = [each.stat().st_mtime_ns for each in pictures]
    pictures[1].write_bytes(pictures[1].read_bytes()[:200])
    pellucid.animate(scene, path)
    again = [each.stat().st_mtime_ns for each in pictures]
    assert again[0] == times[0] and again[2] == times[2]
    assert pellucid.read_image(pictures[1]).width == 24


def test_scenes_of_ones_own(tmp_path):
    scenes = (scene_of(array() * share) for share in (0.0, 1.0))
    pellucid.animate(scenes, tmp_path / "%d.exr")
    dark, bright = (pellucid.read_image(tmp_path / f"{i}.exr").rgba for i in range(2))
    assert 0 < dark[..., 3].sum() < bright[..., 3].sum()
    images = [pellucid.render(scene_of(array()))]
    pellucid.animate(images, tmp_path / "i%d.exr")
    assert numpy.array_equal(pellucid.read_image(tmp_path / "i0.exr").rgba, images[0].rgba)


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not installed")
def test_a_video(tmp_path):
    scene = scene_of(pellucid.builtin_field("shells", 12),
                     animation={"seconds": 0.5, "fps": 4, "turntable": {}})
    pellucid.animate(scene, tmp_path / "o.webm")
    assert (tmp_path / "o.webm").read_bytes()[:4] == b"\x1a\x45\xdf\xa3"
    assert sorted(each.name for each in tmp_path.iterdir()) == ["o.webm"]


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not installed")
def test_one_call_makes_a_video_at_a_time(tmp_path):
    scene = scene_of(pellucid.builtin_field("shells", 8),
                     animation={"seconds": 0.5, "fps": 4, "turntable": {}})

    def again(done, count):
        pellucid.animate(scene, tmp_path / "o.webm")

    with pytest.raises(Error, match="another call makes this video now") as kept:
        pellucid.animate(scene, tmp_path / "o.webm", progress=again)
    # A call that has ended holds nothing, also while its traceback is kept.
    pellucid.animate(scene, tmp_path / "o.webm")
    assert kept.value is not None
    assert sorted(each.name for each in tmp_path.iterdir()) == ["o.webm"]


def test_an_interrupt_ends_ffmpeg(tmp_path, monkeypatch):
    program = tmp_path / "ffmpeg"
    program.write_text("#!/bin/sh\ncase \"$*\" in *lavfi*) exit 0 ;; esac\nexec sleep 60\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)

    def interrupt(signal_number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    scene = scene_of(pellucid.builtin_field("shells", 8),
                     animation={"seconds": 1, "fps": 2, "turntable": {}})
    begin = time.monotonic()
    try:
        signal.alarm(3)
        with pytest.raises(KeyboardInterrupt):
            pellucid.animate(scene, tmp_path / "o.webm")
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - begin < 30
    assert not (tmp_path / "o.webm").exists()


def moving(seconds, last):
    """A film of 100 frames a second, whose clip's normal has no length in its frame 26 alone."""
    def clip(x):
        return [{"plane": {"point": [0, 0, 0], "normal": [x, 0, 0]}}]
    return {"seconds": seconds, "fps": 100, "tracks": [
        {"target": "/clip", "keys": [{"at": 0, "value": clip(1)}, {"at": 1, "value": clip(last)}]}]}


def test_frames_of_a_long_film_are_made_when_they_are_asked_for(tmp_path):
    scene = scene_of(pellucid.builtin_field("shells", 8))
    begin = time.monotonic()
    made = pellucid.frames(scene, moving(10_000, 5))
    assert len(made) == 1_000_000
    assert made[999_999].clips[0].normal[0] > 0
    assert time.monotonic() - begin < 5
    # What is wrong is found when it is asked for, or before a film is rendered.
    made = pellucid.frames(scene, moving(1, -3))
    with pytest.raises(Error, match="frame 26"):
        made[25]
    with pytest.raises(Error, match="frame 26"):
        pellucid.animate(scene, tmp_path / "f" / "%d.png", moving(1, -3))
    assert list(tmp_path.iterdir()) == []


def test_an_interrupt_ends_the_check_of_a_long_film(tmp_path):
    def interrupt(signal_number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    animation = moving(10_000, 5)
    animation["tracks"][0]["keys"][1]["at"] = 10_000
    begin = time.monotonic()
    try:
        signal.alarm(2)
        with pytest.raises(KeyboardInterrupt):
            pellucid.animate(scene_of(pellucid.builtin_field("shells", 8)), tmp_path / "%d.png",
                             animation)
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - begin < 10
    assert list(tmp_path.iterdir()) == []


def test_what_is_no_film(tmp_path):
    scene = scene_of(array())
    with pytest.raises(Error, match="cannot be a film"):
        pellucid.animate(scene, tmp_path / "o.png")
    with pytest.raises(Error, match="there is no frame"):
        pellucid.animate([], tmp_path / "%d.png")
    with pytest.raises(Error, match="an animation is of one Scene"):
        pellucid.animate([scene], tmp_path / "%d.png", {"seconds": 1})
    with pytest.raises(Error, match="unknown key"):
        pellucid.frames(scene, {"second": 1})
    with pytest.raises(Error, match="what JSON can hold"):
        pellucid.frames(scene, {"seconds": object()})
    with pytest.raises(Error, match="no data of the scene have steps"):
        pellucid.frames(scene, {"time": "steps"})
    with pytest.raises(Error, match="has 1 elements"):
        pellucid.frames(scene, {"tracks": [{"target": "/layers/1/visible",
                                            "keys": [{"at": 0, "value": True}]}]})
    with pytest.raises(Error, match="expected a Scene, got NoneType"):
        pellucid.frames(None)
    with pytest.raises(Error, match="fps: expected a number above 0"):
        pellucid.animate(scene, tmp_path / "%d.png", fps=0)
    with pytest.raises(IndexError):
        pellucid.frames(scene)[120]
    assert json.loads("[]") == list(tmp_path.iterdir())


def test_parts_of_films():
    made = pellucid.frames(scene_of(array()), {"seconds": 2, "fps": 4, "turntable": {"turns": 1}})
    part = made[1:-1:2]
    assert (len(made), len(part), len(part[1:]), len(made[9:])) == (8, 3, 2, 0)
    for each, number in zip(part, (1, 3, 5)):
        assert each.camera.position == made[number].camera.position
    assert part[-1].camera.position == made[5].camera.position
    with pytest.raises(IndexError, match="frame -4 of 3"):
        part[-4]

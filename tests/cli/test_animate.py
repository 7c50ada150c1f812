# SPDX-License-Identifier: Apache-2.0
"""Films: pellucid animate."""

import json
import math
import os
import shutil
import signal
import struct
import subprocess
import time
import unittest

from program import OVERLAPPING, PROGRAM, ProgramTest, npy, pixel, png, png_texts

FFMPEG = shutil.which("ffmpeg")
TIMES = [0.0, 0.5, 2.0, 4.0]


def steps(times, values):
    """A .vti of 4 x 4 x 4 points at some times; its values at each are a list, taken in turn."""
    arrays = "".join(
        f'<DataArray type="Float32" Name="a" format="ascii" TimeStep="{i}">'
        + " ".join(str(each[k % len(each)]) for k in range(64)) + "</DataArray>"
        for i, each in enumerate(values))
    return ('<VTKFile type="ImageData"><ImageData WholeExtent="0 3 0 3 0 3" Origin="0 0 0" '
            f'Spacing="1 1 1" TimeValues="{" ".join(map(str, times))}">'
            '<Piece Extent="0 3 0 3 0 3"><PointData Scalars="a">' + arrays
            + '</PointData></Piece></ImageData></VTKFile>').encode()


class Animate(ProgramTest):
    def scene(self, animation, **more):
        scene = {"layers": [{"field": {"builtin": "shells", "points": 16},
                             "isosurfaces": [{"value": 0.5}], "shading": {}}],
                 "image": {"width": 24, "height": 24}, "animation": animation, **more}
        self.write("scene.json", json.dumps(scene).encode())
        return scene

    def frames(self, folder="f"):
        return sorted(os.listdir(self.path(folder)))

    def note(self, *arguments):
        """Runs, expects exit code 0 and gives stderr."""
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr.decode(errors="replace"))
        return result.stderr.decode()

    def picture(self, name):
        return png(self.read(name))

    def test_a_file_alone_is_a_turntable(self):
        self.succeed("animate", "builtin:shells:16", "-o", "f/%02d.png", "--size", "16",
                     "--frames", "4")
        self.assertEqual(self.frames(), ["00.png", "01.png", "02.png", "03.png"])
        # The first frame is the still picture; a turn of a quarter is that of --azimuth.
        self.succeed("render", "builtin:shells:16", "-o", "o.png", "--size", "16")
        self.assertEqual(self.picture("f/00.png"), self.picture("o.png"))

    def test_a_turntable_is_the_azimuth(self):
        camera = {"position": [4, -1, 2], "focal_point": [0, 0, 0], "up": [0, 0, 1]}
        self.scene({"seconds": 1, "fps": 8, "turntable": {}}, camera=camera)
        self.succeed("animate", "scene.json", "-o", "f/%d.exr")
        for frame in (0, 3, 7):
            self.succeed("render", "scene.json", "-o", "o.exr", "--azimuth", str(45 * frame))
            self.succeed("compare", f"f/{frame}.exr", "o.exr", "--tolerance", "1e-5")

    def test_each_frame_is_the_picture_of_its_scene(self):
        camera = {"position": [4, -1, 2], "focal_point": [0, 0, 0], "up": [0, 0, 1]}
        scene = self.scene(
            {"seconds": 1, "fps": 4, "tracks": [
                {"target": "/layers/0/isosurfaces/0/value",
                 "keys": [{"at": 0, "value": 0.2}, {"at": 1, "value": 0.6}]},
                {"target": "/camera/vertical_angle", "easing": "smooth",
                 "keys": [{"at": 0, "value": 20}, {"at": 1, "value": 40}]},
                {"target": "/layers/0/visible", "easing": "hold",
                 "keys": [{"at": 0, "value": True}, {"at": 0.75, "value": False}]}]},
            camera=camera)
        self.succeed("animate", "scene.json", "-o", "f/%d.exr")
        for frame, (value, angle) in enumerate([(0.2, 20), (0.3, 23.125), (0.4, 30)]):
            scene["layers"][0]["isosurfaces"][0]["value"] = value
            scene["camera"]["vertical_angle"] = angle
            self.write("still.json", json.dumps(scene).encode())
            self.succeed("render", "still.json", "-o", "o.exr")
            self.succeed("compare", f"f/{frame}.exr", "o.exr", "--tolerance", "1e-12")
        scene["layers"][0]["visible"] = False
        self.write("still.json", json.dumps(scene).encode())
        self.succeed("render", "still.json", "-o", "o.exr")
        self.succeed("compare", "f/3.exr", "o.exr", "--tolerance", "1e-12")

    def test_frames_that_are_there_are_kept(self):
        arguments = ("animate", "builtin:shells:16", "-o", "f/%d.png", "--size", "16", "--frames",
                     "4")
        self.succeed(*arguments)
        whole = {name: self.read("f/" + name) for name in self.frames()}
        os.utime(self.path("f/1.png"), (1, 1))
        for name, damage in (("0.png", lambda b: b[:len(b) // 2]), ("2.png", lambda b: b""),
                             ("3.png", lambda b: b[:-30] + bytes([b[-30] ^ 1]) + b[-29:])):
            self.write("f/" + name, damage(whole[name]))
        note = self.note(*arguments)
        self.assertIn("1 were there", note)
        self.assertEqual({name: self.read("f/" + name) for name in self.frames()}, whole)
        self.assertEqual(os.stat(self.path("f/1.png")).st_mtime, 1)
        # Of another film none is.
        note = self.note(*arguments, "--tolerance", "1/64")
        self.assertNotIn("were there", note)
        self.assertNotEqual(os.stat(self.path("f/1.png")).st_mtime, 1)

    def test_a_film_that_was_killed_goes_on(self):
        arguments = ["animate", "builtin:shells:32", "--frames", "30", "--size", "64", "-q", "-o"]
        self.succeed(*arguments, "whole/%02d.png")
        with subprocess.Popen([PROGRAM, *arguments, "f/%02d.png"], cwd=self.path("")) as process:
            limit = time.monotonic() + 60
            while time.monotonic() < limit:
                if os.path.exists(self.path("f/03.png")):
                    break
                time.sleep(0.01)
            process.send_signal(signal.SIGKILL)
        self.succeed(*arguments, "f/%02d.png")
        for name in self.frames("whole"):
            self.assertEqual(self.read("f/" + name), self.read("whole/" + name), name)

    def test_parts_make_the_same_frames(self):
        loud = ("animate", "builtin:shells:16", "--size", "16", "--frames", "5")
        arguments = (*loud, "-q", "-o")
        self.succeed(*arguments, "whole/%d.png")
        result = self.run_program(*loud, "-o", "f/%d.png", "--part", "2/2")
        self.assertRegex(result.stderr.decode(), r"\n?pellucid: f/%d.png: 2 of 5 frames, 0\.\d+ s")
        self.assertEqual(self.frames(), ["1.png", "3.png"])
        self.succeed(*arguments, "f/%d.png", "--part", "1/2")
        for name in self.frames("whole"):
            self.assertEqual(self.read("f/" + name), self.read("whole/" + name), name)
        for part in ("0/2", "3/2", "1", "1/2/3", "a/b"):
            self.fail_with("expected K/N", *arguments, "f/%d.png", "--part", part, code=2)

    @unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed: no ranks")
    def test_ranks_make_the_same_frames(self):
        arguments = ["animate", "builtin:shells:16", "--size", "16", "--frames", "5", "-q", "-o"]
        self.succeed(*arguments, "whole/%d.png")
        # What Open MPI itself does not free is no fault of ours, where a sanitizer looks.
        sanitizer = os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"
        environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1",
                       "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "ASAN_OPTIONS": sanitizer}
        run = ["mpirun", "--oversubscribe", "-n", "3", PROGRAM]
        subprocess.run([*run, *arguments, "f/%d.png", "--ranks", "--threads", "1"],
                       cwd=self.path(""), env=environment, check=True, capture_output=True,
                       timeout=600)
        for name in self.frames("whole"):
            self.assertEqual(self.read("f/" + name), self.read("whole/" + name), name)
        failed = subprocess.run([*run, *arguments, "f.gif", "--ranks"], cwd=self.path(""),
                                env=environment, check=False, capture_output=True, timeout=600)
        self.assertNotEqual(failed.returncode, 0)
        self.assertEqual(failed.stderr.count(b"cannot be a film"), 1)

    def test_frames_over_the_tolerance_are_named(self):
        self.write("mesh.vtk", OVERLAPPING)
        options = ["mesh.vtk", "--size", "24", "-q", "--frames"]
        for count, named in ((1, "frame 0 may be .*; its"), (2, "frames 0 and 1 may be .*; their"),
                             (3, "frames 0, 1 and 2 may be .*; their")):
            # Also where they are there already.
            for _ in range(2):
                result = self.run_program("animate", *options, str(count), "-o",
                                          f"f{count}/%d.png")
                self.assertEqual(result.returncode, 3, result.stderr)
                self.assertRegex(result.stderr.decode(), f"some pixels of {named} metadata say")

    def test_steps_in_time(self):
        # Out of order in the file; the values of a step are all the same.
        order, values = [2, 0, 3, 1], [1, 2, 8, 4]
        self.write("run.vti", steps([TIMES[i] for i in order], [[values[i]] for i in order]))
        function = {"points": [{"value": 0, "extinction": 0, "color": [1, 1, 1]},
                               {"value": 8, "extinction": 0.8, "color": [1, 1, 1]}]}
        self.write("tf.json", json.dumps(function).encode())
        note = self.note("animate", "run.vti", "--tf", "tf.json", "--size", "9", "--view",
                         "front", "--background", "transparent", "-o", "f/%d.png")
        self.assertIn("4 frames, 0.4 s", note)
        # Through the middle of a box of 3: 1 - exp(-3 · 0.1 · value).
        for i, value in enumerate(values):
            alpha = pixel(self.picture(f"f/{i}.png"), 4, 4)[3] / 255
            self.assertAlmostEqual(alpha, 1 - math.exp(-0.3 * value), delta=0.0045)

    def test_times_that_no_scene_can_name(self):
        self.write("run.vti", steps([0.0, 0.5, 1e300], [[1], [2], [3]]))
        told = self.note("animate", "run.vti", "-o", "f/%d.png", "--size", "16")
        self.assertIn("steps left out: 1, whose times are beyond", told)
        self.assertEqual(self.frames(), ["0.png", "1.png"])

    def test_a_track_of_the_time(self):
        self.write("run.vti", steps(TIMES, [[1], [2], [8], [4]]))
        scene = {"layers": [{"field": {"file": "run.vti"}, "transfer_function": {"points": [
            {"value": 0, "extinction": 0, "color": [1, 1, 1]},
            {"value": 8, "extinction": 0.8, "color": [1, 1, 1]}]}}],
            "image": {"width": 9, "height": 9}, "time": 4,
            "camera": {"position": [1.5, 1.5, 20], "focal_point": [1.5, 1.5, 1.5],
                       "up": [0, 1, 0], "projection": "orthographic", "parallel_scale": 1.4}}
        scene["image"]["background"] = None
        times = [{"at": 0, "value": 0}, {"at": 2, "value": 2}, {"at": 3, "value": 0}]
        animation = {"seconds": 4, "fps": 1, "tracks": [{"target": "/time", "keys": times}]}
        self.write("scene.json", json.dumps({**scene, "animation": animation}).encode())
        self.succeed("animate", "scene.json", "-o", "f/%d.png")
        for frame, value in enumerate([1, 2, 8, 1]):  # at 0, nearest to 1, 2, and 0 again
            alpha = pixel(self.picture(f"f/{frame}.png"), 4, 4)[3] / 255
            self.assertAlmostEqual(alpha, 1 - math.exp(-0.3 * value), delta=0.0045)
        for more, why in (({"time": [0, 2]}, 'stands beside "time"'),
                          ({"tracks": [{"target": "/time", "keys": [{"at": 0, "value": "x"}]}]},
                           "whose value is no number")):
            self.write("scene.json", json.dumps(
                {**scene, "animation": {**animation, **more}}).encode())
            self.fail_with(why, "animate", "scene.json", "-o", "g/%d.png")
        scene["layers"][0]["field"] = {"builtin": "shells"}
        del scene["time"]
        self.write("scene.json", json.dumps({**scene, "animation": animation}).encode())
        self.fail_with('"time" moves, but no data', "animate", "scene.json", "-o", "g/%d.png")

    def test_values_between_steps(self):
        self.write("run.vti", steps([0, 2, 3], [[1], [5], [2]]))
        function = {"points": [{"value": 0, "extinction": 0, "color": [1, 1, 1]},
                               {"value": 8, "extinction": 0.8, "color": [1, 1, 1]}]}
        self.write("tf.json", json.dumps(function).encode())
        self.succeed("animate", "run.vti", "--tf", "tf.json", "--size", "9", "--view", "front",
                     "--background", "transparent", "--times", "0:3", "--frames", "4",
                     "--time-between", "linear", "-o", "f/%d.png")
        for i, value in enumerate([1, 3, 5, 2]):
            alpha = pixel(self.picture(f"f/{i}.png"), 4, 4)[3] / 255
            self.assertAlmostEqual(alpha, 1 - math.exp(-0.3 * value), delta=0.0045)

    def test_one_function_for_all_steps(self):
        self.write("run.vti", steps(TIMES, [[value + k / 63 for k in range(64)]
                                            for value in (1, 2, 8, 4)]))
        self.succeed("animate", "run.vti", "--look", "haze", "--size", "9", "-o", "f/%d.png")
        functions = {png_texts(self.read(f"f/{i}.png"))["pellucid.transfer_function"]
                     for i in range(4)}
        self.assertEqual(len(functions), 1)
        last = json.loads(functions.pop())["points"][-1]["value"]
        self.assertGreater(last, 7)  # the third step's, not the first one's

    def test_one_function_for_all_steps_of_large_data(self):
        # So large that every third value along each axis tells what they are.
        side, count = 120, 12
        for i in range(count):
            header = (b"{'descr': '|u1', 'fortran_order': False, 'shape': (%d, %d, %d)}"
                      % (side, side, side))
            head = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header
            row = bytes(j * (20 + 19 * i) // (side - 1) for j in range(side))
            self.write(f"run_{i:02}.npy", head + row * side ** 2)
        self.succeed("animate", "run_%02d.npy", "--look", "haze", "--size", "4", "-o", "f/%d.png")
        self.assertEqual(len(self.frames()), count)
        functions = {png_texts(self.read(f"f/{i}.png"))["pellucid.transfer_function"]
                     for i in range(count)}
        self.assertEqual(len(functions), 1)
        last = json.loads(functions.pop())["points"][-1]["value"]
        self.assertGreater(last, 200)
        self.assertLessEqual(last, 230)

    def function(self, name):
        return png_texts(self.read(name))["pellucid.transfer_function"]

    def test_a_picture_of_a_step_has_the_function_of_the_film(self):
        self.write("run.vti", steps(TIMES, [[value + k / 63 for k in range(64)]
                                            for value in (1, 2, 8, 4)]))
        size = ("--size", "9")
        for more in ((), ("--look", "haze"), ("--preset", "simulation-diverging"),
                     ("--colormap", "viridis"), ("--look", "haze", "--range", "2%:98%")):
            self.succeed("animate", "run.vti", *more, *size, "-o", "f/%d.png")
            films = {self.function(f"f/{i}.png") for i in range(4)}
            self.assertEqual(len(films), 1, more)
            for time in TIMES[1:3]:
                self.succeed("render", "run.vti", "--time", str(time), *more, *size, "-o", "o.png")
                self.assertEqual({self.function("o.png")}, films, more)
            shutil.rmtree(self.path("f"))
        # So do its pixels.
        self.succeed("render", "run.vti", "--time", "0", "--look", "haze", *size, "-o", "a.png",
                     "--save-tf", "tf.json")
        self.assertGreater(json.loads(self.read("tf.json"))["points"][-1]["value"], 7)
        self.succeed("render", "run.vti", "--time", "0", "--tf", "tf.json", *size, "-o", "b.png")
        self.assertEqual(self.picture("a.png"), self.picture("b.png"))
        self.succeed("render", "run.vti", "--look", "haze", *size, "-o", "c.png")
        self.assertNotEqual(self.picture("a.png"), self.picture("c.png"))
        # A scene says so as well, unless a source has a time of its own.
        scene = {"layers": [{"field": {"file": "run.vti"}}], "time": 2,
                 "image": {"width": 9, "height": 9}}
        self.write("scene.json", json.dumps(scene).encode())
        self.succeed("render", "scene.json", "-o", "o.png")
        pooled = self.function("o.png")
        self.assertGreater(json.loads(pooled)["points"][-1]["value"], 8)
        scene["time"] = 0
        self.write("scene.json", json.dumps(scene).encode())
        self.succeed("render", "scene.json", "-o", "o.png", "--save-scene", "saved.json")
        self.assertEqual(self.function("o.png"), pooled)
        self.succeed("render", "saved.json", "-o", "o.png")
        self.assertEqual(self.function("o.png"), pooled)
        del scene["time"]
        scene["layers"][0]["field"]["time"] = 0
        self.write("scene.json", json.dumps(scene).encode())
        self.succeed("render", "scene.json", "-o", "o.png")
        self.assertLessEqual(json.loads(self.function("o.png"))["points"][-1]["value"], 2)

    def blob(self, step, side=8):
        """Distances from a middle that moves with the step."""
        return [((x - 3 - step / 2) ** 2 + (y - 3.5) ** 2 + (z - 3.5) ** 2) ** 0.5
                for z in range(side) for y in range(side) for x in range(side)]

    def expect_film_of_pictures(self, count, *arguments):
        """Frames are the pictures of their times, no two are the same, and none is empty."""
        self.run_in_film("render", *arguments, "--time", "0", "-o", "o.png",
                         "--save-scene", "saved.json")
        camera = json.loads(self.read("saved.json"))["camera"]
        self.write("camera.json", json.dumps(camera).encode())
        self.run_in_film("animate", *arguments, "--camera", "camera.json", "-o", "f/%d.png")
        frames = [self.picture(f"f/{i}.png") for i in range(count)]
        for i, frame in enumerate(frames):
            self.run_in_film("render", *arguments, "--camera", "camera.json", "--time", str(i),
                             "-o", "o.png")
            self.assertEqual(self.picture("o.png"), frame, (i, arguments))
            self.assertEqual(frames.count(frame), 1, (i, arguments))
            self.assertGreater(max(max(row) for row in frame[3]), 0, (i, arguments))
        shutil.rmtree(self.path("f"))
        return frames

    def run_in_film(self, *arguments):
        return self.succeed(*arguments, "--size", "16", "--background", "transparent")

    def test_labels_of_all_steps_have_colors(self):
        values = [label if distance < 2.5 else 0 for step, label in enumerate((1, 2, 3, 5))
                  for distance in self.blob(step)]
        self.write("labels.npy", npy(values, (8, 8, 8, 4), "<u1"))
        axes = ("--array-axes", "tzyx")
        by_look = self.expect_film_of_pictures(4, "labels.npy", *axes, "--look", "labels")
        self.assertEqual(self.expect_film_of_pictures(4, "labels.npy", *axes), by_look)
        # Each label has a color of its own.
        middles = {pixel(frame, 8, 8)[:3] for frame in by_look}
        self.assertEqual(len(middles), 4)
        scene = {"layers": [{"labels": {"file": "labels.npy", "axes": "tzyx"}}]}
        self.write("scene.json", json.dumps(scene).encode())
        self.assertEqual(self.expect_film_of_pictures(4, "scene.json"), by_look)

    def test_an_initial_condition_does_not_choose_the_look(self):
        values = []
        for step in range(5):
            width = 0.05 + 0.8 * step
            values += [1 / (1 + math.exp((distance - 2.5) / width)) / (1 + step)
                       if step else float(distance < 2.5) for distance in self.blob(0)]
        self.write("spreads.npy", npy(values, (8, 8, 8, 5)))
        self.expect_film_of_pictures(5, "spreads.npy", "--array-axes", "tzyx", "--iso", "0.1")
        notes = self.note("render", "spreads.npy", "--array-axes", "tzyx", "--time", "4", "--size",
                          "16", "-o", "o.png")
        self.assertNotIn("look mask", notes)
        self.assertGreater(max(max(row) for row in self.picture("o.png")[3]), 0)

    def test_slices_have_the_range_of_all_steps(self):
        values = [(step + 1) * distance for step in range(4) for distance in self.blob(step)]
        self.write("grows.npy", npy(values, (8, 8, 8, 4)))
        arguments = ("grows.npy", "--array-axes", "tzyx", "--slice", "z=3.5")
        for more in ((), ("--colormap", "viridis"), ("--range", "0:9")):
            self.expect_film_of_pictures(4, *arguments, *more)
        largest = [max(max(row[0::4]) for row in self.picture_of(step, arguments)[3])
                   for step in range(4)]
        self.assertEqual(largest, sorted(largest))
        self.assertLess(largest[0], 150)

    def picture_of(self, step, arguments):
        self.run_in_film("render", *arguments, "--time", str(step), "-o", "o.png")
        return self.picture("o.png")

    def test_meshes_have_one_function(self):
        for step in range(3):
            points = " ".join(f"{x} {y} {z}" for z in (0, 1) for y in (0, 1) for x in (0, 1))
            values = " ".join(str((step + 1) ** 2 * k) for k in range(8))
            self.write(f"m{step}.vtu", (
                '<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="8" '
                'NumberOfCells="1"><PointData Scalars="a"><DataArray type="Float32" Name="a" '
                f'format="ascii">{values}</DataArray></PointData><Points><DataArray '
                f'type="Float32" NumberOfComponents="3" format="ascii">{points}</DataArray>'
                '</Points><Cells><DataArray type="Int32" Name="connectivity" format="ascii">'
                '0 1 3 2 4 5 7 6</DataArray><DataArray type="Int32" Name="offsets" '
                'format="ascii">8</DataArray><DataArray type="UInt8" Name="types" '
                'format="ascii">12</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>'
            ).encode())
        self.write("m.pvd", b'<VTKFile type="Collection"><Collection>' + b"".join(
            b'<DataSet timestep="%d" file="m%d.vtu"/>' % (i, i) for i in range(3))
            + b"</Collection></VTKFile>")
        for more in ((), ("--look", "haze"), ("--preset", "x-ray"), ("--slice", "z=0.5")):
            self.expect_film_of_pictures(3, "m.pvd", *more)

    def test_a_step_that_cannot_be_read_hinders_no_other(self):
        values = [value for step in range(3) for value in self.blob(step)]
        values[512 + 7] = math.inf
        self.write("inf.npy", npy(values, (8, 8, 8, 3)))
        for step in (0, 2):
            self.succeed("render", "inf.npy", "--array-axes", "tzyx", "--time", str(step), "--size",
                         "8", "-o", "o.png")
        self.fail_with("infinit", "render", "inf.npy", "--array-axes", "tzyx", "--time", "1",
                       "--size", "8", "-o", "p.png")

    def test_time_of_all_that_is_shown(self):
        for step in range(3):
            values = [float(distance < 1 + step) for distance in self.blob(0)]
            self.write(f"l{step}.npy", npy(values, (8, 8, 8)))
        self.write("l.npy.series", json.dumps({"file-series-version": "1.0", "files": [
            {"name": f"l{step}.npy", "time": step} for step in range(3)]}).encode())
        size = ("--size", "8", "-o", "o.png")
        self.write("s.json", json.dumps({"layers": [
            {"field": {"file": "l.npy.series"}, "transfer_function": {"preset": "x-ray"}},
            {"labels": {"file": "l.npy.series"}}]}).encode())
        for arguments in (("--labels", "l.npy.series"), ("s.json",),
                          ("l.npy.series", "--layer", "l.npy.series"),
                          ("--channel", "a=l.npy.series", "--gaussian", "a=2~1;extinction 1")):
            notes = self.note("render", *arguments, "--time", "1.2", *size)
            self.assertIn("step 2 of 3 is read", notes, arguments)
            self.assertNotIn("step 1", notes)
        self.fail_with("has no steps in time", "render", "builtin:shells:8", "--time", "1",
                       "--size", "8", "-o", "p.png", code=2)
        self.fail_with("--array applies", "render", "s.json", "--array", "a", "--size", "8", "-o",
                       "p.png", code=2)

    def test_time_of_a_scene(self):
        self.write("run.vti", steps([0, 3], [[1], [8]]))
        scene = {"layers": [{"field": {"file": "run.vti"}, "transfer_function": {"points": [
            {"value": 0, "extinction": 0, "color": [1, 1, 1]},
            {"value": 8, "extinction": 0.8, "color": [1, 1, 1]}]}}],
            "image": {"width": 8, "height": 8}, "time": 2.9}
        self.write("scene.json", json.dumps(scene).encode())
        self.succeed("render", "scene.json", "-o", "a.exr", "--save-scene", "saved.json")
        saved = json.loads(self.read("saved.json"))
        self.assertEqual(saved["layers"][0]["field"]["time"], 3)
        self.assertNotIn("time", saved)
        scene["layers"][0]["field"] = {"builtin": "shells"}
        self.write("scene.json", json.dumps(scene).encode())
        self.fail_with('"time" is given, but no data', "render", "scene.json", "-o", "a.exr")

    def test_what_is_no_film(self):
        source = "builtin:shells:16"
        for name in ("o.png", "o.gif", "o%d%d.png", "o%s.png", "o%5d.png", "o.webm.txt"):
            self.fail_with("cannot be a film", "animate", source, "-o", name)
        self.fail_with("nothing to write", "animate", source, code=2)
        self.fail_with("no input", "animate", "-o", "o%d.png", code=2)
        self.fail_with("is a share of one picture", "animate", source, "-o", "o%d.png",
                       "--tolerance", "1%", code=2)
        self.fail_with("expected FIRST:LAST", "animate", source, "-o", "o%d.png", "--times", "3",
                       code=2)
        self.fail_with("no data of the scene have steps", "animate", source, "-o", "o%d.png",
                       "--times", "0:1")
        for option, value in (("--fps", "0"), ("--seconds", "-1"), ("--turns", "nan")):
            self.fail_with("expected a number", "animate", source, "-o", "o%d.png", option, value,
                           code=2)
        for target, words in (
                ("/layers/1/visible", "has 1 elements, counted from 0"),
                ("/layers/0", "whole layers"), ("/image/width", "the size of the film"),
                ("/layers/0/isosurfaces/0/valu", "unknown key"), ("layers", "no JSON pointer"),
                ("/camera~2", "a ~ that neither"), ("/animation/fps", "the same in all frames"),
                ("/layers/0/isosurfaces/0/value/x", "is a single value")):
            self.scene({"seconds": 1, "fps": 2, "tracks": [
                {"target": target, "keys": [{"at": 0, "value": 1}]}]})
            self.fail_with(words, "animate", "scene.json", "-o", "o%d.png")
        # A key that no frame reaches is looked at as well.
        self.scene({"seconds": 1, "fps": 2, "tracks": [
            {"target": "/layers/0/isosurfaces/0/value",
             "keys": [{"at": 0, "value": 1}, {"at": 1, "value": "high"}]}]})
        self.fail_with("at 1.0 s: /layers/0/isosurfaces/0/value", "animate", "scene.json", "-o",
                       "o%d.png")
        self.assertEqual(sorted(self.files()), ["scene.json"])

    def test_the_data_are_not_overwritten(self):
        os.mkdir(self.path("st"))
        self.succeed("animate", "builtin:shells:16", "--size", "8", "--frames", "3", "-q", "-o",
                     "st/s%d.png")
        before = {name: self.read("st/" + name) for name in self.frames("st")}
        for source in (("st",), ("st/s0.png",), ("st/s%d.png",),
                       ("builtin:shells:16", "--layer", "st")):
            for command, output in (("animate", "st/s%d.png"), ("animate", "st/%d.png"),
                                    ("render", "st/s1.png")):
                if source[0] != "st" and output == "st/%d.png":
                    continue
                self.fail_with("overwrite", command, *source, "-o", output, "--size", "8", code=2)
        self.assertEqual({name: self.read("st/" + name) for name in self.frames("st")}, before)

    def test_the_camera_holds_what_moves(self):
        # A bright corner that goes to the other side of the data.
        values = [[0] * 64 for _ in range(2)]
        values[0][0] = values[1][63] = 1
        self.write("run.vti", steps([0, 1], values))
        self.succeed("animate", "run.vti", "--look", "haze", "--size", "32", "--background",
                     "transparent", "-o", "f/%d.png")
        for i in range(2):
            _, _, _, rows = self.picture(f"f/{i}.png")
            self.assertTrue(any(any(row[3::4]) for row in rows), f"frame {i} is empty")

    def test_without_ffmpeg(self):
        result = self.run_program("animate", "builtin:shells:16", "-o", "o.webm",
                                  env={**os.environ, "PATH": "/nowhere"})
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"ffmpeg, which was not found", result.stderr)
        self.assertEqual(self.files(), [])

    @unittest.skipUnless(FFMPEG, "ffmpeg is not installed: no video is made")
    def test_a_size_that_the_encoder_refuses(self):
        began = time.monotonic()
        result = self.run_program("animate", "builtin:shells:16", "-o", "o.mp4", "--size",
                                  "20000x32", "--frames", "1000", "--tolerance", "1e-7")
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"cannot encode it with 20000x32 pixels: invalid width", result.stderr)
        self.assertLess(time.monotonic() - began, 60)
        self.assertEqual(self.files(), [])

    @unittest.skipUnless(FFMPEG, "ffmpeg is not installed: no video is made")
    def test_one_video_at_a_time(self):
        film = ("animate", "builtin:shells:16", "-o", "o.webm", "--size", "600", "--frames", "500",
                "--tolerance", "1e-6", "-q")
        first = subprocess.Popen([PROGRAM, *film], cwd=self.path(""), stderr=subprocess.DEVNULL)
        try:
            deadline = time.monotonic() + 60
            while not os.path.exists(self.path("o.webm.frames")):
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.05)
            for more in ([], ["--part", "1/2"]):
                second = self.run_program(*film, *more)
                self.assertEqual(second.returncode, 1, more)
                self.assertIn(b"another call makes this video now", second.stderr)
        finally:
            first.kill()
            first.wait()
        # Parts are made beside each other, and a call that was killed holds nothing.
        short = ("animate", "builtin:shells:16", "-o", "o.webm", "--size", "16", "--frames", "2",
                 "-q")
        part = subprocess.Popen([PROGRAM, *film, "--part", "1/2"], cwd=self.path(""),
                                stderr=subprocess.DEVNULL)
        try:
            time.sleep(2)
            self.assertIsNone(part.poll())
            self.succeed(*short, "--part", "2/2")
        finally:
            part.kill()
            part.wait()
        self.succeed(*short)
        self.assertIn("o.webm", self.files())

    @unittest.skipUnless(FFMPEG, "ffmpeg is not installed: no video is made")
    def test_a_shorter_film_leaves_no_pictures(self):
        film = ("animate", "builtin:shells:16", "-o", "o.webm", "--size", "16", "-q")
        self.succeed(*film, "--frames", "5", "--keep-frames")
        self.write("o.webm.frames/000006.png", b"of somebody else")
        self.succeed(*film, "--frames", "3", "--keep-frames")
        self.assertEqual(self.frames("o.webm.frames"),
                         ["000000.png", "000001.png", "000002.png", "000006.png"])
        os.remove(self.path("o.webm.frames/000006.png"))
        self.succeed(*film, "--frames", "2")
        self.assertEqual(self.files(), ["o.webm"])

    @unittest.skipUnless(FFMPEG, "ffmpeg is not installed: no video is made")
    def test_videos(self):
        # One color in all of the picture, which the video keeps but for its own rounding.
        scene = {"layers": [{"field": {"builtin": "constant", "points": 8}, "transfer_function": {
            "points": [{"value": 0, "extinction": 0, "color": [0, 0, 0]}]}}],
            "camera": {"position": [4, 0, 0], "focal_point": [0, 0, 0], "up": [0, 0, 1]},
            "image": {"width": 33, "height": 20, "background": [0.6, 0.2, 0.05]},
            "animation": {"seconds": 1, "fps": 5}}
        self.write("a b%.json", json.dumps(scene).encode())
        for name in ("a:b 100%.webm", "-o.mp4"):
            self.succeed("animate", "a b%.json", f"--output={name}", "-q")
            first = self.read(name)
            raw = subprocess.run(
                [FFMPEG, "-v", "error", "-i", "file:" + name, "-f", "rawvideo", "-pix_fmt",
                 "rgb24", "-"], cwd=self.path(""), capture_output=True, check=True).stdout
            self.assertEqual(len(raw), 5 * 34 * 20 * 3, name)  # a column more: sizes are even
            for channel, linear in enumerate((0.6, 0.2, 0.05)):
                signal_ = 1.055 * linear ** (1 / 2.4) - 0.055
                for column in (9, 32, 33):  # the last one is there twice
                    self.assertAlmostEqual(raw[(5 * 34 + column) * 3 + channel], 255 * signal_,
                                           delta=4)
            self.assertFalse(os.path.exists(self.path(name + ".frames")))
            os.remove(self.path(name))
            self.succeed("animate", "a b%.json", f"--output={name}", "-q", "--keep-frames")
            self.assertEqual(self.read(name), first, "two runs differ")
            self.assertEqual(len(os.listdir(self.path(name + ".frames"))), 5)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/device-check without a card: small, by the emulated device, and with planted defects.

  test_device_check.py SCRIPT BUILD
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest

SCRIPT, BUILD = sys.argv[1], sys.argv[2]
GLIBC = re.compile(r"(linux-vdso|ld-linux.*|lib(c|m|mvec|dl|pthread|rt|resolv|util))\.so\b.*")
UNLIT = ["spike, oblique", "band, oblique", "bonsai, outside"]


def call(*command, **options):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True,
                          check=False, **options)


def has_card():
    return pathlib.Path("/proc/driver/nvidia/version").exists()


class DeviceCheck(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.carried = pathlib.Path(cls.temporary.name) / "carried"
        cls.prepared = call(SCRIPT, "prepare", "--small", "--from", BUILD, "--to", cls.carried)
        cls.carried_files = sorted(path.name for path in cls.carried.glob("*"))
        # Once for all tests, which change what is in it.
        call("tar", "-C", cls.carried, "-xzf", cls.carried / "contents.tar.gz")

    def setUp(self):
        self.assertEqual(self.prepared.returncode, 0, self.prepared.stderr)
        folder = tempfile.TemporaryDirectory(dir=self.temporary.name)
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name) / "out"
        # Of its own, to be changed.
        self.folder = pathlib.Path(folder.name) / "folder"
        shutil.copytree(self.carried, self.folder, copy_function=os.link)
        self.contents = self.folder / "contents"
        self.programs = self.contents / "programs"

    def run_check(self, *arguments, device="emulated"):
        self.done = call(self.folder / "device-check", "run", "--small", "--device", device,
                         "--out", self.out, *arguments, cwd=self.folder)
        if not self.out.exists():
            return {}
        self.markdown = (self.out / "device-check.md").read_text()
        self.table = json.loads((self.out / "device-check.json").read_text())
        return {part["name"]: part for part in self.table["parts"]}

    def replace(self, name, script):
        """Puts a script in the place of a program, which it finds as $0.real."""
        program = self.programs / name
        program.rename(program.with_suffix(".real"))
        program.write_text("#!/usr/bin/env bash\n" + textwrap.dedent(script))
        program.chmod(0o755)

    def tools(self, **scripts):
        folder = self.folder / "tools"
        folder.mkdir()
        for name, script in scripts.items():
            tool = folder / name.replace("_", "-")
            tool.write_text("#!/usr/bin/env bash\n" + textwrap.dedent(script))
            tool.chmod(0o755)
        return "--tools", folder

    def test_the_folder_holds_what_is_needed_and_its_size_is_told(self):
        self.assertRegex(self.prepared.stdout, r"Prepared: .*carried, \d+ MiB")
        self.assertEqual(self.carried_files, ["contents.tar.gz", "device-check"])
        environments = {"device_check": {}}
        for name in "test_cuda", "pellucid":
            environments[name] = {"LD_LIBRARY_PATH": str(self.programs / "lib")}
        for name, environment in environments.items():
            needed = call("ldd", self.programs / name, env={**os.environ, **environment}).stdout
            for line in needed.splitlines():
                library, _, place = line.strip().partition(" => ")
                if not place or GLIBC.fullmatch(pathlib.Path(library.split()[0]).name):
                    continue
                self.assertTrue(place.startswith(str(self.programs / "lib")), f"{name}: {line}")

    def test_all_parts_pass_on_the_emulated_device(self):
        parts = self.run_check()
        self.assertEqual(self.done.returncode, 0, self.done.stdout + self.done.stderr)
        scan = (self.contents / "data/structured/bonsai.nii.gz").exists()
        for name, part in parts.items():
            if name == "speed-bonsai" and not scan:
                self.assertEqual(part["state"], "not run", part)
                self.assertIn("bonsai.nii.gz", part["remark"])
            elif name in ("memcheck", "racecheck", "initcheck", "synccheck", "kernels"):
                self.assertEqual(part["state"], "not run", part)
                self.assertIn("is not on this machine", part["remark"])
            else:
                self.assertEqual(part["state"], "passed", part)
        self.assertEqual(self.table["device"], "the functions of a card, on the CPU")
        views = [row for row in parts["matrix"]["rows"] if row["kind"] == "view"]
        self.assertGreater(sum(row["on_device"] for row in views), 8)
        self.assertGreater(sum(row["pixels"] for row in views), 8 * 6 * 64)
        truths = [row for row in parts["matrix"]["rows"] if row["kind"] == "truths"]
        self.assertEqual([row["made"] for row in truths], [0], "the truth was carried along")
        runs = [row for row in parts["second-run"]["rows"] if row["kind"] == "frame"]
        self.assertGreater(len(runs), 9)
        self.assertTrue(all(row["same_as_first_run"] and row["same_again"] for row in runs), runs)
        speeds = {}
        for part in parts.values():
            speeds.update({row["scene"]: row for row in part["rows"] if row["kind"] == "speed"})
        unlit = UNLIT if scan else UNLIT[:2]
        self.assertEqual(set(speeds), {name + lit for name in unlit for lit in ("", ", lit")})
        for name, row in speeds.items():
            self.assertGreater(row["exact"], 0)
            self.assertGreater(row["cpu"], 0)
            self.assertGreater(row["exact_error"], 0)
            self.assertLessEqual(row["exact_error"], 1 / 512)
            self.assertEqual(row["sampler"] > 0, not name.endswith("lit"), row)
            self.assertIn(f"| {name} | ", self.markdown)
        self.assertIn("| over the tolerance without saying so | 0 |", self.markdown)
        self.assertNotIn("**different**", self.markdown)
        log = (self.out / "device-check.log").read_text()
        for name in parts:
            if parts[name]["state"] == "passed":
                self.assertIn(f"== {name}: ", log)

    def test_a_wrong_pixel_is_told(self):
        # The truth of one pixel of one frame is off by 1/100 in one channel.
        truth = max((self.contents / "truths").glob("*.rgba64f"))
        numbers = memoryview(bytearray(truth.read_bytes())).cast("d")
        numbers[0] += 0.01
        truth.unlink()
        truth.write_bytes(numbers.cast("B"))
        parts = self.run_check("--parts", "matrix")
        self.assertEqual(self.done.returncode, 1)
        self.assertEqual(set(parts), {"card", "matrix"})
        self.assertEqual(parts["matrix"]["state"], "FAILED")
        wrong = [row for row in parts["matrix"]["rows"] if row.get("faults")]
        self.assertEqual(len(wrong), 1, wrong)
        self.assertGreater(wrong[0]["over"], 0)
        self.assertIn("| views with a fault | 1 |", self.markdown)
        self.assertIn(f"| {wrong[0]['scene']} | {wrong[0]['camera']}, ", self.markdown)
        self.assertIn("| matrix | scenes of the tolerance matrix against the truth | **FAILED** |",
                      self.markdown)

    def test_runs_that_differ_are_told(self):
        # The first run says other bits of one scene.
        self.replace("device_check", r"""
            "$0.real" "$@" || exit
            case "$* " in *first-run.rows\ --size*) ;; *) exit 0 ;; esac
            rows="$(printf '%s\n' "$@" | grep 'first-run.rows$')"
            sed -i '/"mesh"/s/"bits":"./"bits":"z/' "$rows"
            """)
        parts = self.run_check("--parts", "first-run,second-run")
        self.assertEqual(self.done.returncode, 1)
        self.assertEqual(parts["first-run"]["state"], "passed")
        self.assertEqual(parts["second-run"]["state"], "FAILED")
        self.assertEqual(parts["second-run"]["remark"], "mesh: not same_as_first_run")
        self.assertIn("| mesh | same | **different** |", self.markdown)
        self.assertIn("| grid | same | same |", self.markdown)

    def test_a_part_that_hangs_is_cut_off_and_the_others_run(self):
        self.replace("device_check", """
            if [ "$1" = matrix ]; then
              trap '' TERM
              while true; do sleep 1; done
            fi
            exec "$0.real" "$@"
            """)
        parts = self.run_check("--parts", "matrix,first-run,second-run", "--part-limit", "matrix=5")
        self.assertEqual(self.done.returncode, 1)
        self.assertEqual(parts["matrix"]["state"], "cut off after 5 s")
        self.assertEqual(parts["second-run"]["state"], "passed")
        self.assertIn("**cut off after 5 s**", self.markdown)

    def test_an_end_from_outside_ends_the_part_too(self):
        self.replace("device_check", """
            if [ "$1" = matrix ]; then
              echo $$ >"$0.number"
              exec sleep 1000
            fi
            exec "$0.real" "$@"
            """)
        number = self.programs / "device_check.number"
        command = [self.folder / "device-check", "run", "--small", "--device", "emulated",
                   "--out", self.out, "--parts", "matrix"]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL) as script:
            while not (number.exists() and number.read_text()) and script.poll() is None:
                time.sleep(0.05)
            script.terminate()
            self.assertEqual(script.wait(), 130)
        part = pathlib.Path("/proc") / number.read_text().strip()
        while part.exists():  # until it has seen the signal
            time.sleep(0.05)
        # What was there stays.
        self.assertIn("| card |", (self.out / "device-check.md").read_text())

    def test_what_a_part_found_before_it_was_cut_off_or_crashed_is_kept(self):
        self.replace("device_check", """
            if [ "$1" = matrix ]; then
              "$0.real" "$@"
              kill -SEGV $$
            fi
            exec "$0.real" "$@"
            """)
        parts = self.run_check("--parts", "matrix")
        self.assertEqual(self.done.returncode, 1)
        self.assertEqual(parts["matrix"]["state"], "ended with status 139")
        self.assertGreater(len(parts["matrix"]["rows"]), 8)
        self.assertIn("| over the tolerance without saying so | 0 |", self.markdown)

    def test_parts_for_which_no_time_is_left_are_told(self):
        parts = self.run_check("--limit", "6", "--parts", "matrix,program")
        self.assertEqual(self.done.returncode, 1)
        for name in "matrix", "program":
            self.assertEqual(parts[name]["state"], "not run")
            self.assertEqual(parts[name]["remark"], "no time was left")

    def test_tools_of_cuda_are_used_where_they_are(self):
        tools = self.tools(
            # As compute-sanitizer, which ends with the program's status or that of the option.
            compute_sanitizer="""
              tool="$2"
              [ "$1 $3" = "--tool --error-exitcode" ] || exit 9
              shift 4
              case "$tool" in
                synccheck) echo "========= Error: Device not supported"; exit 1 ;;
              esac
              "$@" || exit
              case "$tool" in
                racecheck) s="RACECHECK SUMMARY: 0 hazards displayed (0 errors, 0 warnings)" ;;
                memcheck) s="ERROR SUMMARY: 0 errors" ;;
                initcheck) echo "========= Uninitialized __global__ memory read of size 4 bytes"
                  s="ERROR SUMMARY: 3 errors" ;;
              esac
              echo "========= $s"
              case "$s" in *3*) exit 77 ;; esac
              """,
            ncu="""
              while [ "$1" != --log-file ]; do shift; done
              cat >"$2" <<'CSV'
              ==PROF== Connected to process 1
              "ID","Kernel Name","Device","gpu__time_duration.sum","launch__registers_per_thread"
              "","","","ns",""
              "0","void follow_pixels<1, 0>(S, T, bool)","0","1,500","168"
              "1","void follow_pixels<1, 0>(S, T, bool)","0","20,500","169"
              "2","void follow_pixels<0, 0>(S, T, bool)","0","900","255"
              CSV
              sed -i 's/^ *//' "$2"
              """)
        checks = "memcheck,racecheck,initcheck,synccheck,kernels"
        parts = self.run_check(*tools, "--parts", checks)
        self.assertEqual(self.done.returncode, 1)
        states = {name: part["state"] for name, part in parts.items()}
        self.assertEqual(states, {"card": "passed", "memcheck": "passed", "racecheck": "passed",
                                  "initcheck": "FAILED", "synccheck": "could not be done",
                                  "kernels": "passed"})
        self.assertIn("0 hazards", parts["racecheck"]["remark"])
        self.assertIn("3 errors", parts["initcheck"]["remark"])
        self.assertIn("Device not supported", parts["synccheck"]["remark"])
        self.assertEqual([(kernel["launches"], kernel["gpu__time_duration.sum"])
                          for kernel in self.table["kernels"]], [(2, "20,500"), (1, "900")])
        self.assertIn("  - launch__registers_per_thread: 169\n", self.markdown)

    def test_a_tool_that_saw_nothing_has_not_passed(self):
        tools = self.tools(compute_sanitizer="exit 0", ncu="exit 0")
        parts = self.run_check(*tools, "--parts", "memcheck,kernels")
        self.assertEqual(self.done.returncode, 1)
        for name in "memcheck", "kernels":
            self.assertEqual(parts[name]["state"], "could not be done", parts[name])

    def test_no_card_is_one_line_and_no_table(self):
        if has_card():
            self.skipTest("there is a card")
        parts = self.run_check(device="cuda")
        self.assertEqual(self.done.returncode, 3, self.done.stderr)
        self.assertEqual(parts, {})
        self.assertFalse(self.out.exists())
        self.assertEqual(self.done.stdout, "")
        self.assertEqual(self.done.stderr.count("\n"), 1, self.done.stderr)
        self.assertRegex(self.done.stderr, r"^device-check: device cuda: ")

    def test_a_program_that_does_not_start_is_one_line_and_no_table(self):
        # As one that was made for another machine, or cut off on its way.
        (self.programs / "device_check").unlink()
        (self.programs / "device_check").write_bytes(b"\x7fELF")
        (self.programs / "device_check").chmod(0o755)
        self.run_check()
        self.assertEqual(self.done.returncode, 3)
        self.assertFalse(self.out.exists())
        self.assertEqual(self.done.stderr.count("\n"), 1, self.done.stderr)

    def test_unknown_arguments_show_the_usage(self):
        for arguments in ((), ("walk",), ("run", "--fast"), ("run", "--out")):
            done = call(SCRIPT, *arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn("scripts/device-check run", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

# SPDX-License-Identifier: Apache-2.0
"""The bash completion, called as bash calls it: with the words of a command line."""
import os
import re
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["PELLUCID_PROGRAM"]
SCRIPT = os.path.join(os.environ["PELLUCID_SOURCE_DIR"],
                      "share", "bash-completion", "completions", "pellucid")

# Sets COMP_WORDS to the arguments, completes the last and prints the answers.
CALL = """
set -u
. "$1"
shift
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
_pellucid
if [ "${#COMPREPLY[@]}" -gt 0 ]; then printf '%s\\n' "${COMPREPLY[@]}"; fi
"""


def output_of(*arguments):
    return subprocess.run([PROGRAM, *arguments], stdout=subprocess.PIPE, text=True,
                          check=True).stdout


class Completion(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pellucid_completion_")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def complete(self, *words, program=PROGRAM):
        result = subprocess.run(
            ["bash", "--norc", "--noprofile", "-c", CALL, "bash", SCRIPT, program, *words],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True,
            timeout=120, check=False, cwd=self.folder)
        self.assertEqual((result.returncode, result.stderr), (0, ""), words)
        return result.stdout.splitlines()

    def test_commands(self):
        commands = re.findall(r"(?m)^  ([a-z-]+)  ", output_of("--help").split("Subcommands:")[1])
        self.assertIn("render", commands)
        self.assertEqual(set(self.complete("")), {*commands, "--help", "--version"})
        self.assertEqual(self.complete("ren"), ["render"])
        self.assertEqual(self.complete("--ver"), ["--version"])

    def test_options_are_those_of_the_command(self):
        for command in ("render", "info", "compare", "transfer-function"):
            text = output_of(command, "--help")
            heads = re.findall(r"(?m)^  (-.*?)(?:  |$)", text)
            options = {name for head in heads for name in head.split(" ")[0].split(",")}
            self.assertIn("--help", options)
            self.assertEqual(set(self.complete(command, "-")), options)
        self.assertEqual(self.complete("render", "brain.nii.gz", "--erro"), ["--error-map"])

    def test_values_with_choices(self):
        for option, value, others in (("--view", "front", 7), ("--grade", "proved", 2),
                                      ("--precision", "double", 3), ("--method", "exact", 13),
                                      ("--centering", "cell", 2), ("--type", "u16", 8),
                                      ("--colors", "srgb", 2)):
            with self.subTest(option=option):
                choices = self.complete("render", "builtin:shells", option, "")
                self.assertIn(value, choices)
                self.assertGreaterEqual(len(choices), others)
                self.assertEqual(self.complete("render", option, value), [value])
                # as bash parts --option=value
                self.assertEqual(self.complete("render", option, "=", value), [value])
                self.assertEqual(self.complete("render", option, "="), choices)
        self.assertIn("paraview", self.complete("transfer-function", "a", "--format", ""))
        self.assertIn("trilinear_cell", self.complete("evaluate", ""))

    def test_presets(self):
        names = [line.split()[0] for line in output_of("presets").splitlines()]
        self.assertIn("ct-bone", names)
        self.assertEqual(self.complete("render", "head.nrrd", "--preset", ""), names)

    def test_files_are_left_to_bash(self):
        for words in (("info", ""), ("info", "head"), ("render", "a.npy", "-o", ""),
                      ("render", "a.npy", "--output", "x"), ("render", "--tf", ""),
                      ("suggest", "--channel", ""), ("render", "--threads", ""),
                      ("evaluate", "trilinear_cell", "")):
            self.assertEqual(self.complete(*words), [], words)

    def test_an_option_without_value_is_followed_by_anything(self):
        self.assertEqual(self.complete("render", "--strict", "--strictl"), [])
        self.assertEqual(self.complete("render", "--strict", "--sampl"), ["--samples"])

    def test_built_in_fields(self):
        self.assertEqual(self.complete("render", "buil"), ["builtin:"])
        with open(os.path.join(self.folder, "built here.npy"), "wb"):
            pass
        self.assertEqual(self.complete("render", "buil"), ["builtin:", "built here.npy"])
        self.assertIn("shells", self.complete("render", "builtin", ":"))
        self.assertEqual(self.complete("info", "builtin", ":", "hyd"), ["hydrogen"])

    def test_no_program(self):
        self.assertEqual(self.complete("", program="/nowhere/pellucid"), [])

    def test_nothing_is_written(self):
        # The program is run to ask for its choices: never so that it writes.
        for command in ("render", "convert", "suggest"):
            for option in ("--size", "--step", "--dimensions", "--output", "--primitives"):
                self.complete(command, option, "")
        self.assertEqual(os.listdir(self.folder), [])

    def test_bash_loads_it_by_name(self):
        result = subprocess.run(["bash", "--norc", "--noprofile", "-c",
                                 '. "$1" && complete -p pellucid', "bash", SCRIPT],
                                stdout=subprocess.PIPE, text=True, check=True)
        self.assertIn("-F _pellucid pellucid", result.stdout)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: Apache-2.0
import os
import re
import shlex
import unittest

from program import SOURCE_DIR, ProgramTest, options_of

COMMANDS = ("render", "animate", "view", "info", "histogram", "suggest", "convert", "export",
            "evaluate", "compare", "presets", "transfer-function")
READ_VOLUMES = ("render", "animate", "view", "info", "histogram", "suggest", "convert", "export")


def options_of_manual(text):
    """The long options that begin an item of a list, or a row of a table, of the manual."""
    return set(re.findall(r"(?m)^(?:\||-) `(?:-\w, )?(--[a-z][a-z-]*)", text))


class Help(ProgramTest):
    def manual(self):
        path = os.path.join(SOURCE_DIR, "docs", "reference", "command-line.md")
        with open(path, encoding="utf-8") as file:
            return file.read()

    def introduction(self):
        return self.manual().split("\n## ")[0]

    def section(self, command):
        match = re.search(rf"(?ms)^## pellucid {command}$(.*?)(?=^## |\Z)", self.manual())
        self.assertIsNotNone(match, f"docs/reference/command-line.md has no section on {command}")
        return match.group(1)

    def test_every_help_has_examples(self):
        for arguments in ((), *((command,) for command in COMMANDS)):
            text = self.succeed(*arguments, "--help")
            self.assertIn("Examples:\n  pellucid ", text)
            for line in text.splitlines():
                self.assertLessEqual(len(line), 100, line)

    def test_every_command_is_in_the_overview(self):
        text = self.succeed("--help")
        listed = re.findall(r"(?m)^  ([a-z-]+)  ", text[text.index("Subcommands:"):])
        self.assertEqual(sorted(listed), sorted(COMMANDS))

    def test_manual_and_help_name_the_same_options(self):
        for command in COMMANDS:
            of_help = options_of(self.succeed(command, "--help"))
            self.assertIn("--help", of_help)
            of_manual = options_of_manual(self.section(command))
            if command in READ_VOLUMES:
                of_manual |= options_of_manual(self.introduction())
            if command in ("view", "export", "animate"):
                # They take those of render that say what is seen.
                of_manual |= options_of_manual(self.section("render")) & set(of_help)
            self.assertEqual(set(of_help) - {"--help"} - of_manual, set(),
                             f"{command}: not in docs/reference/command-line.md")
            self.assertEqual(of_manual - set(of_help), set(),
                             f"{command}: in docs/reference/command-line.md but not in --help")

    def test_examples_of_the_help_are_understood(self):
        # They stop at the missing file, not at their arguments.
        for command in COMMANDS:
            text = self.succeed(command, "--help").split("Examples:\n")[1]
            for example in re.sub(r"\n {4,}", " ", text).strip().splitlines():
                words = shlex.split(example.split(" > ")[0])
                self.assertEqual(words[0], "pellucid")
                # A page without a file waits for one.
                if words == ["pellucid", "view"] or words[2].startswith("builtin:"):
                    continue
                with self.subTest(example=example):
                    self.fail_with("error", *words[1:])

    def test_version(self):
        with open(os.path.join(SOURCE_DIR, "include", "pellucid", "base", "version.h"),
                  encoding="utf-8") as file:
            version = re.search(r'PELLUCID_VERSION_STRING "([^"]+)"', file.read()).group(1)
        self.assertEqual(self.succeed("--version"), f"pellucid {version}\n")

    def test_wrong_arguments(self):
        self.fail_with(r"--help", code=2)
        self.fail_with(r"paint.*'pellucid --help'", "paint", code=2)
        for command in COMMANDS:
            if command not in ("presets", "view"):  # which need no argument
                self.fail_with(rf"'pellucid {command} --help'", command, code=2)
            positional = ("a",)
            if command == "evaluate":
                positional = ("linear_segment", "a.csv", "-o", "b.csv")
            positional += ("-o", "b.vtu") if command == "convert" else ()
            positional += ("b",) if command == "compare" else ()
            self.fail_with(rf"--frobnicate.*'pellucid {command} --help'", command, *positional,
                           "--frobnicate", code=2)


if __name__ == "__main__":
    unittest.main()

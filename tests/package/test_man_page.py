# SPDX-License-Identifier: Apache-2.0
"""The manual page that tools/man_page.py makes of the program's --help."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.environ["PELLUCID_PROGRAM"]
MAN_PAGE = os.path.join(os.environ["PELLUCID_SOURCE_DIR"], "tools", "man_page.py")


def make(program, page):
    return subprocess.run([sys.executable, "-B", MAN_PAGE, program, page], text=True, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


class ManPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="pellucid_man_")
        cls.page = os.path.join(cls.folder, "pellucid.1")
        result = make(PROGRAM, cls.page)
        assert result.returncode == 0, result.stderr
        with open(cls.page, encoding="ascii") as file:
            cls.text = file.read()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_has_the_sections(self):
        self.assertEqual(re.findall(r"(?m)^\.SH (.*)$", self.text),
                         ["NAME", "SYNOPSIS", "DESCRIPTION", "COMMANDS", "EXIT STATUS",
                          "ENVIRONMENT", "FILES", "EXAMPLES", "SEE ALSO"])

    def test_has_every_option_of_every_command(self):
        plain = self.text.replace("\\-", "-")
        overview = subprocess.run([PROGRAM, "--help"], stdout=subprocess.PIPE, text=True,
                                  check=True).stdout.split("Subcommands:")[1]
        commands = re.findall(r"(?m)^  ([a-z-]+)  ", overview)
        self.assertEqual(re.findall(r"(?m)^\.SS pellucid (.*)$", plain), commands)
        for command in commands:
            text = subprocess.run([PROGRAM, command, "--help"], stdout=subprocess.PIPE, text=True,
                                  check=True).stdout
            for option in re.findall(r"(?m)^  (?:-\w,)?(--[a-z-]+)", text):
                if option != "--help":
                    self.assertRegex(plain, rf"(?m)^\.B .*{option}\b", command)

    def test_has_the_exit_codes(self):
        codes = self.text.split(".SH EXIT STATUS")[1].split(".SH")[0]
        self.assertEqual(re.findall(r"(?m)^\.B (\d+)$", codes), ["0", "1", "2", "3", "130"])

    def test_formats_without_a_warning(self):
        checked = False
        for command in (["groff", "-man", "-ww", "-z", "-Tutf8"],
                        ["mandoc", "-Tlint", "-Wstyle"]):
            if shutil.which(command[0]):
                checked = True
                result = subprocess.run([*command, self.page], stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True, check=False)
                self.assertEqual((result.returncode, result.stdout), (0, ""))
        if not checked:
            self.skipTest("neither groff nor mandoc is installed")

    def test_is_the_same_when_made_again(self):
        again = os.path.join(self.folder, "again.1")
        self.assertEqual(make(PROGRAM, again).returncode, 0)
        with open(again, encoding="ascii") as file:
            self.assertEqual(file.read(), self.text)

    def fake(self, top):
        """A program with this text for --help."""
        path = os.path.join(self.folder, "fake")
        with open(path, "w", encoding="utf-8") as file:
            file.write(f"#!{sys.executable}\nimport sys\nprint({top!r} if sys.argv[1:] == "
                       "['--help'] else 'Does it.\\nUsage: pellucid do\\n\\nOptions:\\n  -x  Á\\n"
                       "\\n.odd \\'line\\n\\nExamples:\\n  .x \\\\n')\n")
        os.chmod(path, 0o755)
        return path

    def test_odd_texts_are_escaped(self):
        page = os.path.join(self.folder, "odd.1")
        result = make(self.fake("Does.\n\nExit codes: 0 done, 1 not. It ends.\n\nSubcommands:\n"
                                "  do   Does it\n\nExamples:\n  pellucid do"), page)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(page, encoding="ascii") as file:
            text = file.read()
        self.assertIn("\n\\&.odd \\(aqline\n", text)
        self.assertIn("\n\\&.x \\en\n", text)
        self.assertIn("\\[u00C1]", text)

    def test_a_help_text_without_exit_codes_is_an_error(self):
        page = os.path.join(self.folder, "none.1")
        result = make(self.fake("Does.\n\nSubcommands:\n  do   Does it\n\nExamples:\n  x"), page)
        self.assertEqual(result.returncode, 1)
        self.assertIn("exit codes", result.stderr)
        self.assertFalse(os.path.exists(page))


if __name__ == "__main__":
    unittest.main()

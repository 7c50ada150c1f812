#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of a page, in their order, in an empty folder.

  run_blocks.py ROOT BUILD_FOLDER PAGE

Run are its blocks of sh, in one shell, and those of python. The program is found in the PATH, and
the folder holds a `pellucid` with the sources and with the build as `build/release`: a checkout as
the reader has it. A comment on the line before a block says what else is done with it:

  <!-- file: NAME -->       written to that file, whatever its language
  <!-- not run: REASON -->  not run

A block of text shows what the commands print. Each of its lines must be printed, with any numbers;
an ellipsis stands for anything.

Files of OPTIONAL, such as the brain MRI of Debian's mricron-data, may be missing here. A command
that names one is left out with a message, and so is every later one that needs what it would have
made.
"""
import importlib.util
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

from documents import Page

OPTIONAL = ("/usr/share/mricron/",)
FILE_NAME = re.compile(r"[\w./%~-]*\.[A-Za-z]\w*(?:\.\w+)*")


def commands_of(text, line):
    """Yields (line, command) of a block of sh: continued lines and here-documents are one
    command."""
    begin, command = line, ""
    for number, current in enumerate(text.splitlines(), line):
        if not command and (not current.strip() or current.lstrip().startswith("#")):
            continue
        if not command:
            begin = number
        command += current + "\n"
        if current.endswith("\\"):
            continue
        parsed = subprocess.run(["bash", "-n"], input=command, capture_output=True, text=True)
        if parsed.returncode == 0 and not parsed.stderr:
            yield begin, command
            command = ""
    if command:
        yield begin, command


class MissingFiles:
    """Tells which commands need files that are not here, and so make none that others need."""

    def __init__(self):
        self.names = set()

    def of(self, text):
        """The missing files that the text names; what else it names is missing from then on."""
        named = set(FILE_NAME.findall(text))
        missing = {name for name in named
                   if name in self.names
                   or (name.startswith(OPTIONAL) and not pathlib.Path(name).exists())}
        if missing:
            self.names |= {name for name in named if not pathlib.Path(name).is_absolute()}
        return missing

    def names_in(self, text):
        """The missing files that code names; what else it names may be no file."""
        return {name for name in self.names if name in text}

    def add(self, text):
        self.names |= set(FILE_NAME.findall(text))


def python_modules(text):
    """The names of the modules that the code imports, one in each statement."""
    return set(re.findall(r"^(?:import|from) +(\w+)", text, re.M))


def script_of(page, name):
    """The shell script that does what the page says, and the commands that it runs."""
    script = ["set -euo pipefail"]
    run = []
    missing = MissingFiles()

    def leave_out(place, why):
        script.append(f"echo {shlex.quote(f'{place}: left out: {why}')}")

    for block in page.blocks:
        place = f"{name}:{block.line}"
        kind, _, value = block.mark.partition(":")
        if kind == "not run":
            leave_out(place, value.strip())
        elif kind == "file":
            script.append(f"cat >{shlex.quote(value.strip())} <<'end of file'\n{block.text}"
                          "end of file")
        elif block.language == "python":
            lacking = [module for module in sorted(python_modules(block.text))
                       if importlib.util.find_spec(module) is None]
            files = sorted(missing.names_in(block.text))
            if lacking:
                leave_out(place, f"no module {', '.join(lacking)} here")
                missing.add(block.text)
            elif files:
                leave_out(place, f"no {', '.join(files)} here")
            else:
                script.append(f"echo {shlex.quote(place)}\n{shlex.quote(sys.executable)} - "
                              f"<<'end of file'\n{block.text}end of file")
        elif block.language == "sh":
            for line, command in commands_of(block.text, block.line):
                lacking = missing.of(command)
                if lacking:
                    leave_out(f"{name}:{line}", f"no {', '.join(sorted(lacking))} here")
                else:
                    script.append(f"echo {shlex.quote(f'{name}:{line}: {command.strip()}')}\n"
                                  f"{command}")
                    run.append(command)
    return "\n".join(script) + "\n", run


def outputs_of(command):
    """The files that a command of the program is asked to write."""
    try:
        words = shlex.split(command.partition("|")[0], comments=True)
    except ValueError:
        return
    if words[:1] == ["pellucid"]:
        for option, value in zip(words, words[1:]):
            if option in ("-o", "--output", "--error-map", "--depth", "--save-tf", "--save-scene"):
                yield value


def make_checkout(root, build, folder):
    folder.mkdir()
    for entry in root.iterdir():
        if entry.name not in (".git", "build", "out"):
            (folder / entry.name).symlink_to(entry)
    (folder / "build").mkdir()
    (folder / "build" / "release").symlink_to(build)


def shown_but_not_printed(page, output):
    """Yields the lines of the page's blocks of text that no line of the output contains. Numbers
    may differ, and an ellipsis stands for anything."""
    def without_numbers(text):
        return re.sub(r"[0-9]+(?:\.[0-9]+)?(?:e[-+]?[0-9]+)?", "0", text)

    printed = [without_numbers(line) for line in output.splitlines()]
    for block in page.blocks:
        if block.language != "text" or block.mark:
            continue
        for line in block.text.splitlines():
            parts = re.split(r"\s*…\s*", without_numbers(line))
            pattern = ".*".join(re.escape(part) for part in parts)
            if not any(re.search(pattern, candidate) for candidate in printed):
                yield block.line, line


def run_script(script, folder, build):
    """Runs the script in the folder and prints what it prints; returns its status and output."""
    environment = dict(os.environ, PATH=f"{build / 'bin'}:{os.environ['PATH']}", HOME=str(folder))
    output = ""
    with subprocess.Popen(["bash", "-c", script], cwd=folder, env=environment, text=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT) as process:
        for line in process.stdout:
            print(line, end="", flush=True)
            output += line
    return process.returncode, output


def main(root, build, name):
    page = Page((root / name).read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary).resolve()
        make_checkout(root, build, folder / "pellucid")
        script, run = script_of(page, name)
        if "\n" not in script.strip():
            print(f"{name}: shows no command")
            return 1
        status, output = run_script(script, folder, build)
        if status != 0:
            print(f"{name}: the last command ended with {status}")
            return 1
        for file in [file for command in run for file in outputs_of(command)]:
            # Frames of a film have numbers in their names: %04d.
            name_of_any = re.sub(r"%0?\d*d", "*", pathlib.Path(file).name)
            written = folder.glob(f"**/{name_of_any}")
            if not any(path.stat().st_size for path in written):
                print(f"{name}: {file} was not written, or is empty")
                return 1
    if "left out: no " not in output:
        for line, text in shown_but_not_printed(page, output):
            print(f"{name}:{line}: no command printed: {text}")
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(),
                  sys.argv[3]))

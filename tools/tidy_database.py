#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the compilation database that clang-tidy goes through: the sources of src/ and apps/, or
the groups that include them (PELLUCID_UNITY), each once (kernels are compiled once per instruction
set, but say the same in each), and one source that includes every header of the core. Sources that
a build makes are left out.

  tidy_database.py COMPILE_COMMANDS FOLDER
"""
import json
import pathlib
import sys


def main():
    commands, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
    root = pathlib.Path(__file__).resolve().parent.parent
    ours = [f"{top}/{part}/" for top in (root, commands.resolve().parent)
            for part in ("src", "apps")]
    all_entries = [entry for entry in json.loads(commands.read_text())
                   if entry["file"].startswith(tuple(ours))
                   and pathlib.Path(entry["file"]).exists()]
    entries = list({entry["file"]: entry for entry in all_entries}.values())

    headers = sorted((root / "include").rglob("*.h"))
    source = folder / "all_headers.cpp"
    source.write_text("".join(f'#include "{header.relative_to(root / "include")}"\n'
                              for header in headers))
    entries.append({"directory": str(folder), "file": str(source),
                    "command": f"clang++ -std=c++20 -I{root}/include -c {source}"})
    (folder / "compile_commands.json").write_text(json.dumps(entries))


if __name__ == "__main__":
    main()

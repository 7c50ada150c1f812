#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Joins the modules of pako that are zlib itself to one script, which defines `pakoModules`.

  join_pako.py FOLDER OUTPUT      FOLDER: where the package pako is (Debian: node-pako)
"""
import pathlib
import re
import sys

# Each behind those that it requires.
MODULES = ("constants", "messages", "adler32", "crc32", "inffast", "inftrees", "inflate", "trees",
           "deflate", "zstream")


def main():
    folder, output = map(pathlib.Path, sys.argv[1:])
    parts = ["const pakoModules = (() => {", "const modules = {};"]
    for name in MODULES:
        text = (folder / "lib" / "zlib" / f"{name}.js").read_text(encoding="utf-8")
        text = re.sub(r"require\('\./(\w+)'\)", r"modules.\1", text)
        parts += [f"modules.{name} = (() => {{", "const module = {exports: {}};", text,
                  "return module.exports;", "})();"]
    parts += ["return modules;", "})();", ""]
    output.write_text("\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    main()

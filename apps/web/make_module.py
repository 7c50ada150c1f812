#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes Emscripten's script a module of ECMAScript, for browsers and for Node.

  make_module.py SCRIPT MODULE
"""
import pathlib
import sys

# In Node the script asks for modules of CommonJS.
BEFORE = """const require = typeof process === 'object' && process.versions?.node
  ? (await import('node:module')).createRequire(import.meta.url) : undefined;
const __dirname = '', __filename = '';
"""
AFTER = "\nexport default makePellucid;\n"


def main():
    script, module = map(pathlib.Path, sys.argv[1:])
    module.write_text(BEFORE + script.read_text(encoding="utf-8") + AFTER, encoding="utf-8")


if __name__ == "__main__":
    main()

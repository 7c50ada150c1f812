#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No two files of what ships define types of the same name in the same namespace.

  check_types.py ROOT

The linker takes one copy of an inline member or of std::vector<T>'s, whichever T it was compiled
for, so that two types of one name read and write each other's memory. No compiler says so. Sources
of kernels have a namespace per instruction set (PELLUCID_HAS_BATCH_4 and others), and are left out,
as are the headers native_….h, of which a processor has one; so is what stands in an anonymous
namespace.
"""
import collections
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "docs"))
from documents import repository_files  # noqa: E402 (tests/docs is no package)

TOP = ("apps", "include", "plugins", "python", "src")
SUFFIXES = (".h", ".cpp", ".cu")
OPENED = re.compile(r"(?:inline )?namespace(?: ([\w:]+))? \{\s*(\}.*)?$")
CLOSED = re.compile(r"\}\s*// namespace")
DEFINED = re.compile(r"(?:template ?<.*> )?(?:struct|class|union|enum class|enum) "
                     r"(?:\[\[.*?\]\] |alignas\([^)]*\) )*"
                     r"(\w+(?:<[^{]*>)?)(?: final)?(?:\s*:(?!:)[^;]*)?\s*\{")
KERNELS = re.compile(r"^#if PELLUCID_HAS_BATCH_.*?(?=^#endif|\Z)", re.MULTILINE | re.DOTALL)
# Heads of types that are laid out over several lines.
BROKEN = re.compile(r"^((?:struct|class|union|enum)\b[^;{()]*?)\n\s*(?=[:{,\w])", re.MULTILINE)


def types(text):
    """Yields the types that a file defines, with their namespaces."""
    text = KERNELS.sub("", text)
    while BROKEN.search(text):
        text = BROKEN.sub(r"\1 ", text)
    namespaces = []
    for line in text.splitlines():
        opened = OPENED.match(line)
        if opened:
            if not opened[2]:
                namespaces.append(opened[1])
        elif CLOSED.match(line):
            if namespaces:
                namespaces.pop()
        elif None not in namespaces:
            defined = DEFINED.match(line)
            if defined:
                yield "::".join([*namespaces, defined[1]])


def check(files):
    """Yields a line for each type that two of the files define: (path, text)."""
    places = collections.defaultdict(set)
    for path, text in files:
        for name in types(text):
            places[name].add(str(path))
    if not places:
        yield "no type was found"
    for name, found in sorted(places.items()):
        if len(found) > 1:
            yield f"{name}: is defined in {' and in '.join(sorted(found))}; rename one of them"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    names = [path for path in repository_files(root)
             if path.parts[0] in TOP and path.suffix in SUFFIXES
             and not path.name.startswith("native_")]
    faults = list(check((path, (root / path).read_text(encoding="utf-8")) for path in names))
    print("\n".join(faults) if faults else "each type is defined in one file")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

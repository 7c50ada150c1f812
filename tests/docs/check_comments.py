#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Comments begin with a noun or a verb: the number of those that do not only goes down.

  check_comments.py ROOT            fails if there are more than comment_openers.json allows
  check_comments.py ROOT --list     prints each of them, by kind
  check_comments.py ROOT --lower    writes smaller numbers into that file, never larger ones

Three kinds are counted in the C++ sources of FOLDERS, each by itself:

  clauses    blocks of /// that begin with one of the words of CLAUSE
  functions  blocks of /// above a function that begin with no verb ("Returns ...", "Throws ...");
             those of the first kind are not counted again
  notes      notes of ///< that begin with one of the words of CLAUSE
"""
import json
import pathlib
import re
import sys

from documents import repository_files, run_check

FOLDERS = ("apps", "include", "plugins", "python", "src")
SOURCE = re.compile(r"\.(h|cpp|cu)$")
CLAUSE = re.compile(r"(what|of|where|whether|how|those|as)\b", re.I)
KINDS = ("clauses", "functions", "notes")
NUMBERS = pathlib.PurePosixPath("tests/docs/comment_openers.json")
# How many fewer there may be before the file has to say so.
SLACK = 40

# A verb in the third person, alone or behind "Also", "Then" and the like; or one that several
# functions share ("Return the same, ...").
VERB = re.compile(r"(?:(?:Also|Then|Only) )?"
                  r"(?!(?:This|Those|These|Its|Always|Less|Thus|Plus|Minus|Values|Points|Cells|"
                  r"Rays|Bounds)\b)[A-Za-z]+[a-z]s\b(?! of\b)|Tells of\b"
                  r"|(?:Return|Call|Throw|Set|Get|Add|Make|Compute|Read|Write|Convert|Load|Store|"
                  r"Take|Find|Are|Is|Has|Have|Do|Give|Let|Tell|Visit|Append|Open|Check|Test)\b")
FUNCTION = re.compile(r"^[^=;{}#]*?\b(operator\S+|~?[a-zA-Z_]\w*)\((?!\*)")
NO_FUNCTION = re.compile(r"^(class|struct|enum|union|using|typedef|namespace|concept|template)\b"
                         r"|^friend class\b|^extern\b.*\{$|^(#|//|\}|$)")
# What may stand in front of a declaration.
SPECIFIER = re.compile(r"^(\[\[[^\]]*\]\]|PELLUCID_\w+(\([^)]*\))?(?=\s+\w)|static|inline|"
                       r"constexpr|explicit|virtual|friend(?! class)|requires\s+\S+)\s+")


def declaration(lines, at):
    """The declaration that begins in lines[at], without attributes and the head of a template."""
    text = " ".join(line.strip() for line in lines[at:at + 8])
    while True:
        shorter = SPECIFIER.sub("", text)
        if shorter.startswith("template"):
            depth, end = 0, 0
            for end, letter in enumerate(shorter):
                depth += (letter == "<") - (letter == ">")
                if letter == ">" and depth == 0:
                    break
            shorter = shorter[end + 1:].lstrip()
        if shorter == text:
            return text
        text = shorter


def is_function(text):
    return not NO_FUNCTION.search(text) and FUNCTION.search(text) is not None


def found_in(text):
    """Yields (kind, line, the comment's first line)."""
    lines = text.split("\n")
    inside = False
    first = ""
    for number, line in enumerate(lines):
        stripped = line.strip()
        note = re.search(r"///<\s*(.*)", line)
        if note and CLAUSE.match(note.group(1)):
            yield "notes", number + 1, note.group(1)
        if stripped.startswith("///") and not stripped.startswith("///<"):
            if not inside:
                first, begin = stripped[3:].strip(), number + 1
            inside = True
            continue
        if inside:
            inside = False
            if first in ("@{", "@}"):  # marks of a group, in the manner of VTK
                continue
            if CLAUSE.match(first):
                yield "clauses", begin, first
            elif not VERB.match(first) and is_function(declaration(lines, number)):
                yield "functions", begin, first


def found(root):
    """All that is counted: (kind, file, line, the comment's first line)."""
    for name in repository_files(root):
        if name.parts[0] in FOLDERS and SOURCE.search(str(name)):
            for kind, line, first in found_in((root / name).read_text(encoding="utf-8")):
                yield kind, name, line, first


def counted(openers):
    """The number of openers of each kind."""
    kinds = [kind for kind, *_ in openers]
    return {kind: kinds.count(kind) for kind in KINDS}


def check(root, allowed=None):
    """Yields what is wrong with the numbers of comments."""
    numbers = counted(found(root))
    if allowed is None:
        allowed = json.loads((root / NUMBERS).read_text())
    for kind in KINDS:
        if numbers[kind] > allowed[kind]:
            yield (f"{numbers[kind]} {kind} begin with no verb and no noun, and {NUMBERS} allows "
                   f"{allowed[kind]}: say in new comments what the thing is or does "
                   "(--list shows all)")
        elif numbers[kind] < allowed[kind] - SLACK:
            yield (f"{numbers[kind]} {kind} are left, and {NUMBERS} allows {allowed[kind]}: "
                   "lower it with --lower")


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    openers = sorted(found(root), key=lambda one: KINDS.index(one[0]))
    numbers = counted(openers)
    if sys.argv[2:] == ["--list"]:
        print("\n".join(f"{kind}: {name}:{line}: {first}" for kind, name, line, first in openers))
        return 0
    if sys.argv[2:] == ["--lower"]:
        allowed = json.loads((root / NUMBERS).read_text())
        lower = {kind: min(numbers[kind], allowed[kind]) for kind in KINDS}
        (root / NUMBERS).write_text(json.dumps(lower, indent=2) + "\n")
        return 0
    return run_check(check(root), "no new comment begins with a clause; left are "
                     + ", ".join(f"{numbers[kind]} {kind}" for kind in KINDS))


if __name__ == "__main__":
    sys.exit(main())

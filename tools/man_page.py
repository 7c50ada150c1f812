#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the manual page of the program from what its --help prints.

  man_page.py PROGRAM PAGE

Ends with an error if a help text lacks a part that the page needs: the list of commands, the exit
codes, the examples. Standard library only.
"""
import datetime
import os
import pathlib
import re
import subprocess
import sys
import textwrap

ENVIRONMENT = [
    ("PELLUCID_MODULES",
     "Folder in which the program looks for its modules first. A module reads the files of one "
     "library: VTK, ITK, HDF5, NetCDF or OpenVDB."),
]
FILES = [
    ("../lib/pellucid/", "The modules, as seen from the folder of the program."),
    ("../share/doc/pellucid/examples/", "Scenes that render as they are."),
]
SEE_ALSO = "README.md in the folder of the examples says what each of them shows."


class HelpError(Exception):
    pass


def help_of(program, *command):
    result = subprocess.run([program, *command, "--help"], stdout=subprocess.PIPE, check=True,
                            stdin=subprocess.DEVNULL, timeout=60)
    return result.stdout.decode().rstrip()


# ----- reading a help text ----------------------------------------------------------------------

def blocks_of(text):
    """The paragraphs of a help text, as lists of lines."""
    return [block.splitlines() for block in re.split(r"\n\s*\n", text.strip("\n"))]


def is_indented(line):
    return line.startswith("  ")


def items_of(lines):
    """The (name, text) pairs of a list like that of options, or None if it is not one."""
    items = []
    for line in lines:
        item = re.match(r"  (\S.*?)(?: {2,}(\S.*))?$", line)
        more = re.match(r" {8,}(\S.*)$", line)
        if more and items:
            items[-1][1].append(more.group(1))
        elif item:
            items.append((item.group(1), [item.group(2)] if item.group(2) else []))
        else:
            return None
    if not items or not all(text for _, text in items):
        return None
    return [(name, " ".join(text)) for name, text in items]


def named_block(blocks, title):
    for block in blocks:
        if block[0] == title:
            return block[1:]
    raise HelpError(f"no paragraph '{title}' in the help text")


# ----- writing roff -----------------------------------------------------------------------------

def escape(text):
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq")
    text = text.replace("`", "\\(ga").replace("^", "\\(ha").replace("~", "\\(ti")
    return "".join(c if ord(c) < 128 else f"\\[u{ord(c):04X}]" for c in text)


def safe(line):
    """A dot at the start of a line would be a request."""
    return "\\&" + line if line.startswith(".") else line


def filled(text):
    return [safe(line) for line in
            textwrap.wrap(escape(text), 76, break_long_words=False, break_on_hyphens=False)]


def literal(lines):
    margin = min(len(line) - len(line.lstrip()) for line in lines)
    return [".RS 4", ".nf", *(safe(escape(line[margin:])) for line in lines), ".fi", ".RE"]


def item_list(items):
    page = []
    for name, text in items:
        page += [".TP", f".B {safe(escape(name.replace(',-', ', -')))}", *filled(text)]
    return page


def paragraph(block):
    """A paragraph of help that is neither a list nor examples."""
    head = [line for line in block if not is_indented(line)]
    tail = [line for line in block if is_indented(line)]
    if head + tail != block:
        return [".PP", *literal(block)]
    page = [".PP"] if head else []
    if tail and len(head) == 1 and not head[0].endswith(":"):
        page += [f".B {safe(escape(head[0]))}"]
    elif head:
        page += filled(" ".join(head))
    return page + (literal(tail) if tail else [])


# ----- the page ---------------------------------------------------------------------------------

def command_section(command, text, shown_lists):
    blocks = blocks_of(text)
    if len(blocks[0]) != 2 or not blocks[0][1].startswith("Usage: "):
        raise HelpError(f"{command}: the help text does not begin with a line and the usage")
    summary, usage = blocks[0][0], blocks[0][1].removeprefix("Usage: ")
    named_block(blocks, "Examples:")
    page = [f".SS pellucid {escape(command)}", *filled(summary.rstrip(".") + "."),
            ".PP", f".B {escape(usage)}"]
    for block in blocks[1:]:
        title = block[0].rstrip(":")
        items = items_of(block[1:]) if block[0].endswith(":") and len(block) > 1 else None
        if title == "Examples":
            page += [".PP", "Examples:", *literal(block[1:])]
        elif items:
            items = [item for item in items if item[0] != "-h,--help"]
            key = (title, tuple(items))
            if not items:
                continue
            if title.startswith("Options of") and key in shown_lists:
                page += [".PP", f"{escape(title)}: as those of",
                         f".BR \"pellucid {escape(shown_lists[key])}\" ."]
                continue
            shown_lists.setdefault(key, command)
            if title not in ("Positionals", "Options"):
                page += [".PP", f"{escape(title)}:"]
            page += item_list(items)
        else:
            page += paragraph(block)
    return page


def exit_status(blocks):
    for block in blocks:
        text = " ".join(line.strip() for line in block)
        match = re.search(r"Exit (?:codes?|status(?:es)?): (.*?)\. (.*)$", text + " ")
        if match:
            codes = re.findall(r"(\d+) (.*?)(?=, \d+ |$)", match.group(1))
            if codes and codes[0][0] == "0":
                return codes, match.group(2).strip()
    raise HelpError("the help text does not list the exit codes")


def day():
    """The day of the commit, so that the same sources give the same page."""
    seconds = os.environ.get("SOURCE_DATE_EPOCH")
    if not seconds:
        git = subprocess.run(["git", "log", "-1", "--format=%ct"], stdout=subprocess.PIPE,
                             stderr=subprocess.DEVNULL, check=False, text=True,
                             cwd=pathlib.Path(__file__).resolve().parent) if has_git() else None
        seconds = git.stdout.strip() if git else ""
    if not seconds:
        return datetime.date.today().isoformat()
    return datetime.datetime.fromtimestamp(int(seconds), datetime.timezone.utc).date().isoformat()


def has_git():
    return any(os.access(os.path.join(folder, "git"), os.X_OK)
               for folder in os.environ.get("PATH", "").split(os.pathsep))


def man_page(program):
    version = subprocess.run([program, "--version"], stdout=subprocess.PIPE, check=True,
                             text=True).stdout.split("\n")[0]
    top = blocks_of(help_of(program))
    summary = top[0][0].rstrip(".")
    commands = items_of(named_block(top, "Subcommands:"))
    if not commands:
        raise HelpError("the help text lists no commands")
    codes, failure = exit_status(top)

    page = [".\\\" Made by tools/man_page.py from 'pellucid --help'.",
            f".TH PELLUCID 1 {day()} \"{escape(version)}\" \"User Commands\"",
            ".nh", ".SH NAME", "pellucid \\-", *filled(summary[0].lower() + summary[1:]),
            ".SH SYNOPSIS", ".B pellucid", ".I COMMAND", ".RI [ OPTIONS ]", ".RI [ INPUT ]",
            ".br", ".B pellucid", ".I COMMAND", ".B \\-\\-help",
            ".br", ".B pellucid \\-\\-version",
            ".SH DESCRIPTION",
            *filled(summary + ". A volume or mesh file goes in, or a scene that names them; an "
                    "image comes out, in which each pixel is within the tolerance of the exact "
                    "integral. The commands are:"),
            *item_list(commands), ".SH COMMANDS"]
    shown_lists = {}
    for command, _ in commands:
        page += command_section(command, help_of(program, command), shown_lists)
    page += [".SH EXIT STATUS", *item_list([(code, text[0].upper() + text[1:] + ".")
                                            for code, text in codes]), ".PP", *filled(failure),
             ".SH ENVIRONMENT", *item_list(ENVIRONMENT),
             ".SH FILES", *item_list(FILES),
             ".SH EXAMPLES", *literal(named_block(top, "Examples:")),
             ".SH SEE ALSO", *filled(SEE_ALSO)]
    # A paragraph right after a heading is no new one.
    lines = []
    for line in page:
        if line == ".PP" and lines and re.match(r"\.S[HS] ", lines[-1]):
            continue
        lines.append(line)
    return "\n".join(lines) + "\n"


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        text = man_page(os.path.abspath(arguments[0]))
    except HelpError as error:
        print(f"man_page.py: {error}", file=sys.stderr)
        return 1
    page = pathlib.Path(arguments[1])
    page.parent.mkdir(parents=True, exist_ok=True)
    new = page.with_name(page.name + ".new")
    new.write_text(text, encoding="ascii")
    new.replace(page)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

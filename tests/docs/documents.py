# SPDX-License-Identifier: Apache-2.0
"""The repository's files and the parts of its Markdown pages, for the checks beside this file."""
import dataclasses
import os
import pathlib
import re
import subprocess

FENCE = re.compile(r"^( {0,3})(`{3,}|~{3,})([^`]*)$")
MARK = re.compile(r"^<!--\s*(.*?)\s*-->$")
NOT_TRACKED = {".git", "build", "out", "__pycache__"}


def repository_files(root):
    """Paths relative to root of all files that git tracks or would track; without git, all files
    outside of build folders."""
    command = ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others",
               "--exclude-standard"]
    try:
        listed = subprocess.run(command, capture_output=True, check=True).stdout.decode()
        names = [name for name in listed.split("\0") if name]
    except (OSError, subprocess.CalledProcessError):
        names = []
    if not names:
        for folder, inside, files in os.walk(root):
            inside[:] = [name for name in inside if name not in NOT_TRACKED]
            names += [os.path.relpath(os.path.join(folder, name), root) for name in files]
    return sorted({pathlib.PurePosixPath(name) for name in names if (root / name).is_file()})


@dataclasses.dataclass
class Block:
    """A fenced block of code."""
    language: str  # the first word behind the fence
    words: list    # the others
    mark: str      # the HTML comment on the line before the fence, else ""
    text: str
    line: int      # of its first line of code, from 1


class Page:
    """A page of Markdown: its blocks, its links and the anchors that others may link to."""

    def __init__(self, text):
        self.blocks = []
        prose = []
        fence = None
        lines = text.split("\n")
        for number, line in enumerate(lines, 1):
            match = FENCE.match(line)
            if fence is None and match:
                words = match.group(3).split()
                before = MARK.match(lines[number - 2].strip()) if number > 1 else None
                fence = match.group(2)
                block = Block(words[0] if words else "", words[1:],
                              before.group(1) if before else "", "", number + 1)
                prose.append("")
            elif fence is not None and match and not match.group(3).strip() \
                    and match.group(2).startswith(fence):
                self.blocks.append(block)
                fence = None
                prose.append("")
            elif fence is not None:
                block.text += line + "\n"
                prose.append("")
            else:
                prose.append(line)
        self.open_fence = block.line - 1 if fence is not None else None
        self.prose = "\n".join(prose)

    def anchors(self):
        """The anchors that GitHub gives to the headings, and those that the page sets itself."""
        found = {}
        result = set()
        headings = []
        lines = re.sub(r"<!--.*?-->", lambda match: "\n" * match.group().count("\n"), self.prose,
                       flags=re.S).split("\n")
        for line, below in zip(lines, lines[1:] + [""]):
            match = re.match(r" {0,3}#{1,6}\s+(.*?)\s*#*\s*$", line)
            if match:
                headings.append(match.group(1))
            elif line.strip() and not line.startswith(("|", "-", "=")) \
                    and re.match(r" {0,3}(=+|-+)\s*$", below):
                headings.append(line.strip())
        for heading in headings:
            slug = slug_of(heading)
            count = found.get(slug, 0)
            found[slug] = count + 1
            result.add(slug if count == 0 else f"{slug}-{count}")
        result.update(re.findall(r"<[^>]*\b(?:id|name)=\"([^\"]+)\"", self.prose))
        return result

    def links(self):
        """Yields (line, target) of every link and image, and of every use of a link's name that is
        not defined on this page, as (line, None)."""
        text = re.sub(r"(`+)(?!`).*?(?<!`)\1(?!`)", lambda match: "x" * len(match.group()),
                      self.prose, flags=re.S)
        text = re.sub(r"<!--.*?-->", lambda match: re.sub(r"[^\n]", " ", match.group()), text,
                      flags=re.S)

        def line(position):
            return text.count("\n", 0, position) + 1

        for match in re.finditer(r"\]\(\s*<?([^)\s>]*)>?(?:\s+[\"'(][^)]*)?\s*\)", text):
            yield line(match.start()), match.group(1)
        for match in re.finditer(r"<(?:a|img)\b[^>]*?\b(?:href|src)=\"([^\"]*)\"", text, re.S):
            yield line(match.start()), match.group(1)
        names = set()
        for match in re.finditer(r"^ {0,3}\[([^\]]+)\]:\s*<?(\S+?)>?\s*$", text, re.M):
            names.add(re.sub(r"\s+", " ", match.group(1)).lower())
            yield line(match.start()), match.group(2)
        for match in re.finditer(r"\[([^\]\[]+)\]\[([^\]\[]*)\]", text):
            name = re.sub(r"\s+", " ", match.group(2) or match.group(1)).lower()
            if name not in names:
                yield line(match.start()), None


def slug_of(heading):
    """The anchor that GitHub makes of a heading."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    text = re.sub(r"<[^>]+>", "", text).replace("`", "")
    text = re.sub(r"(?<!\w)[*_]+|[*_]+(?!\w)", "", text).strip().lower()
    return re.sub(r"\s", "-", re.sub(r"[^\w\- ]", "", text))


def run_check(check, good):
    """Prints what check yields, or that all is good; the exit status."""
    violations = list(check)
    print("\n".join(violations) if violations else good)
    return 1 if violations else 0

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Goes through a folder of data and prints for each file what the program makes of it: read (with
dimensions, spacing, type and range) or refused and why. Where the folder has a MANIFEST.md with
tables of "file | what | dims | spacing | dtype | range", what it says of a file stands beside, and
rows that differ are marked. Ends with 1 if a file is refused that is not one of REFUSED, crashed
the program, hung it, took more memory than twice its data (and 300 MiB for the program and its
libraries), or differs.

  survey.py PROGRAM FOLDER [MARKDOWN]
"""
import json
import pathlib
import re
import resource
import subprocess
import sys
import tarfile
import tempfile

SECONDS = 120
PROGRAM_BYTES = 300 << 20
# Read with another file, or no data at all.
PARTS = re.compile(r"\.(raw|zraw|img\.gz|img|py|md|csv|txt|plist)$|SHA256SUMS$|/quarter\.\d+$"
                   r"|q\.bin$")
# What is no volume, or is refused by name: images of one and two axes and a single value, adaptive
# grids, level sets.
REFUSED = re.compile(r"/test[12]d_\w+\.nrrd$|/test_simple4d_raw\.nrrd$|/chombo3d\.vtm$"
                     r"|\.(vthb|htg|amr)$|/sphere\.vdb$")
# What headerless files need to be told, as MANIFEST.md does.
TOLD = {
    "structured/aneurism/aneurism.raw.gz": ["--dimensions", "256,256,256", "--type", "u8"],
    "structured/vismale/male.raw": ["--dimensions", "128,256,256", "--type", "u8"],
    "structured/cranium_ct/matrix.dat": ["--dimensions", "256,256,108", "--type", "i16",
                                         "--spacing", "0.957031,0.957031,1.5"],
    "multivariate/plot3d/bluntfinxyz.bin": ["--q", "multivariate/plot3d/bluntfinq.bin"],
    "multivariate/plot3d/combxyz.bin": ["--q", "multivariate/plot3d/combq.bin"],
}


def expectations(folder):
    """For the beginnings of paths, the columns of their rows."""
    rows = []
    manifest = folder / "MANIFEST.md"
    if not manifest.exists():
        return rows
    for line in manifest.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) >= 6 and "/" in cells[0]:
            rows.append(cells[:6])
    return rows


def row_of(rows, name, known=None):
    """The row whose file it is: by its name, with {a,b} and * of the first column taken for a
    pattern. Adds it to the known ones."""
    for number, row in enumerate(rows):
        for pattern in re.split(r"\s*,\s+(?=\w+/)|\s+;\s+", row[0]):
            pattern = pattern.split(" ")[0]
            folder = pattern.rsplit("/", 1)[0]
            expression = re.escape(pattern).replace(r"\*", ".*")
            expression = re.sub(r"\\\{([^}]*)\\\}",
                                lambda m: "(" + m.group(1).replace(",", "|") + ")", expression)
            if re.fullmatch(expression, name) or (pattern.endswith("/")
                                                  and name.startswith(folder + "/")):
                if known is not None:
                    known.add(number)
                return row
    return None


def numbers(text):
    return [float(n) for n in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", text)]


def differences(report, row):
    """What the row says otherwise, for those of its columns that are plain numbers."""
    found = []
    dims = report.get("dimensions")
    wanted = re.match(r"^(\d+)(?:x(\d+)x(\d+)|\^3)(?=$| \(| x\d| permuted)", row[2])
    if dims and wanted:
        one = int(wanted.group(1))
        sides = [one, one, one] if wanted.group(2) is None else [one, int(wanted.group(2)),
                                                                 int(wanted.group(3))]
        if "permuted" in row[2]:
            dims, sides = sorted(dims), sorted(sides)
        if dims != sides:
            found.append(f"dimensions {sides}")
    spacing = report.get("spacing")
    if spacing and re.fullmatch(r"[\d.]+(,[\d.]+){2}", row[3]):
        theirs = numbers(row[3])
        if "permuted" in row[2]:
            spacing, theirs = sorted(spacing), sorted(theirs)
        if any(abs(a - b) > 2e-5 * b for a, b in zip(spacing, theirs)):
            found.append(f"spacing {row[3]}")
    limits = re.fullmatch(r"(-?[\d.e-]+?)\.\.(-?[\d.e-]+)", row[5])
    # What a row says of a folder is the range of all of it.
    if limits and report.get("range") and not row[0].endswith("/"):
        for ours, theirs in zip(report["range"], limits.groups()):
            digits = len(theirs.split(".")[1]) if "." in theirs and "e" not in theirs else 0
            if abs(ours - float(theirs)) > 0.51 * 10.0**-digits:
                found.append(f"range {row[5]}")
                break
    return found


def run(program, folder, path, told):
    """(report or None, message, peak bytes)"""
    def limit():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with tempfile.NamedTemporaryFile("w+") as peak:
        command = ["/usr/bin/time", "-q", "-f", "%M",
                   "-o", peak.name] if pathlib.Path("/usr/bin/time").exists() else []
        try:
            result = subprocess.run(command + [program, "info", path, "--json", *told], cwd=folder,
                                    text=True,
                                    capture_output=True, timeout=SECONDS, preexec_fn=limit)
        except subprocess.TimeoutExpired:
            return None, f"HANGS: longer than {SECONDS} s", 0
        lines = peak.read().split()
        memory = int(lines[-1]) * 1024 if lines and lines[-1].isdigit() else 0
    if result.returncode == 0:
        return json.loads(result.stdout), "", memory
    lines = result.stderr.strip().splitlines()
    message = lines[-1] if lines else ""
    if result.returncode < 0 or result.returncode > 100 or not message.startswith("pellucid:"):
        return None, f"CRASHES: status {result.returncode} {message}", memory
    return None, message.removeprefix("pellucid: ").removeprefix("error: "), memory


def short(value):
    return "×".join(str(v) for v in value) if isinstance(value, list) else str(value)


def describe(report):
    if "dimensions" in report and report["dimensions"]:
        size = short(report["dimensions"])
        spacing = report.get("spacing") or []
        step = ", ".join(f"{s:.6g}" for s in spacing) if spacing else "not even"
    else:
        cells = report.get("cells", {})
        size = ", ".join(f"{count} {shape}" for shape, count in cells.items())
        step = f"{report.get('points', 0)} points"
    limits = report.get("range")
    return size, step, report.get("type") or "", "{:.6g} … {:.6g}".format(*limits) if limits else ""


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    rows = expectations(folder)
    known = set()
    paths = sorted(str(p.relative_to(folder)) for p in folder.rglob("*")
                   if p.is_file() and not p.name.startswith("._"))
    for path in paths:
        row_of(rows, path, known)
        row_of(rows, str(pathlib.Path(path).parent), known)
    unmatched = [row[0] for number, row in enumerate(rows) if number not in known]
    paths = [p for p in paths if p in TOLD or not PARTS.search("/" + p)]
    # Slices of one series or stack are one item.
    items, seen = [], set()
    for path in paths:
        parent = str(pathlib.Path(path).parent)
        if re.search(r"\.(dcm|tif)$", path):
            if parent in seen:
                continue
            seen.add(parent)
            items.append(parent)
        else:
            items.append(path)
    lines = ["| file | read as | spacing | type | range | the manifest says otherwise |",
             "|---|---|---|---|---|---|"]
    refused, bad = [], []
    with tempfile.TemporaryDirectory() as scratch:
        for item in items:
            told, where, read_from = TOLD.get(item, []), item, folder
            if item.endswith(".tar.xz"):
                with tarfile.open(folder / item) as archive:
                    archive.extractall(scratch, filter="data")
                first = next(p for p in sorted(pathlib.Path(scratch).rglob("*")) if p.is_file())
                where, read_from = str(first.parent.relative_to(scratch)), pathlib.Path(scratch)
            report, message, memory = run(program, read_from, where, told)
            if report is None:
                refused.append(f"| {item} | {message.replace('|', '/')} |")
                if re.match("CRASHES|HANGS", message) or not REFUSED.search("/" + item):
                    bad.append(f"{item}: {message}")
                continue
            row = row_of(rows, item)
            wrong = differences(report, row) if row else []
            data = report.get("bytes") or 0
            if data and memory > 2 * data + PROGRAM_BYTES:
                wrong.append(f"takes {memory >> 20} MiB for {data >> 20} MiB")
            if wrong:
                bad.append(f"{item}: {'; '.join(wrong)}")
            lines.append("| " + " | ".join((item, *describe(report), "; ".join(wrong))) + " |")
    text = "\n".join([f"{len(lines) - 2} read, {len(refused)} refused, {len(bad)} wrong.", "",
                      *lines, "", "| refused | why |", "|---|---|", *refused, ""])
    if len(sys.argv) > 3:
        pathlib.Path(sys.argv[3]).write_text(text)
    print(text)
    for row in unmatched:
        print("NO FILE of the manifest's row:", row, file=sys.stderr)
    for line in bad:
        print("WRONG:", line, file=sys.stderr)
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()

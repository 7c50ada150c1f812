#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks what is in a wheel, by readelf and objdump, and prints what it holds.

  check_wheel.py WHEEL [--absent TEXT]... [--plain]

Nothing but libc and GCC's runtime is needed from outside, in versions that the wheel's tag allows;
objects look for each other by $ORIGIN, inside of the wheel; bundled libraries have names of their
own, are all used, and have licences that are not the GPL's; kernels of all instruction sets are
there; RECORD is right; no file holds one of the texts TEXT, such as the folder of the build.
--plain is for the test of this check: a wheel of other code, without kernels.
"""
import argparse
import base64
import hashlib
import os
import pathlib
import platform
import re
import subprocess
import sys
import tempfile
import zipfile

OUTSIDE = re.compile(r"lib(c|m|pthread|dl|rt|stdc\+\+|gcc_s)\.so\.\d+|ld-linux-[\w-]+\.so\.\d")
# The newest symbols of GCC's runtime beside a glibc 2.N, oldest first.
RUNTIMES = {28: 24, 31: 28, 34: 29, 35: 30, 39: 33}
# What only the kernels of one set have, as objdump writes it.
KERNELS = {"sse4": r"\t(p?blendv(b|p[sd])|round[ps][sd]) ", "avx2": r"\tvblendvp[sd] .*ymm",
           "avx512": r"zmm"}
# Packages whose library has another licence than the rest of them, by its file.
OF_LIBRARY = {"libuuid1": "libuuid/*", "liblz4-1": "lib/*"}


def output_of(*command):
    return subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, text=True,
                          check=True, env={**os.environ, "LC_ALL": "C"}).stdout


class Check:
    def __init__(self, wheel, folder):
        self.wheel, self.folder, self.problems = wheel, folder, []
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(folder)
            self.names = archive.namelist()
        self.objects = sorted(path for path in folder.rglob("*")
                              if path.is_file() and path.read_bytes()[:4] == b"\x7fELF")
        self.info = next(folder.glob("*.dist-info"))

    def expect(self, condition, message):
        if not condition:
            self.problems.append(message)

    def name_of(self, path):
        return str(path.relative_to(self.folder))

    # ----- the archive --------------------------------------------------------------------------

    def tags(self):
        python, abi, system = self.wheel.stem.split("-")[2:]
        said = re.findall(r"(?m)^Tag: (.*)$", (self.info / "WHEEL").read_text())
        self.expect(said == [f"{python}-{abi}-{system}"], f"WHEEL says the tags {said}")
        modules = [self.name_of(path) for path in self.objects if ".cpython-" in path.name]
        number = abi[2:]
        self.expect(modules and all(f".cpython-{number}-" in name for name in modules),
                    f"the tag {abi} is not that of {modules}")
        found = re.fullmatch(r"manylinux_2_(\d+)_(\w+)", system)
        self.expect(found and found.group(2) == platform.machine(),
                    f"{system} is no tag of a system that others have")
        self.glibc = int(found.group(1)) if found else 0

    def record(self):
        rows = {}
        for line in (self.info / "RECORD").read_text().splitlines():
            name, digest, size = line.rsplit(",", 2)
            rows[name] = (digest, size)
        own = self.name_of(self.info / "RECORD")
        self.expect(sorted(rows) == sorted(self.names), "RECORD does not list the files: " +
                    ", ".join(sorted(set(rows) ^ set(self.names))))
        self.expect(len(set(self.names)) == len(self.names), "a file is in the archive twice")
        for name, (digest, size) in rows.items():
            path = self.folder / name
            if name == own or not path.exists():
                continue
            data = path.read_bytes()
            sum_ = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            self.expect((digest, size) == (f"sha256={sum_}", str(len(data))),
                        f"RECORD has another sum of {name}")

    def absent(self, texts):
        for path in self.folder.rglob("*"):
            data = path.read_bytes() if path.is_file() else b""
            for text in texts:
                self.expect(text.encode() not in data, f"{self.name_of(path)} holds \"{text}\"")

    # ----- its objects --------------------------------------------------------------------------

    def links(self):
        used = set()
        bundled = {path for path in self.objects if path.parent.name.endswith(".libs")}
        for path in self.objects:
            said = output_of("readelf", "-d", "-W", path)
            name = self.name_of(path)
            folders = [folder for both in re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.*)\]", said)
                       for folder in both.split(":")]
            places = []
            for folder in folders:
                place = pathlib.Path(os.path.normpath(
                    folder.replace("$ORIGIN", str(path.parent))))
                self.expect(folder.startswith("$ORIGIN") and
                            (place == self.folder or self.folder in place.parents),
                            f"{name} looks for libraries in {folder}")
                places.append(place)
            for needed in re.findall(r"\(NEEDED\).*\[(.*)\]", said):
                if OUTSIDE.fullmatch(needed):
                    continue
                found = [place / needed for place in places if (place / needed).exists()]
                self.expect(found, f"{name} needs {needed}, which is not in the wheel")
                used.update(found[:1])
            if path in bundled:
                self.expect(re.findall(r"\(SONAME\).*\[(.*)\]", said) == [path.name],
                            f"{name} has another name inside")
                self.expect(re.search(r"-[0-9a-f]{8}\.so", path.name),
                            f"{name} has no name of its own")
        for path in bundled - used:
            self.expect(False, f"{self.name_of(path)} is linked by nothing")

    def versions(self):
        """The newest versions of symbols asked of what lies outside."""
        newest = {}
        runtime = max((number for glibc, number in RUNTIMES.items() if glibc <= self.glibc),
                      default=0)
        for path in self.objects:
            owner = ""
            for line in output_of("readelf", "-V", "-W", path).splitlines():
                file = re.search(r"File: (\S+)", line)
                owner = file.group(1) if file else owner
                asked = re.search(r"Name: (GLIBC|GLIBCXX|CXXABI|GCC)_([\d.]+)\b", line)
                if not asked or not OUTSIDE.fullmatch(owner):
                    continue
                what, number = asked.group(1), tuple(map(int, asked.group(2).split(".")))
                if number > newest.get(what, ((0,), ""))[0]:
                    newest[what] = (number, self.name_of(path))
                limit = {"GLIBC": (2, self.glibc), "GLIBCXX": (3, 4, runtime)}.get(what)
                self.expect(not limit or number <= limit,
                            f"{self.name_of(path)} asks for {what}_{asked.group(2)}, which a "
                            f"system with glibc 2.{self.glibc} may lack")
        return newest

    def kernels(self):
        package = [path for path in self.objects if "_pellucid." in path.name]
        self.expect(len(package) == 1, "the module _pellucid is not there once")
        if platform.machine() != "x86_64" or len(package) != 1:
            return
        code = output_of("objdump", "-d", "--no-show-raw-insn", package[0])
        for name, pattern in KERNELS.items():
            self.expect(re.search(pattern, code), f"there are no kernels for {name}")

    # ----- licences -----------------------------------------------------------------------------

    def licences(self):
        folder = self.info / "licenses"
        self.expect((folder / "LICENSE").exists(), "the licence is not in the wheel")
        said = (folder / "README.txt").read_text(encoding="utf-8")
        rows = {name: (of, text) for name, of, text in
                re.findall(r"(?m)^(\S+\.so\S*)\n  (.+)\n  .+: (\S+)$", said)}
        bundled = {path.name for path in self.objects if path.parent.name.endswith(".libs")}
        self.expect(set(rows) == bundled, "the list of licences is not that of the libraries: " +
                    ", ".join(sorted(set(rows) ^ bundled)))
        for name, (of, text) in rows.items():
            path = folder / text
            self.expect(path.exists() and path.stat().st_size > 200,
                        f"the licence of {name} is not in the wheel")
            if not path.exists() or not of.startswith("Debian's "):
                continue
            package = of.split()[1]
            stanzas = path.read_text(encoding="utf-8").split("\n\n")
            found = None
            for files in (OF_LIBRARY.get(package, "*"), "*"):
                of_files = rf"(?m)^Files:.*(?<!\S){re.escape(files)}(?!\S)"
                stanza = next((part for part in stanzas if re.search(of_files, part)), "")
                found = found or re.search(r"(?m)^License: *(.*)$", stanza)
            # Without stanzas a text is for people to read (tools/wheel/bundle.py, LICENCES).
            self.expect(not found or not re.match(r"[AL]?GPL", found.group(1)),
                        f"{name} is under {found and found.group(1)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("wheel", type=pathlib.Path)
    parser.add_argument("--absent", action="append", default=[])
    parser.add_argument("--plain", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="pellucid_check_wheel_") as name:
        check = Check(arguments.wheel, pathlib.Path(os.path.realpath(name)))
        check.tags()
        check.record()
        check.absent(arguments.absent)
        check.links()
        newest = check.versions()
        check.licences()
        if not arguments.plain:
            check.kernels()
        size = sum(path.stat().st_size for path in check.folder.rglob("*") if path.is_file())
        print(f"{arguments.wheel.name}: {arguments.wheel.stat().st_size / 1e6:.1f} MB, "
              f"{size / 1e6:.1f} MB unpacked, {len(check.objects)} objects")
        for what, (number, where) in sorted(newest.items()):
            print(f"  asks for {what}_{'.'.join(map(str, number))} ({where})")
        for path in check.objects:
            print(f"  {path.stat().st_size:>9} {check.name_of(path)}")
    for problem in check.problems:
        print(f"FAILED: {problem}")
    sys.exit(bool(check.problems))


if __name__ == "__main__":
    main()

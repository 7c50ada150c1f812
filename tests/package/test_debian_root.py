# SPDX-License-Identifier: Apache-2.0
"""Installs the package into an empty Debian and renders there.

The package is the one that test_contents.py left in PELLUCID_PACKAGE_FOLDER. The Debian is made by
debootstrap from the mirror that this machine uses, once: it is kept there as an archive, and so are
the packages that were fetched. Each command runs in mount and process namespaces of its own, so
that nothing stays mounted or runs on, whatever happens.

Skipped (exit status 77) without root, debootstrap, namespaces or a mirror.
"""
import fcntl
import gzip
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import zlib

FOLDER = os.environ["PELLUCID_PACKAGE_FOLDER"]
VERSION = os.environ["PELLUCID_VERSION"]
sys.path.insert(0, os.path.join(os.environ["PELLUCID_SOURCE_DIR"], "tools"))
from debian_root import (Root, Skip, check_machine, expect, install_debian, remove, set_up_apt,
                         source_of_host, stop)


def unpack_root(suite, mirror):
    """A new folder with a Debian that was just installed."""
    archive = os.path.join(FOLDER, f"debian_{suite}.tar")
    root = tempfile.mkdtemp(prefix="root_", dir=FOLDER)
    os.chmod(root, 0o755)
    if os.path.exists(archive):
        subprocess.run(["tar", "--numeric-owner", "-xpf", archive, "-C", root], check=True)
        return root
    install_debian(root, suite, mirror)
    subprocess.run(["tar", "--numeric-owner", "-cf", archive + ".new", "-C", root, "."], check=True)
    os.replace(archive + ".new", archive)
    return root


def small_npy():
    header = b"{'descr': '<f4', 'fortran_order': False, 'shape': (5, 6, 7), }"
    header += b" " * (64 - (len(header) + 11) % 64) + b"\n"
    values = [i % 11 / 10 for i in range(5 * 6 * 7)]
    return (b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header +
            struct.pack(f"<{len(values)}f", *values))


def small_nifti():
    values = [i % 13 for i in range(6 * 5 * 4)]
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, 6, 5, 4, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 4, 16)  # int16
    struct.pack_into("<8f", header, 76, 1, 1.5, 1, 1, 0, 0, 0, 0)
    struct.pack_into("<f", header, 108, 352)
    header[344:348] = b"n+1\0"
    return bytes(header) + struct.pack(f"<{len(values)}h", *values)


def check_png(data, width, height):
    """Follows the chunks of a PNG, and unpacks its pixels."""
    expect(data[:8] == b"\x89PNG\r\n\x1a\n", "the picture does not begin as a PNG")
    at, packed, kinds = 8, b"", []
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + length]
        expect(zlib.crc32(kind + body) == struct.unpack_from(">I", data, at + 8 + length)[0],
               f"the checksum of {kind} is wrong")
        kinds.append(kind)
        if kind == b"IHDR":
            expect(struct.unpack_from(">II", body) == (width, height), "the picture's size")
        packed += body if kind == b"IDAT" else b""
        at += 12 + length
    expect(kinds[0] == b"IHDR" and kinds[-1] == b"IEND", "the picture is cut off")
    expect(len(set(zlib.decompress(packed))) > 8, "the picture is empty")


# ----- the test ---------------------------------------------------------------------------------

def check_program(root):
    expect(VERSION in root.run("pellucid", "--version"), "pellucid --version")
    root.write("/tmp/small.npy", small_npy())
    root.write("/tmp/small.nii", small_nifti())
    for source in ("builtin:shells:32", "/tmp/small.npy", "/tmp/small.nii",
                   "/usr/share/doc/pellucid/examples/shells.json"):
        root.run("pellucid", "render", source, "--size", "40x30", "-o", "/tmp/picture.png")
        with open(root.path("/tmp/picture.png"), "rb") as file:
            check_png(file.read(), 40, 30)
        os.remove(root.path("/tmp/picture.png"))


def check_missing_library(root):
    """Without the recommended packages: what needs a module says so in one line."""
    if os.environ["PELLUCID_HAS_VTK"] != "1":
        return
    root.run("pellucid", "convert", "builtin:shells:8", "-q", "-o", "/tmp/cells.vtu")
    said = root.run("pellucid", "info", "/tmp/cells.vtu", status=1)
    expect(re.fullmatch(r"pellucid: error: [^\n]*pellucid_vtk\.so[^\n]* libvtk[^\n]*: "
                        r"[^\n]*libvtk9-dev[^\n]*\n", said), f"not a clear line: {said}")


def check_files(root):
    with gzip.open(root.path("/usr/share/man/man1/pellucid.1.gz"), "rt") as page:
        expect(".SH NAME" in page.read(), "the manual page")
    found = [path for path in root.files() if path.endswith("cmake/pellucid/pellucidConfig.cmake")]
    expect(len(found) == 1, f"the CMake package: {found}")
    package = os.path.dirname(root.path(found[0]))
    prefix = os.path.normpath(os.path.join(package, *([".."] * (found[0].count("/") - 1))))
    expect(prefix == root.path("/usr"), f"the CMake package is at {found[0]}")
    with open(os.path.join(package, "pellucidTargets-release.cmake"), encoding="utf-8") as file:
        libraries = set(re.findall(r"\$\{_IMPORT_PREFIX\}/([^\"; ]+\.a)", file.read()))
    expect(len(libraries) >= 4, f"the libraries of the CMake package: {libraries}")
    for library in libraries:
        expect(os.path.exists(os.path.join(prefix, library)), f"{library} is not there")
    answer = root.run("bash", "-c", ". /usr/share/bash-completion/completions/pellucid; "
                      "COMP_WORDS=(pellucid ren) COMP_CWORD=1; _pellucid; echo ${COMPREPLY[@]}")
    expect(answer == "render\n", f"bash completion: {answer}")
    expect(root.run("dpkg", "--verify", "pellucid") == "", "dpkg --verify")


def check_removal(root):
    root.run("dpkg", "--purge", "pellucid")
    left = [path for path in root.files() if "pellucid" in path]
    expect(not left, f"left behind: {left[:10]}")


def test(root_folder, deb, sources):
    root = Root(root_folder)
    archives = os.path.join(FOLDER, "archives")
    os.makedirs(archives, exist_ok=True)
    of_apt = root.path("/var/cache/apt/archives")
    set_up_apt(root_folder, sources)
    for name in os.listdir(archives):
        shutil.copy(os.path.join(archives, name), of_apt)
    root.run("apt-get", "update", "-q")
    os.makedirs(root.path("/tmp/package"))
    shutil.copy(deb, root.path("/tmp/package/pellucid.deb"))
    said = root.run("apt-get", "install", "-q", "-y", "--no-install-recommends",
                    "-o", "Dpkg::Use-Pty=0", "/tmp/package/pellucid.deb")
    for line in re.findall(r"(?m)^.*(?:newly installed|disk space will be used).*$", said):
        print(line)
    for name in os.listdir(of_apt):
        if name.endswith(".deb"):
            shutil.copy(os.path.join(of_apt, name), archives)
    check_program(root)
    check_missing_library(root)
    check_files(root)
    check_removal(root)


def main():
    check_machine()
    debs = [name for name in os.listdir(FOLDER) if name.endswith(".deb")]
    if not debs:
        raise Skip("there is no package: package.contents makes it")
    expect(len(debs) == 1, f"one package is expected in {FOLDER}: {debs}")
    suite, sources, mirror = source_of_host()
    with open(os.path.join(FOLDER, "lock"), "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        for name in os.listdir(FOLDER):  # of a run that was killed
            if name.startswith("root_"):
                remove(os.path.join(FOLDER, name))
        root = None
        try:
            root = unpack_root(suite, mirror)
            test(root, os.path.join(FOLDER, debs[0]), sources)
        finally:
            if root:
                remove(root)
    print("installed, rendered and removed")


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, stop)
    try:
        main()
    except Skip as reason:
        print(f"skipped: {reason}")
        sys.exit(77)

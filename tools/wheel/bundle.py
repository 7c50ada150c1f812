# SPDX-License-Identifier: Apache-2.0
"""Puts the libraries that a package of Python links into its folder PACKAGE.libs.

Each gets a name of its own, with a part of its sum, as auditwheel gives it: a process can have
another copy of the same library, of another version. They find each other by $ORIGIN. What stays
outside is what every Linux with glibc and GCC's runtime has. platform_tag() says how old these may
be. Needed: ldd, objdump, patchelf, and Debian's package list, for the licences.
"""
import hashlib
import os
import pathlib
import platform
import re
import shutil
import subprocess

# What stays outside.
BASE = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "libstdc++.so.6",
        "libgcc_s.so.1", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}

# What may be bundled, by the name before ".so", and its licence. A library under the GPL would put
# the wheel under it; one that is not here is refused, until somebody has looked.
LICENCES = {
    r"libtbb": "Apache-2.0",
    r"libfmt": "MIT",
    r"libpng16": "libpng-2.0",
    r"libz": "Zlib",
    r"libbz2": "bzip2-1.0.6",
    r"libzstd": "BSD-3-Clause",
    r"liblz4": "BSD-2-Clause",
    r"libxxhash": "BSD-2-Clause",
    r"libblosc": "BSD-3-Clause",
    r"libsnappy": "BSD-3-Clause",
    r"libdeflate": "MIT",
    r"liblzma": "0BSD",
    r"libtiff": "libtiff",
    r"libjpeg": "IJG AND BSD-3-Clause AND Zlib",
    r"lib(webp|sharpyuv)": "BSD-3-Clause",
    r"libLerc": "Apache-2.0",
    r"lib(OpenEXR|OpenEXRCore|Iex|IlmThread|Imath)-3_\d+": "BSD-3-Clause",
    r"libgdcmjpeg(8|12|16)": "IJG AND BSD-3-Clause",
    r"libgdcm(Common|DICT|DSED|IOD|MSFF)": "BSD-3-Clause",
    r"libopenjp2": "BSD-2-Clause",
    r"libcharls": "BSD-3-Clause",
    r"libjson-c": "MIT",
    r"libuuid": "BSD-3-Clause",
    r"libexpat": "MIT",
    r"libcrypto": "Apache-2.0",
}
# What is told instead of a library that is left out for its licence, of a stand-in for it.
STANDS_IN = "stands in for {}, which is under the GPL"


def fail(message):
    raise SystemExit(f"{message}\nA wheel for this machine alone needs none of this: "
                     "pip wheel . --config-settings=libraries=system")


def output_of(*command):
    try:
        return subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, text=True,
                              check=True, env={**os.environ, "LC_ALL": "C"}).stdout
    except FileNotFoundError:
        return fail(f"{command[0]} is not there: install it")
    except subprocess.CalledProcessError as error:
        return fail(f"{' '.join(map(str, command))}: exit status {error.returncode}")


def stem(library):
    """libtbb of libtbb.so.12."""
    return library.split(".so")[0]


def licence(library):
    for name, said in LICENCES.items():
        if re.fullmatch(name, stem(library)):
            return said
    return fail(f"{library}: its licence is not known here; look, and add it to LICENCES in "
                "tools/wheel/bundle.py, or build without the library")


def needed(file):
    return output_of("patchelf", "--print-needed", file).split()


def linked(file):
    """{name: path} of all that the loader loads with a file, but what stays outside."""
    found = {}
    for line in output_of("ldd", file).splitlines():
        match = re.match(r"\s*(\S+) => (.*?)(?: \(0x\w+\))?$", line)
        if not match or os.path.basename(match.group(1)) in BASE:
            continue
        if match.group(2) == "not found":
            fail(f"{file}: {match.group(1)}, which it needs, is not found")
        found[match.group(1)] = pathlib.Path(os.path.realpath(match.group(2)))
    return found


class Package:
    """The Debian package that a file is of."""

    def __init__(self, file):
        self.name = self.version = ""
        # With /usr merged, dpkg knows files by the path that their package has.
        names = [str(file), "/usr" + str(file)]
        if str(file).startswith("/usr/"):
            names.append(str(file)[4:])
        for name in names:
            said = subprocess.run(["dpkg-query", "-S", name], stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL, text=True, check=False)
            if said.returncode == 0:
                self.name = said.stdout.split(":")[0]
                break
        else:
            fail(f"{file}: no Debian package has it, so its licence is not found")
        self.version = output_of("dpkg-query", "-W", "-f", "${Version}\n",
                                 self.name).splitlines()[0]
        self.copyright = pathlib.Path("/usr/share/doc", self.name, "copyright")
        if not self.copyright.exists():
            fail(f"{self.copyright} is not there, so the licence of {file} cannot be bundled")


def bundled_name(library, file):
    """libtbb-0123abcd.so.12 of libtbb.so.12."""
    digest = hashlib.sha256(file.read_bytes()).hexdigest()[:8]
    return f"{stem(library)}-{digest}{library[len(stem(library)):]}"


def objects(folder):
    """The shared objects in a folder."""
    return sorted(path for path in folder.rglob("*.so*") if path.is_file())


def bundle(stage, package, licences, stand_ins):
    """Bundles what the objects in stage/package link.

    licences   a folder, which gets each library's licence and a list
    stand_ins  {stem: file} of what is bundled in the place of a library
    """
    if not shutil.which("dpkg-query"):
        fail("Licences of bundled libraries are known on Debian alone (dpkg-query is not there).")
    files = objects(stage / package)
    sources = reached(files, stand_ins)
    folder = stage / f"{package}.libs"
    folder.mkdir()
    names, rows, packages = {}, [], {}
    for name, path in sorted(sources.items()):
        names[name] = bundled_name(name, path)
        if stem(name) in stand_ins:
            rows.append((names[name], STANDS_IN.format(name), "Apache-2.0", "LICENSE"))
        else:
            said = licence(name)
            of = packages.setdefault(path, Package(path))
            shutil.copy(of.copyright, licences / f"{of.name}.txt")
            rows.append((names[name], f"Debian's {of.name} {of.version}", said, f"{of.name}.txt"))
        shutil.copy(path, folder / names[name])
    for file in files:
        relative = os.path.relpath(folder, file.parent)
        patch(file, names, f"$ORIGIN/{relative}")
    for name in names.values():
        patch(folder / name, names, "$ORIGIN", name)
    write_list(licences / "README.txt", rows)


def reached(files, stand_ins):
    """{name: file} of all libraries that files link, directly or by others."""
    found, paths = {}, {}
    for file in files:
        paths.update(linked(file))
    left = [name for file in files for name in needed(file)]
    while left:
        name = left.pop()
        if name not in BASE and name not in found:
            found[name] = stand_ins.get(stem(name), paths[name])
            left += needed(found[name])
    return found


def patch(file, names, rpath, own=None):
    """Lets a file look for libraries by their new names, in rpath."""
    changes = []
    for name in needed(file):
        if name in names:
            changes += ["--replace-needed", name, names[name]]
        elif name not in BASE:
            fail(f"{file}: needs {name}, which is not bundled")
    file.chmod(0o755)
    # One after another: patchelf 0.14 mixes up the arguments of different changes.
    for change in (changes, ["--set-soname", own] if own else [], ["--set-rpath", rpath]):
        if change:
            output_of("patchelf", *change, file)


def write_list(file, rows):
    lines = ["Pellucid is under the Apache License 2.0 (LICENSE). Libraries that lie beside it in",
             "this wheel, unchanged but for their names and for where they look for each other:",
             ""]
    for name, where, said, text in rows:
        lines += [name, f"  {where}", f"  {said}: {text}"]
    lines += ["", "Where a text names /usr/share/common-licenses/Apache-2.0, that is LICENSE."]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


# ----- the oldest system ------------------------------------------------------------------------

# The oldest glibc beside which distributions have a runtime of GCC with these versions of symbols:
# (prefix, largest number, glibc). As in auditwheel's policies.
RUNTIMES = (
    ("GLIBCXX_3.4.", 24, 28), ("GLIBCXX_3.4.", 28, 31), ("GLIBCXX_3.4.", 29, 34),
    ("GLIBCXX_3.4.", 30, 35), ("GLIBCXX_3.4.", 33, 39),
    ("CXXABI_1.3.", 11, 28), ("CXXABI_1.3.", 12, 31), ("CXXABI_1.3.", 13, 34),
    ("CXXABI_1.3.", 15, 39),
    ("GCC_", 8, 28), ("GCC_", 11, 34), ("GCC_", 12, 35), ("GCC_", 14, 39))


def versions(file):
    """The versions of symbols that a file asks of other files, but of those beside it."""
    asked, outside = set(), False
    for line in output_of("objdump", "-p", file).splitlines():
        owner = re.match(r"\s*required from (\S+):", line)
        entry = re.match(r"\s*0x[0-9a-f]+ 0x[0-9a-f]+ \d+ (\S+)", line)
        if owner:
            outside = owner.group(1) in BASE
        elif entry and outside:
            asked.add(entry.group(1))
    return asked


def glibc_for(asked):
    """N of the oldest glibc 2.N that has a version of a symbol, or whose runtime of GCC has it."""
    if asked == "GLIBC_ABI_DT_RELR":
        return 36
    match = re.fullmatch(r"GLIBC_2\.(\d+)(?:\.\d+)?", asked)
    if match:
        return int(match.group(1))
    for prefix, largest, glibc in RUNTIMES:
        match = re.fullmatch(re.escape(prefix) + r"(\d+)(?:\.[\d.]+)?", asked)
        if match and int(match.group(1)) <= largest:
            return glibc
    if re.fullmatch(r"GLIBCXX_3\.4|CXXABI_1\.3|CXXABI_(FLOAT128|TM_1)", asked):
        return 28
    # Newer than the table: as new as here.
    return int(platform.libc_ver()[1].split(".")[1])


def platform_tag(stage):
    """manylinux_2_N_x86_64: with glibc 2.N or later, all objects in a folder load (PEP 600)."""
    asked = {version for file in objects(stage) for version in versions(file)}
    newest = max((glibc_for(version) for version in asked), default=28)
    return f"manylinux_2_{max(newest, 28)}_{platform.machine()}"

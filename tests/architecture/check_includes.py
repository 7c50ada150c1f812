#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares every #include with the order of docs/explanation/architecture.md.

The includes are those of include/, src/, apps/ and plugins/.

  check_includes.py ROOT MODULES

MODULES is what CMake declares, a line "name: depends... | other targets..." per module. Prints one
line per violation and ends with 1 if there is any.
"""
import pathlib
import re
import sys

# Left to right: a module may include those whose rank is smaller. Equal rank: siblings that never
# see each other.
RANK = {
    "base": 0, "simd": 1, "math": 2, "geometry": 3, "field": 4, "transfer": 4, "error": 4,
    "segment": 5, "traverse": 6, "render": 7, "packet": 8, "scene": 9, "cuda": 10, "cpu": 11,
    "io": 11, "cluster": 12, "reference": 12, "umbrella": 13, "apps": 13, "plugins": 13,
}
CORE = {name for name, rank in RANK.items() if rank <= RANK["packet"]}
# Further pairs that the ranks would allow: the closed forms of segment/ are tested without any
# grid, and the judge in reference/ shares no kernel with what it judges.
FORBIDDEN = {("segment", "field")} | {
    ("reference", name) for name in CORE - {"base", "geometry"} | {"cuda"}}

# The core is free of the standard library but for these; what computes is wrapped by simd/scalar.h.
ORDER = "docs/explanation/architecture.md"
CORE_HEADERS = {"cstddef", "cstdint", "limits", "type_traits"}
SIMD_HEADERS = CORE_HEADERS | {"cmath", "bit"}

SIMD_LIBRARY = re.compile(r"^(.*intrin\.h|arm_neon\.h|arm_sve\.h|experimental/simd|xsimd/.*|hwy/.*|"
                          r"Vc/.*|eve/.*)$")
CUDA_NAME = re.compile(r"__(CUDACC|CUDA_ARCH|NVCC|host|device|global|constant|shared"
                       r"|forceinline)_*\b|\bcuda_?runtime")

# Headers of other projects, and the target that a module must declare to include them.
OTHER_PROJECTS = [
    (re.compile(r"^(oneapi/)?tbb/"), "TBB::tbb"),
    (re.compile(r"^cuda_runtime\.h$"), "CUDA::cudart_static"),
    (re.compile(r"^boost/"), "Boost::headers"),
    (re.compile(r"^png\.h$"), "PNG::PNG"),
    (re.compile(r"^tiffio\.h$"), "TIFF::TIFF"),
    (re.compile(r"^gdcm[A-Z].*\.h$"), "GDCM"),
    (re.compile(r"^zlib\.h$"), "ZLIB::ZLIB"),
    (re.compile(r"^(OpenEXR/)?(Imf|Iex)"), "OpenEXR::OpenEXR"),
    (re.compile(r"^(Imath/)?(Imath|half)"), "OpenEXR::OpenEXR"),
    (re.compile(r"^nlohmann/"), "nlohmann_json::nlohmann_json"),
    (re.compile(r"^fmt/"), "fmt::fmt"),
    (re.compile(r"^CLI/"), "CLI11::CLI11"),
    (re.compile(r"^tiffio\.h$"), "TIFF::TIFF"),
    (re.compile(r"^itk.*\.h$"), "ITKCommon"),
    (re.compile(r"^gdcm.*\.h$"), "GDCM"),
    (re.compile(r"^vtk.*\.h$"), "VTK::CommonCore"),
    (re.compile(r"^hdf5\.h$"), "hdf5"),
    (re.compile(r"^netcdf\.h$"), "netcdf"),
    (re.compile(r"^openvdb/"), "openvdb"),
    (re.compile(r"^cairo(-pdf|-svg)?\.h$"), "cairo"),
    (re.compile(r"^mpi\.h$"), "MPI"),
    (re.compile(r"^bzlib\.h$"), "BZip2::BZip2"),
    (re.compile(r"^blosc\.h$"), "blosc"),
    (re.compile(r"^zstd\.h$"), "zstd"),
    (re.compile(r"^lz4\.h$"), "lz4"),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
# A header of the standard library, of C, of POSIX or of Emscripten: no folder and no suffix, or one
# of these.
PLAIN = re.compile(r"^([a-z_0-9]+|(fcntl|unistd|errno|dlfcn|spawn|malloc|sys/[a-z]+|"
                   r"emscripten/[a-z_]+)\.h)$")


def read_modules(path):
    depends, private = {}, {}
    for line in path.read_text().splitlines():
        name, _, rest = line.partition(":")
        left, _, right = rest.partition("|")
        depends[name], private[name] = left.split(), right
    closure = {}
    for name in depends:
        todo, seen = list(depends[name]), set()
        while todo:
            module = todo.pop()
            if module not in seen:
                seen.add(module)
                todo += depends.get(module, [])
        closure[name] = seen
    return depends, private, closure


def module_of(path):
    """The module that a file of the repository belongs to, from its path relative to the root."""
    parts = path.parts
    if parts[0] == "include":
        return parts[2] if len(parts) > 3 else "umbrella"
    return parts[0] if parts[0] in ("apps", "plugins") else parts[1]


def is_internal(header):
    """Whether a header is for this repository alone, and not installed."""
    return pathlib.PurePath(header).parent.name == "internal"


def without_comments(text):
    text = re.sub(r"/\*.*?\*/", lambda match: "\n" * match.group().count("\n"), text, flags=re.S)
    return re.sub(r"//[^\n]*", "", text)


def check_arrow(source, target):
    """Why `source` may not include `target`, by the order alone; None where it may."""
    if source == target:
        return None
    if RANK[source] == RANK[target]:
        return f"{source} and {target} are siblings that never see each other"
    if RANK[source] < RANK[target]:
        return f"{target} stands to the right of {source}"
    if (source, target) in FORBIDDEN:
        return f"{source} never sees {target}"
    return None


def check_file(root, path, modules):
    _, private, closure = modules
    relative = path.relative_to(root)
    module = module_of(relative)
    if module not in RANK:
        yield f"{relative}:1: {module} has no place in the order of {ORDER}"
        return
    text = path.read_text()
    if not text.startswith("// SPDX-License-Identifier: Apache-2.0\n"):
        yield f"{relative}:1: the first line is not the SPDX line"
    if path.suffix == ".h" and "\n#pragma once\n" not in text:
        yield f"{relative}:1: no #pragma once"
    for number, line in enumerate(without_comments(text).splitlines(), 1):
        where = f"{relative}:{number}"
        if CUDA_NAME.search(line) and module != "base" and relative.parts[:2] != ("src", "cuda"):
            yield f"{where}: names CUDA; only include/pellucid/base and src/cuda may"
        match = INCLUDE.match(line)
        if not match:
            continue
        quoted, name = match[1] == '"', match[2]
        if name.startswith("pellucid/"):
            if not quoted:
                yield f"{where}: {name} is ours: write it in quotes"
            if not (root / "include" / name).is_file():
                yield f"{where}: {name} does not exist"
            if relative.parts[0] == "include" and not is_internal(path) and is_internal(name):
                yield f"{where}: {name} is not installed, but a header that is includes it"
            target = name.split("/")[1]
            if target not in RANK:
                yield f"{where}: {target} has no place in the order of {ORDER}"
                continue
            reason = check_arrow(module, target)
            if reason:
                yield f"{where}: {module} includes {name}, but {reason}"
            elif target != module and module in closure and target not in closure[module]:
                yield (f"{where}: {module} includes {name}, but CMake does not say that it depends "
                       f"on {target}")
        elif quoted:
            # Beside this one, or in the module's folder, whose sub-folders find its headers.
            folders = [path.parent, root.joinpath(*relative.parts[:2])]
            if relative.parts[0] == "apps":  # one program includes parts of another: "cli/parse.h"
                folders.append(root / "apps")
            # A plug-in takes arrays and cells of its host as the readers of files do. That for
            # ParaView draws by the mappers of that for VTK.
            if relative.parts[0] == "plugins":
                folders += [root / "src" / "io", root / "plugins" / "vtk"]
            if (relative.parts[0] == "include" or ".." in name
                    or not any((folder / name).is_file() for folder in folders)):
                yield f'{where}: "{name}" is neither "pellucid/..." nor a file beside this one'
        elif SIMD_LIBRARY.match(name):
            if module != "simd":
                yield f"{where}: {name} is a SIMD library; only simd/ may name one"
        elif module in CORE:
            if name not in (SIMD_HEADERS if module == "simd" else CORE_HEADERS):
                yield f"{where}: <{name}> in the core; use pellucid/simd/scalar.h, or do without"
        else:
            owner = next((target for pattern, target in OTHER_PROJECTS if pattern.match(name)),
                         None)
            if owner is None and not PLAIN.match(name):
                yield f"{where}: <{name}> belongs to no project that check_includes.py knows"
            elif owner and relative.parts[0] == "include":
                yield f"{where}: <{name}> in a public header; {owner} is a private dependency"
            elif owner and module in private and owner not in private[module]:
                yield f"{where}: <{name}> needs {owner}, which CMake does not declare for {module}"


def check(root, modules):
    depends = modules[0]
    for name, targets in depends.items():
        for target in targets:
            reason = check_arrow(name, target)
            if reason:
                yield f"CMake: {name} depends on {target}, but {reason}"
    for folder in ("include", "src", "apps", "plugins"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".cpp", ".cu"):
                yield from check_file(root, path, modules)


def main():
    root, modules = pathlib.Path(sys.argv[1]), read_modules(pathlib.Path(sys.argv[2]))
    violations = list(check(root, modules))
    print("\n".join(violations) if violations else "every include runs the right way")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())

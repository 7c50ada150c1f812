# SPDX-License-Identifier: Apache-2.0
"""Packs the build and looks at the Debian package: what it holds, needs and says. The package stays
in PELLUCID_PACKAGE_FOLDER, where test_debian_root.py finds it."""
import gzip
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

SOURCE = os.environ["PELLUCID_SOURCE_DIR"]
BUILD = os.environ["PELLUCID_BINARY_DIR"]
FOLDER = os.environ["PELLUCID_PACKAGE_FOLDER"]
VERSION = os.environ["PELLUCID_VERSION"]
LIBDIR = os.environ["PELLUCID_LIBDIR"]

# Where Debian has the packages that the installed CMake package looks for. NVIDIA's are not in it.
DEBIAN_PACKAGES = {"TBB": "libtbb-dev", "PNG": "libpng-dev", "OpenEXR": "libopenexr-dev",
                   "TIFF": "libtiff-dev", "ZLIB": "zlib1g-dev", "BZip2": "libbz2-dev",
                   "nlohmann_json": "nlohmann-json3-dev", "CUDAToolkit": None}

# Words of lintian's that are meant: the authors have no address.
MEANT = {"bogus-mail-host", "bogus-mail-host-in-debian-changelog"}


def run(*command, **options):
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            check=False, **options)
    if result.returncode != 0:
        raise AssertionError(f"{' '.join(command)}: exit status {result.returncode}\n"
                             f"{result.stdout}")
    return result.stdout


def pack():
    """Packs into FOLDER and gives the file."""
    page = os.path.join(BUILD, "share", "man", "man1", "pellucid.1")
    run(sys.executable, "-B", os.path.join(SOURCE, "tools", "man_page.py"),
        os.environ["PELLUCID_PROGRAM"], page)
    for name in os.listdir(FOLDER):
        if name.endswith(".deb"):
            os.remove(os.path.join(FOLDER, name))
    # With a folder for temporary files of its own, for scripts/package may pack at the same time.
    with tempfile.TemporaryDirectory(prefix="pack_", dir=FOLDER) as work:
        run(os.environ["PELLUCID_CPACK"], "--config", os.path.join(BUILD, "CPackConfig.cmake"),
            "-B", work, umask=0o077)  # which must not show in the package
        debs = [name for name in os.listdir(work) if name.endswith(".deb")]
        assert len(debs) == 1, debs
        deb = os.path.join(FOLDER, debs[0])
        os.replace(os.path.join(work, debs[0]), deb)
    return deb


class Contents(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.deb = pack()
        cls.scratch = tempfile.mkdtemp(prefix="pellucid_contents_")
        tar = os.path.join(cls.scratch, "data.tar")
        with open(tar, "wb") as file:
            subprocess.run(["dpkg-deb", "--fsys-tarfile", cls.deb], stdout=file, check=True)
        cls.tar = tarfile.open(tar)
        cls.members = {member.name.removeprefix("./"): member for member in cls.tar}

    @classmethod
    def tearDownClass(cls):
        cls.tar.close()
        shutil.rmtree(cls.scratch)

    def content(self, path):
        self.assertIn(path, self.members)
        return self.tar.extractfile(self.members[path]).read()

    def field(self, name):
        return run("dpkg-deb", "--field", self.deb, name).strip()

    def packages(self, field):
        return {entry.split()[0] for entry in self.field(field).split(",") if entry.strip()}

    def test_name_and_version(self):
        architecture = run("dpkg", "--print-architecture").strip()
        self.assertEqual(os.path.basename(self.deb), f"pellucid_{VERSION}_{architecture}.deb")
        self.assertEqual(self.field("Package"), "pellucid")
        self.assertEqual(self.field("Version"), VERSION)
        self.assertEqual(self.field("Architecture"), architecture)

    def test_holds_what_users_need(self):
        for path in ("usr/bin/pellucid", "usr/share/man/man1/pellucid.1.gz",
                     "usr/share/bash-completion/completions/pellucid",
                     "usr/share/doc/pellucid/copyright", "usr/share/doc/pellucid/changelog.gz",
                     "usr/share/doc/pellucid/NEWS.gz", "usr/share/doc/pellucid/examples/README.md",
                     "usr/share/doc/pellucid/examples/shells.json",
                     "usr/include/pellucid/base/version.h"):
            self.assertIn(path, self.members)
        for pattern in (r"usr/lib/.*libpellucid_cpu\.a", r"usr/lib/.*libpellucid_io\.a",
                        r"usr/lib/.*cmake/pellucid/pellucidConfig\.cmake"):
            self.assertTrue(any(re.fullmatch(pattern, name) for name in self.members), pattern)
        self.assertTrue(gzip.decompress(self.content("usr/share/man/man1/pellucid.1.gz"))
                        .startswith(b'.\\" Made by'))
        self.assertIn(f"pellucid ({VERSION})".encode(),
                      gzip.decompress(self.content("usr/share/doc/pellucid/changelog.gz")))

    def test_modules_lie_where_the_program_looks(self):
        modules = os.path.join(BUILD, LIBDIR, "pellucid")
        for name in sorted(os.listdir(modules)) if os.path.isdir(modules) else []:
            if name.endswith(".so"):
                self.assertIn(f"usr/{LIBDIR}/pellucid/{name}", self.members)

    def test_the_python_module_lies_where_debians_python3_looks(self):
        if os.environ["PELLUCID_PYTHON_MODULE"] == "":
            self.skipTest("the Python module is not built")
        folder = "usr/lib/python3/dist-packages/pellucid"
        name = os.path.basename(os.environ["PELLUCID_PYTHON_MODULE"])
        for path in ("__init__.py", "vtk.py", "_pellucid.pyi", "py.typed", name):
            self.assertIn(f"{folder}/{path}", self.members)
        self.assertIn("python3-numpy", self.packages("Recommends"))

    def test_examples_run_as_they_are(self):
        for name in self.members:
            if name.endswith(".json"):
                self.assertNotIn(b'"../', self.content(name), name)

    def test_permissions_and_owners(self):
        for name, member in self.members.items():
            executable = member.isdir() or name == "usr/bin/pellucid"
            self.assertEqual(member.mode & 0o7777, 0o755 if executable else 0o644, name)
            self.assertEqual((member.uid, member.gid), (0, 0), name)

    def test_all_files_have_the_time_of_the_commit(self):
        self.assertEqual(len({member.mtime for member in self.members.values()}), 1)

    def test_checksums(self):
        control = os.path.join(self.scratch, "control")
        run("dpkg-deb", "--control", self.deb, control)
        with open(os.path.join(control, "md5sums"), encoding="utf-8") as file:
            sums = dict(reversed(line.rstrip("\n").split("  ", 1)) for line in file)
        files = {name for name, member in self.members.items() if member.isfile()}
        self.assertEqual(set(sums), files)
        for name in files:
            self.assertEqual(hashlib.md5(self.content(name)).hexdigest(), sums[name], name)

    def test_only_modules_need_their_libraries(self):
        depends, recommends = self.packages("Depends"), self.packages("Recommends")
        self.assertIn("libc6", depends)
        heavy = re.compile("lib(vtk|insighttoolkit|hdf5|netcdf|openvdb|cairo)")
        self.assertEqual([name for name in depends if heavy.match(name)], [])
        self.assertEqual(depends & recommends, set())
        if os.environ["PELLUCID_HAS_VTK"] == "1":
            self.assertTrue(any(name.startswith("libvtk") for name in recommends), recommends)

    def test_suggests_what_the_libraries_are_linked_with(self):
        suggests = self.packages("Suggests")
        folder = next(os.path.dirname(name) for name in self.members
                      if name.endswith("/pellucidConfig.cmake"))
        config = self.content(f"{folder}/pellucidConfig.cmake").decode()
        looked_for = {package.split()[0]
                      for found in re.findall(r'set\(_pellucid_packages_\w+ "(.+)"\)', config)
                      for package in found.split(";")}
        self.assertIn("TBB", looked_for)
        for package in filter(None, (DEBIAN_PACKAGES[name] for name in looked_for)):
            self.assertIn(package, suggests)
        targets = self.content(f"{folder}/pellucidTargets.cmake").decode()
        for library in set(re.findall(r"/usr/lib/[^;\"]+\.so", targets)):
            owner = run("dpkg", "-S", library).split(":")[0]
            self.assertIn(owner, suggests, library)

    def test_program_and_modules_are_stripped(self):
        for name in self.members:
            if name == "usr/bin/pellucid" or name.endswith(".so"):
                path = os.path.join(self.scratch, "binary")
                with open(path, "wb") as file:
                    file.write(self.content(name))
                self.assertNotIn(".symtab", run("readelf", "--wide", "--sections", path), name)

    def test_packing_again_gives_the_same_package(self):
        with open(self.deb, "rb") as file:
            first = hashlib.sha256(file.read()).hexdigest()
        with open(pack(), "rb") as file:
            self.assertEqual(hashlib.sha256(file.read()).hexdigest(), first)

    def test_lintian(self):
        if not shutil.which("lintian"):
            self.skipTest("lintian is not installed")
        result = subprocess.run(["lintian", "--allow-root", "--fail-on=none", self.deb],
                                stdout=subprocess.PIPE, text=True, check=False)
        said = {line for line in result.stdout.splitlines()
                if re.match(r"[EW]: ", line) and line.split()[2] not in MEANT}
        self.assertEqual(said, set())


if __name__ == "__main__":
    if not shutil.which("dpkg-shlibdeps"):
        print("skipped: this needs Debian's package dpkg-dev")
        sys.exit(77)
    os.makedirs(FOLDER, exist_ok=True)
    unittest.main()

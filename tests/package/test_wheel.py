# SPDX-License-Identifier: Apache-2.0
"""How libraries get into a wheel (tools/wheel/bundle.py), and that the check of a wheel sees what
is wrong with one (check_wheel.py): on a module of C that links libpng and TBB. scripts/test-wheel
makes and uses the whole one.

Skipped (exit status 77) without a compiler, patchelf, objdump or Debian's list of packages.
"""
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

SOURCE = os.environ["PELLUCID_SOURCE_DIR"]
sys.path.insert(0, os.path.join(SOURCE, "tools", "wheel"))
import bundle
import pellucid_wheel

CODE = """
const char* png_get_libpng_ver(const void*);
const char* TBB_runtime_version(void);
const char* both(void) { return TBB_runtime_version() ? png_get_libpng_ver(0) : 0; }
"""


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


class Wheel(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pellucid_test_wheel_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(os.path.realpath(folder.name))
        self.stage = self.folder / "stage"
        (self.stage / "pellucid").mkdir(parents=True)
        self.tag = pellucid_wheel.python_tag()
        number = self.tag.split("-")[1][2:]
        self.module = self.stage / f"pellucid/_pellucid.cpython-{number}-x.so"
        self.info = self.stage / "pellucid-0.1.0.dist-info"
        self.licences = self.info / "licenses"
        self.licences.mkdir(parents=True)
        shutil.copy(os.path.join(SOURCE, "LICENSE"), self.licences)

    def compile(self, code, output, *arguments):
        source = self.folder / "code.c"
        source.write_text(code)
        run("cc", "-shared", "-fPIC", "-o", output, source, *arguments)
        return output

    def make(self):
        """The module, and what it links beside it; the tag of the system."""
        self.compile(CODE, self.module, "-lpng", "-ltbb")
        bundle.bundle(self.stage, "pellucid", self.licences, {})
        return bundle.platform_tag(self.stage)

    def packed(self, system):
        (self.info / "METADATA").write_text("Name: pellucid\n")
        (self.info / "WHEEL").write_text(f"Tag: {self.tag}-{system}\n")
        record = self.info / "RECORD"
        if record.exists():
            record.unlink()
        wheel = self.folder / f"pellucid-0.1.0-{self.tag}-{system}.whl"
        pellucid_wheel.pack(self.stage, self.info, wheel)
        return wheel

    def said_of(self, wheel, *arguments):
        result = subprocess.run(
            [sys.executable, "-B", os.path.join(SOURCE, "tools/wheel/check_wheel.py"), wheel,
             *arguments], stdout=subprocess.PIPE, text=True, check=False)
        self.assertEqual(result.returncode, int("FAILED" in result.stdout), result.stdout)
        return result.stdout

    def library(self, name):
        return next((self.stage / "pellucid.libs").glob(name + "-*"))

    def test_bundled(self):
        said = self.said_of(self.packed(self.make()), "--plain")
        self.assertNotIn("FAILED", said)
        names = {path.name.split("-")[0] for path in (self.stage / "pellucid.libs").iterdir()}
        self.assertEqual(names, {"libpng16", "libtbb", "libz"})
        # It loads, and what it loads is what lies beside it.
        result = subprocess.run(
            [sys.executable, "-c", "import ctypes, sys; library = ctypes.CDLL(sys.argv[1]);"
             "library.both.restype = ctypes.c_char_p; assert library.both();"
             "print(open('/proc/self/maps').read())", self.module],
            stdout=subprocess.PIPE, text=True, check=True)
        for name in names - {"libz"}:
            self.assertIn(str(self.library(name)), result.stdout)
            self.assertNotIn(f"/{name}.so", result.stdout)

    def test_same_bits(self):
        wheel = self.packed(self.make())
        first = wheel.read_bytes()
        wheel.unlink()
        shutil.rmtree(self.stage / "pellucid.libs")
        self.assertEqual(self.make(), wheel.stem.split("-")[-1])
        self.assertEqual(self.packed(bundle.platform_tag(self.stage)).read_bytes(), first)

    def test_stand_in(self):
        other = self.compile("const char* png_get_libpng_ver(const void* p) { return p; }",
                             self.folder / "libstand_in.so")
        self.compile(CODE, self.module, "-lpng", "-ltbb")
        bundle.bundle(self.stage, "pellucid", self.licences, {"libpng16": other})
        said = self.said_of(self.packed(bundle.platform_tag(self.stage)), "--plain")
        # What libpng alone needs is not wanted any more.
        self.assertNotIn("FAILED", said)
        self.assertIn("stands in for libpng16.so.16",
                      (self.licences / "README.txt").read_text(encoding="utf-8"))

    def test_refused_libraries(self):
        unknown = self.compile("int f(void) { return 1; }", self.folder / "libunknown.so.1",
                               "-Wl,-soname,libunknown.so.1")
        self.compile("int f(void); int g(void) { return f(); }", self.module, unknown,
                     f"-Wl,-rpath,{self.folder}")
        with self.assertRaisesRegex(SystemExit, "libunknown.so.1: its licence is not known"):
            bundle.bundle(self.stage, "pellucid", self.licences, {})
        shutil.rmtree(self.stage / "pellucid.libs")
        bundle.LICENCES["libunknown"] = "MIT"
        self.addCleanup(bundle.LICENCES.pop, "libunknown")
        with self.assertRaisesRegex(SystemExit, "no Debian package has it"):
            bundle.bundle(self.stage, "pellucid", self.licences, {})
        shutil.rmtree(self.stage / "pellucid.libs")
        unknown.unlink()
        with self.assertRaisesRegex(SystemExit, "libunknown.so.1, which it needs, is not found"):
            bundle.bundle(self.stage, "pellucid", self.licences, {})

    def test_defects_are_seen(self):
        system = self.make()
        png, tbb = self.library("libpng16"), self.library("libtbb")
        good = {path: path.read_bytes() for path in self.stage.rglob("*") if path.is_file()}

        def damage_licence(name, text):
            path = next(self.licences.glob(name))
            path.write_text(text)

        defects = (
            (lambda: self.library("libz").unlink(), "which is not in the wheel"),
            (lambda: run("patchelf", "--set-rpath", "/usr/lib", png),
             "looks for libraries in /usr/lib"),
            (lambda: run("patchelf", "--set-rpath", "$ORIGIN/../../..", png),
             "looks for libraries in $ORIGIN/../../.."),
            (lambda: run("patchelf", "--remove-rpath", self.module), "is not in the wheel"),
            (lambda: run("patchelf", "--set-soname", "libpng16.so.16", png),
             "has another name inside"),
            (lambda: run("patchelf", "--remove-needed", tbb.name, self.module),
             f"{tbb.name} is linked by nothing"),
            (lambda: run("patchelf", "--add-needed", "libtiff.so.6", self.module),
             "needs libtiff.so.6, which is not in the wheel"),
            (lambda: next(self.licences.glob("zlib1g.txt")).unlink(),
             "is not in the wheel"),
            (lambda: damage_licence("zlib1g.txt", "Files: *\nLicense: GPL-2+\n" + "text " * 99),
             "is under GPL-2+"),
            (lambda: damage_licence("README.txt", "nothing\n"), "the list of licences is not"),
        )
        for damage, said in defects:
            damage()
            with self.subTest(said=said):
                self.assertIn(said, self.said_of(self.packed(system), "--plain"))
            for path in set(self.stage.rglob("*.*")) - set(good):
                if path.is_file():
                    path.unlink()
            for path, data in good.items():
                path.write_bytes(data)

        wheel = self.packed(system)
        self.assertNotIn("FAILED", self.said_of(wheel, "--plain"))
        self.assertIn("there are no kernels for avx2", self.said_of(wheel))
        self.assertIn("holds \"both\"", self.said_of(wheel, "--plain", "--absent", "both"))
        self.assertIn("asks for GLIBC_2.", self.said_of(
            self.packed(f"manylinux_2_5_{platform.machine()}"), "--plain"))
        self.assertIn("is no tag of a system that others have",
                      self.said_of(self.packed(f"linux_{platform.machine()}"), "--plain"))
        with zipfile.ZipFile(wheel, "a") as archive:
            archive.writestr("pellucid/more.py", "")
        self.assertIn("RECORD does not list the files: pellucid/more.py",
                      self.said_of(wheel, "--plain"))
        other = self.folder / "other" / wheel.name
        other.parent.mkdir()
        with zipfile.ZipFile(self.packed(system)) as old, zipfile.ZipFile(other, "w") as new:
            for name in old.namelist():
                new.writestr(name, old.read(name) + (b"more" if name.endswith("LICENSE") else b""))
        self.assertIn("RECORD has another sum of", self.said_of(other, "--plain"))
        self.tag = "cp39-cp39"
        self.assertIn("is not that of", self.said_of(self.packed(system), "--plain"))

    def test_oldest_system(self):
        for asked, glibc in (("GLIBC_2.2.5", 2), ("GLIBC_2.38", 38), ("GLIBCXX_3.4", 28),
                             ("GLIBCXX_3.4.29", 34), ("GLIBCXX_3.4.30", 35),
                             ("GLIBCXX_3.4.32", 39), ("CXXABI_1.3.13", 34), ("GCC_3.0", 28),
                             ("GCC_12.0.0", 35), ("GLIBC_ABI_DT_RELR", 36)):
            self.assertEqual(bundle.glibc_for(asked), glibc, asked)
        here = int(platform.libc_ver()[1].split(".")[1])
        self.assertEqual(bundle.glibc_for("GLIBCXX_3.4.99"), here)


if __name__ == "__main__":
    missing = [tool for tool in ("cc", "patchelf", "objdump", "readelf", "ldd", "dpkg-query")
               if not shutil.which(tool)]
    if missing:
        print(f"skipped: {missing} not installed")
        sys.exit(77)
    unittest.main()

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plants in a small repository what the checks beside this file must find, and what they must not.
"""
import contextlib
import io
import json
import pathlib
import tempfile
import unittest

import check_blocks
import check_comments
import check_lines
import check_links
import run_blocks
from documents import Page, slug_of

SCHEMA = {"$schema": "https://json-schema.org/draft/2020-12/schema", "type": "object",
          "required": ["volumes"], "$defs": {"camera": {"type": "object", "required": ["up"]}}}


class Repository(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = pathlib.Path(temporary.name).resolve()
        self.write("docs/reference/scene.schema.json", json.dumps(SCHEMA))

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def found(self, check, *arguments):
        return "\n".join(check(self.root, *arguments))


class Comments(Repository):
    def kinds(self, text):
        return [kind for kind, *_ in check_comments.found_in(text)]

    def test_clauses(self):
        for word in ("What", "Of", "Where", "Whether", "How", "Those", "As"):
            self.assertEqual(self.kinds(f"/// {word} it is.\nstruct Thing {{}};\n"), ["clauses"])
            self.assertEqual(self.kinds(f"/// {word} it is.\nint thing();\n"), ["clauses"])
        self.assertEqual(self.kinds("/// A thing.\n/// What follows.\nint thing;\n"), [])
        self.assertEqual(self.kinds("/// Offset of a thing.\nint thing;\n"), [])

    def test_notes(self):
        self.assertEqual(self.kinds("int n;  ///< of things\nint m;  ///< number of things\n"),
                         ["notes"])

    def test_functions(self):
        for function in ("int thing(int n);", "explicit Thing(int n);",
                         "template <class T, int N>\nPELLUCID_HD constexpr Rgb<T> thing(T n) {",
                         "[[nodiscard]] static bool operator==(const Thing&);"):
            self.assertEqual(self.kinds(f"/// The thing.\n{function}\n"), ["functions"], function)
            self.assertEqual(self.kinds(f"/// Returns it.\n{function}\n"), [], function)
        for other in ("struct Thing {", "int thing = other(1);", "using Thing = void (*)(int);",
                      "class Thing : public Base<int> {", "int thing{};"):
            self.assertEqual(self.kinds(f"/// The thing.\n{other}\n"), [], other)
        self.assertEqual(self.kinds("/// Values of it.\nint thing();\n"), ["functions"])
        self.assertEqual(self.kinds("///@{\n/**\n * The thing.\n */\nint thing();\n///@}\n"), [])

    def test_numbers(self):
        self.write("src/a.h", "/// What it is.\nstruct A {};\n")
        self.write("tests/a.h", "/// What it is.\nstruct A {};\n")  # is not counted
        none = dict.fromkeys(check_comments.KINDS, 0)
        self.assertIn("1 clauses", self.found(check_comments.check, none))
        self.assertEqual(self.found(check_comments.check, dict(none, clauses=1)), "")
        self.assertIn("lower", self.found(check_comments.check, dict(none, clauses=99)))


class Links(Repository):
    def check(self, text, other="# Other\n"):
        self.write("README.md", text)
        self.write("docs/other.md", other)
        return self.found(check_links.check)

    def test_good_ones(self):
        self.assertEqual(self.check(
            "# Head line\n[a](docs/other.md) [b](docs/other.md#two-words)\n"
            "[c](#head-line) [d](docs) "
            "[e](https://example.org/x#y) [f][g] [wrapped\nlink](/docs/other.md)\n"
            "<img src=\"docs/other.md\">\n\n[g]: docs/other.md#other\n",
            "# Other\n## Two *words*\n"), "")

    def test_missing_file(self):
        self.assertIn("README.md:2: links to docs/none.md", self.check("\n[a](docs/none.md)\n"))
        self.assertIn("docs/none.png", self.check("![a](docs/none.png)\n"))
        self.assertIn("docs/none.png", self.check("<img width=\"9\"\nsrc=\"docs/none.png\">\n"))
        self.assertIn("docs/none.md", self.check("[a][b]\n\n[b]: docs/none.md\n"))
        self.assertIn("../outside.md", self.check("[a](../outside.md)\n"))

    def test_missing_anchor(self):
        self.assertIn("no such heading", self.check("[a](docs/other.md#none)\n"))
        self.assertIn("no such heading", self.check("[a](#none)\n"))
        self.assertIn("no such heading", self.check("[a](docs/other.md#second)\n",
                                                    "```sh\n# second\n```\n"))

    def test_page_that_nothing_leads_to(self):
        self.write("docs/far.md", "[back](other.md)\n")
        self.assertEqual(self.check("[a](docs/other.md)\n", "[far](far.md)\n"), "")
        self.assertIn("docs/far.md: no links lead here", self.check("[a](docs/other.md)\n"))

    def test_undefined_name(self):
        self.assertIn("does not define", self.check("[a][b]\n"))

    def test_code_is_no_link(self):
        self.assertEqual(self.check("`[a](none.md)` ``a[i](x)``\n```cpp\n[a](none.md)\n```\n"
                                    "[a](docs/other.md)\n"), "")

    def test_open_fence(self):
        self.assertIn("README.md:2: this block", self.check("\n```sh\nx\n"))

    def test_anchors(self):
        self.assertEqual(slug_of("`pellucid render`, 2×: *all* [of](x.md) it_is!"),
                         "pellucid-render-2-all-of-it_is")
        self.assertEqual(Page("# A\n## A\n\nB c\n---\n<a id=\"d\"></a>\n").anchors(),
                         {"a", "a-1", "b-c", "d"})


class Lines(Repository):
    def check(self, name, text, generated=None):
        self.write(name, text)
        return self.found(check_lines.check, generated or {})

    def test_characters_count_and_not_bytes(self):
        self.assertEqual(self.check("a.h", "×" * 100 + "\n"), "")
        self.assertIn("a.h:2: has 101", self.check("a.h", "x\n" + "×" * 101 + "\n"))

    def test_every_kind(self):
        for name in ("a.cpp", "a.cu", "a.py", "a.md", "a.cmake", "b/CMakeLists.txt", "a.cmake.in",
                     "scripts/x", ".ci/run", "examples/x.json", "docs/notes/a.md"):
            self.assertIn(f"{name}:1: has 101", self.check(name, "x" * 101), name)

    def test_what_may_be_long(self):
        self.assertEqual(self.check("docs/notes/a.md", "| " + "x" * 100 + " |\n"), "")
        written = "<!-- a: begin -->\n" + "x" * 101 + "\n<!-- a: end -->\n"
        self.assertEqual(self.check("docs/notes/a.md", written), "")
        self.assertIn("a.md:4", self.check("docs/notes/a.md", written + "x" * 101))
        self.assertIn("docs/a.md:1", self.check("docs/a.md", "| " + "x" * 100 + " |\n"))

    def test_generated_files_name_their_generator(self):
        self.write("tools/make.py", "\n")
        generated = {"a.h": "tools/make.py"}
        self.assertEqual(self.check("a.h", "// by tools/make.py\n" + "x" * 101, generated), "")
        self.assertIn("do not say", self.check("a.h", "x" * 101, generated))
        generated = {"a.h": "tools/none.py"}
        self.assertIn("does not exist",
                      self.check("a.h", "// by tools/none.py\n" + "x" * 101, generated))


class Blocks(Repository):
    def check(self, text, page="README.md"):
        self.write("tests/install/a/CMakeLists.txt", "project(a)\nadd_executable(a ../a.cpp)\n")
        self.write("tests/install/a.cpp", "int main() {\n  return 0;\n}\n")
        self.write(page, text)
        return self.found(check_blocks.check)

    def test_compiled(self):
        self.assertEqual(self.check("```cpp\nint main() {\n  return 0;\n}\n```\n"
                                    "```cmake\nproject(a)\n```\n"), "")
        self.assertIn("README.md:2: stands in no", self.check("```cpp\n  return 1;\n```\n"))
        self.assertIn("docs/how-to/x.md:2", self.check("```cmake\nproject(b)\n```\n",
                                                       "docs/how-to/x.md"))

    def test_json(self):
        self.assertEqual(self.check("```json scene\n{\"volumes\": []}\n```\n"), "")
        self.assertEqual(self.check("```json\n[1]\n```\n"), "")
        self.assertIn("is not JSON", self.check("```json\n{,}\n```\n"))
        self.assertIn("is not JSON", self.check("```json\n[NaN]\n```\n"))
        self.assertIn("has no nonsense", self.check("```json nonsense\n{}\n```\n"))
        if check_blocks.Draft202012Validator is not None:
            self.assertIn("is no scene", self.check("```json scene\n{}\n```\n"))
            self.assertIn("is no camera", self.check("```json camera\n{}\n```\n"))

    def test_language(self):
        self.assertIn("a block of ''", self.check("```\nx\n```\n"))
        self.assertIn("a block of 'bash'", self.check("```bash\nx\n```\n"))
        self.assertEqual(self.check("```text\nx\n```\n"), "")


class Commands(Repository):
    PROGRAM = "#!/bin/sh\ntest \"$1\" != fail || exit 1\ntest \"$1\" = silent || echo x >\"$3\"\n"

    def run_page(self, text):
        self.write("page.md", text)
        self.write("program/bin/pellucid", self.PROGRAM)
        (self.root / "program/bin/pellucid").chmod(0o755)
        with contextlib.redirect_stdout(io.StringIO()) as said:
            status = run_blocks.main(self.root, self.root / "program", "page.md")
        return status, said.getvalue()

    def test_good(self):
        status, said = self.run_page(
            "<!-- file: a.json -->\n```json\n{}\n```\n```sh\n# a comment\nx=a.json\n"
            "cat \\\n  \"$x\"\n"
            "cat <<'E'\nhere\nE\nfor i in 1 2; do\n  echo $i\ndone\npellucid render -o b.png\n```\n"
            "```sh\ntest -s b.png && test \"$x\" = a.json && ls pellucid/page.md\n```\n"
            "<!-- not run: because -->\n```sh\nfalse\n```\n"
            "<!-- file: b.txt -->\n```text\nnot printed\n```\n")
        self.assertEqual(status, 0, said)
        self.assertIn("left out: because", said)
        self.assertIn(": cat <<'E'\nhere\nE\nhere\n", said)
        self.assertIn(": for i in 1 2; do\n  echo $i\ndone\n1\n2\n", said)

    def test_failing_command(self):
        self.assertEqual(self.run_page("```sh\npellucid fail\necho after\n```\n")[0], 1)
        self.assertEqual(self.run_page("```sh\nfalse | cat\n```\n")[0], 1)
        self.assertEqual(self.run_page("```sh\necho $undefined\n```\n")[0], 1)
        self.assertEqual(self.run_page("```sh\necho before\nif true; then\n```\n")[0], 1)

    def test_missing_output(self):
        status, said = self.run_page("```sh\npellucid silent -o x.png\n```\n")
        self.assertEqual(status, 1)
        self.assertIn("x.png was not written", said)

    def test_output_that_is_shown(self):
        command = "```sh\necho 'error 0.5 of 12 pixels; and more'\n```\n"
        self.assertEqual(self.run_page(
            command + "```text\nerror 1.25e-3 of 9 pixels … more\n```\n")[0], 0)
        status, said = self.run_page(command + "```text\nerror 0.5 of 12 points\n```\n")
        self.assertEqual(status, 1)
        self.assertIn("page.md:5: no command printed: error 0.5 of 12 points", said)

    def test_no_command(self):
        self.assertEqual(self.run_page("# Nothing\n")[0], 1)

    def test_files_that_are_not_here(self):
        status, said = self.run_page(
            "```sh\ncp /usr/share/mricron/none.nii.gz a.nii.gz\npellucid render -o b.png a.nii.gz\n"
            "pellucid compare -o c.png b.png\npellucid render -o d.png\n```\n")
        self.assertEqual(status, 0, said)
        self.assertEqual(said.count("left out"), 3, said)
        self.assertIn("page.md:5: pellucid render -o d.png", said)
        # A file that nothing makes is an error, and not left out.
        self.assertEqual(self.run_page("```sh\ncat none.nii.gz\n```\n")[0], 1)

    def test_python(self):
        status, said = self.run_page("```python\nimport sys\nprint(6 * 7)\n```\n"
                                     "```python\nimport no_such_module as a\nopen('a.npy')\n```\n"
                                     "```sh\ncat a.npy\n```\n")
        self.assertEqual(status, 0, said)
        self.assertIn("42", said)
        self.assertEqual(said.count("left out"), 2, said)
        self.assertEqual(self.run_page("```python\nraise ValueError\n```\n")[0], 1)


if __name__ == "__main__":
    unittest.main()

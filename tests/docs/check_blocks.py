#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the pages of a user show as code is code that a test compiles, parses or runs.

  check_blocks.py ROOT

The pages are README.md and those of docs/tutorial and docs/how-to. Of their blocks

  cpp, cmake   stand, line for line, in a file that tests/install compiles;
  json         parse, and hold against the schema of scenes where the word behind says what they
               are: scene, transfer_function, camera;
  sh, python   are run by run_blocks.py;
  text         are output, or files of other programs.

Every block has one of these languages. In the other pages, json parses as well.
"""
import json
import pathlib
import re
import sys

from documents import Page, repository_files, run_check

try:
    from jsonschema import Draft202012Validator
except ImportError:
    Draft202012Validator = None

LANGUAGES = {"cpp", "cmake", "json", "sh", "python", "text"}
SCHEMA = "docs/reference/scene.schema.json"


def is_user_page(name):
    return str(name) == "README.md" or str(name).startswith(("docs/tutorial/", "docs/how-to/"))


def compiled_texts(root):
    """The projects of tests/install, and the sources that they name."""
    lists = sorted((root / "tests" / "install").glob("*/CMakeLists.txt"))
    texts = {path: path.read_text(encoding="utf-8") for path in lists}
    for path, text in list(texts.items()):
        for source in re.findall(r"[\w./-]+\.cpp", text):
            texts[path.parent / source] = (path.parent / source).read_text(encoding="utf-8")
    return list(texts.values())


def schema_of(kind, schema):
    """The schema of a scene, or of the part of it that has this name; None where there is none."""
    if kind == "scene":
        return schema
    if kind in schema["$defs"]:
        return {"$schema": schema["$schema"], "$ref": f"#/$defs/{kind}", "$defs": schema["$defs"]}
    return None


def check_json(block, schema):
    def refuse(name):
        raise ValueError(f"{name} is not JSON")
    try:
        document = json.loads(block.text, parse_constant=refuse)
    except ValueError as error:
        yield f"is not JSON: {error}"
        return
    for kind in block.words:
        part = schema_of(kind, schema)
        if part is None:
            yield f"the schema of scenes has no {kind}"
        elif Draft202012Validator is not None:
            for error in Draft202012Validator(part).iter_errors(document):
                yield f"is no {kind}: {error.message[:200]}"


def check(root):
    schema = json.loads((root / SCHEMA).read_text(encoding="utf-8"))
    compiled = compiled_texts(root)
    shown = 0
    for name in repository_files(root):
        if name.suffix != ".md":
            continue
        for block in Page((root / name).read_text(encoding="utf-8")).blocks:
            place = f"{name}:{block.line}"
            if block.language == "json":
                for message in check_json(block, schema):
                    yield f"{place}: {message}"
            if not is_user_page(name):
                continue
            shown += 1
            if block.language not in LANGUAGES:
                yield f"{place}: a block of '{block.language}', which nothing checks"
            if block.language in ("cpp", "cmake") and not any(
                    block.text.strip() in text for text in compiled):
                yield f"{place}: stands in no file that tests/install compiles:\n{block.text}"
    if not shown:
        yield "no block of code was found"


if __name__ == "__main__":
    if Draft202012Validator is None:
        print("json is parsed, but not held against the schema: python3-jsonschema is missing")
    sys.exit(run_check(check(pathlib.Path(sys.argv[1]).resolve()), "every block is checked"))

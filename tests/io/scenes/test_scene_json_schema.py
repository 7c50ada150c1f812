# SPDX-License-Identifier: Apache-2.0
"""Holds docs/reference/scene.schema.json against the parser of scenes.

usage: test_scene_json_schema.py SOURCE_FOLDER VERDICTS

VERDICTS is what test_scene_json_schema.cpp wrote: one JSON object per line, {"document": text,
"accepted": whether the parser took it, "beyond_schema": whether it refused for a reason that JSON
Schema cannot express}. Exit code 77 where the module jsonschema is missing or too old for
draft 2020-12.
"""

import json
import pathlib
import sys

try:
    from jsonschema import Draft202012Validator, ValidationError, validators
except ImportError as error:
    print(f"skipped: {error} (Debian: python3-jsonschema)")
    sys.exit(77)


def refuse_constant(name):
    raise ValueError(f"{name} is not JSON")


def load(text):
    return json.loads(text, parse_constant=refuse_constant)


def remembering_validator(schema):
    """A validator that looks up what it has said of a value and a reference before.

    A mutant differs from others in one place: most of its parts have been seen.
    """
    verdicts = {}

    def ref(validator, target, instance, _):
        key = target, repr(instance)  # 1, 1.0 and True differ
        if key not in verdicts:
            part = schema
            for name in target.removeprefix("#/").split("/"):
                part = part[name]
            verdicts[key] = validator.evolve(schema=part).is_valid(instance)
        if not verdicts[key]:
            yield ValidationError(f"is not {target}")

    return validators.extend(Draft202012Validator, {"$ref": ref})(schema)


def described_everywhere(schema, path=""):
    """Yields the properties that have no description."""
    if isinstance(schema, dict):
        for key, value in schema.get("properties", {}).items():
            conditional = "/then" in path or "/else" in path or "/if" in path
            if not conditional and isinstance(value, dict):
                target = value.get("$ref", "").startswith("#/$defs/")
                if "description" not in value and not target:
                    yield f"{path}/{key}"
        for key, value in schema.items():
            yield from described_everywhere(value, f"{path}/{key}")
    elif isinstance(schema, list):
        for index, value in enumerate(schema):
            yield from described_everywhere(value, f"{path}/{index}")


def main():
    source, verdicts = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    schema = json.loads((source / "docs" / "reference"
                         / "scene.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    remembering = remembering_validator(schema)
    failures = [f"no description: {path}" for path in described_everywhere(schema)]

    scenes = source / "tests" / "io" / "scenes"
    for path in sorted([*(scenes / "valid").glob("*.json"), *(source / "examples").glob("*.json")]):
        for error in validator.iter_errors(load(path.read_text(encoding="utf-8"))):
            failures.append(f"{path.name}: valid, but the schema says: {error.message}")

    expected = json.loads((scenes / "expected_errors.json").read_text(encoding="utf-8"))
    for name, entry in expected.items():
        refused_by = entry["refused_by"]
        try:
            document = load((scenes / "invalid" / name).read_text(encoding="utf-8"))
        except (ValueError, RecursionError):
            if refused_by != "text":
                failures.append(f"{name}: is not JSON, but should be refused by {refused_by}")
            continue
        if refused_by == "text":
            failures.append(f"{name}: should not be JSON, but is")
        elif validator.is_valid(document) != (refused_by == "parser"):
            failures.append(f"{name}: should be refused by {refused_by}")

    counts = {True: 0, False: 0}
    for number, line in enumerate(verdicts.read_text(encoding="utf-8").splitlines()):
        verdict = json.loads(line)
        document = load(verdict["document"])
        accepted = remembering.is_valid(document)
        if number % 50 == 0 and validator.is_valid(document) != accepted:
            failures.append(f"what was remembered is wrong: {verdict['document']}")
        counts[accepted] += 1
        if verdict["beyond_schema"]:
            continue
        if accepted != verdict["accepted"]:
            failures.append(f"parser {verdict['accepted']}, schema {accepted}: "
                            f"{verdict['document']}")

    for failure in failures[:20]:
        print(failure)
    print(f"{len(expected)} invalid files; mutants: schema takes {counts[True]}, "
          f"refuses {counts[False]}; {len(failures)} disagreements")
    if counts[True] < 50 or counts[False] < 500:
        print("too few mutants on one side: the comparison says nothing")
        return 1
    return 1 if failures else 0


sys.exit(main())

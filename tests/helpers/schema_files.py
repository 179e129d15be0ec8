# SPDX-License-Identifier: Apache-2.0
"""The JSON schemas of the project, with which tests check what programs write.

Published schemas let reports have further keys. Here all objects are closed, so that a key that no schema describes is
a fault.
"""
import copy
import json

import jsonschema


def closed(schema):
    """Returns the schema with objects that have no keys but those that it describes."""
    if isinstance(schema, list):
        return [closed(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    result = {key: closed(part) for key, part in schema.items()}
    if "properties" in schema and "object" in schema.get("type", ()):
        result.setdefault("additionalProperties", False)
    return result


class SchemaFiles:
    """The schemas of a folder.

    seen  places of the keys that instances had, such as "report.schema.json#/frames/noise"
    """

    def __init__(self, folder):
        self.published = {path.name: json.loads(path.read_text()) for path in sorted(folder.glob("*.json"))}
        self.closed = {name: closed(schema) for name, schema in self.published.items()}
        self.seen = set()

    def faults(self, name, instance, is_closed=True):
        """Returns what is wrong with an instance: a text for each fault."""
        schemas = self.closed if is_closed else self.published
        file = f"{name}.schema.json"
        resolver = jsonschema.RefResolver(file, schemas[file], store=schemas)
        validator = jsonschema.Draft7Validator(schemas[file], resolver=resolver)
        faults = [f"{file}: {error.json_path}: {error.message[:300]}" for error in validator.iter_errors(instance)]
        if not faults:
            self._see(file, schemas[file], "", instance)
        return faults

    def _resolved(self, file, schema):
        while "$ref" in schema:
            target, _, pointer = schema["$ref"].partition("#/definitions/")
            file = target or file
            schema = self.closed[file]["definitions"][pointer] if pointer else self.closed[file]
        return file, schema

    def _see(self, file, schema, place, instance):
        """Adds the keys of an instance to `seen`."""
        referred, resolved = self._resolved(file, schema)
        if "$ref" in schema and not schema["$ref"].startswith("#"):
            place = ""
        for part in resolved.get("anyOf", ()):
            self._see(referred, part, place, instance)
        if isinstance(instance, dict):
            for key, value in instance.items():
                if key in resolved.get("properties", ()):
                    self.seen.add(f"{referred}#{place}/{key}")
                    self._see(referred, resolved["properties"][key], f"{place}/{key}", value)
        if isinstance(instance, list) and isinstance(resolved.get("items"), dict):
            for value in instance:
                self._see(referred, resolved["items"], place, value)

    def described(self, name):
        """Returns the places of all keys that a schema describes itself."""
        places = set()

        def add(schema, place):
            if schema.get("$ref", "#").startswith("#"):
                _, resolved = self._resolved(f"{name}.schema.json", schema)
                for part in resolved.get("anyOf", ()):
                    add(part, place)
                for key, part in resolved.get("properties", {}).items():
                    places.add(f"{name}.schema.json#{place}/{key}")
                    add(part, f"{place}/{key}")
                if isinstance(resolved.get("items"), dict):
                    add(resolved["items"], place)

        add(self.published[f"{name}.schema.json"], "")
        return places


def properties_of(schema, root=None):
    """Yields (key, description of the key) of all objects that a schema describes."""
    root = root or schema
    if isinstance(schema, list):
        for part in schema:
            yield from properties_of(part, root)
    if not isinstance(schema, dict):
        return
    if "object" in schema.get("type", ()):
        for key, part in schema.get("properties", {}).items():
            name = part.get("$ref", "").removeprefix("#/definitions/")
            yield key, part.get("description", root.get("definitions", {}).get(name, {}).get("description", ""))
    for part in schema.values():
        yield from properties_of(part, root)


def without(schema, key):
    """Returns a copy of a schema that does not describe a key of its top level."""
    copied = copy.deepcopy(schema)
    del copied["properties"][key]
    copied["required"] = [name for name in copied.get("required", ()) if name != key]
    return copied

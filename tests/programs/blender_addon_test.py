#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests what the add-on of Blender promises to versions of Blender that are not here: its manifest by the documented
rules of extensions, and by Blender itself if it is new enough; and F-curves in objects that are shaped like Blender's.

usage: blender_addon_test.py [TEST...]
"""
import ast
import re
import subprocess
import sys
import tomllib
import unittest
from types import SimpleNamespace

from blender_run import BLENDER, ROOT

FOLDER = ROOT / "blender" / "lfrendertools_blender"
sys.path.insert(0, str(FOLDER))
from curves import fcurves_of

REQUIRED = {"schema_version", "id", "version", "name", "tagline", "maintainer", "type", "blender_version_min",
            "license"}
OPTIONAL = {"blender_version_max", "website", "copyright", "permissions", "tags", "platforms", "wheels", "build"}
# Tags of add-ons, from the page "Extensions Tags" of Blender's manual.
TAGS = {"3D View", "Add Curve", "Add Mesh", "Animation", "Bake", "Camera", "Compositing", "Development", "Game Engine",
        "Geometry Nodes", "Grease Pencil", "Import-Export", "Lighting", "Material", "Modeling", "Mesh", "Node",
        "Object", "Paint", "Pipeline", "Physics", "Render", "Rigging", "Scene", "Sculpt", "Sequencer", "System",
        "Text Editor", "Tracking", "User Interface", "UV"}
PERMISSIONS = {"files", "network", "clipboard", "camera", "microphone"}


def faults_of(manifest):
    """Returns the faults of a manifest of an add-on, by the page "How to Create Extensions" of Blender's manual."""
    faults = [f"{key}: is missing" for key in sorted(REQUIRED - manifest.keys())]
    faults += [f"{key}: is no key of a manifest" for key in sorted(manifest.keys() - REQUIRED - OPTIONAL)]
    if faults:
        return faults
    if not re.fullmatch(r"[a-z]\w*", manifest["id"], re.ASCII) or "__" in manifest["id"]:
        faults.append(f"id: {manifest['id']}: expected a name of lower case letters")
    for key in ("schema_version", "version", "blender_version_min"):
        if not re.fullmatch(r"\d+\.\d+\.\d+", manifest[key]):
            faults.append(f"{key}: {manifest[key]}: expected three numbers")
    short = {"tagline": manifest["tagline"],
             **{f"permissions.{key}": words for key, words in manifest.get("permissions", {}).items()}}
    for key, words in short.items():
        if not 0 < len(words) <= 64 or words != words.strip() or not (words[-1].isalnum() or words[-1] in ")]}"):
            faults.append(f"{key}: expected at most 64 characters without a full stop at the end")
    faults += [f"permissions.{key}: is unknown" for key in manifest.get("permissions", {}).keys() - PERMISSIONS]
    faults += [f"tags: {tag}: is no tag of add-ons" for tag in manifest.get("tags", []) if tag not in TAGS]
    if manifest["type"] != "add-on":
        faults.append("type: expected add-on")
    if not manifest["license"] or not all(words.startswith("SPDX:") for words in manifest["license"]):
        faults.append("license: expected names that begin with SPDX:")
    return faults


class ManifestTest(unittest.TestCase):
    def setUp(self):
        self.manifest = tomllib.loads((FOLDER / "blender_manifest.toml").read_text())

    def test_the_manifest_follows_the_rules(self):
        self.assertEqual(faults_of(self.manifest), [])
        self.assertEqual(self.manifest["id"], FOLDER.name)
        self.assertGreaterEqual(tuple(map(int, self.manifest["blender_version_min"].split("."))), (4, 2, 0))

    def test_the_rules_find_faults(self):
        for changes, words in (({"id": "Lf-render"}, "id"), ({"tagline": "Ends with a stop."}, "tagline"),
                               ({"tagline": "x" * 65}, "tagline"), ({"tags": ["Photography"]}, "tags: Photography"),
                               ({"permissions": {"disk": "Write"}}, "permissions.disk"), ({"licence": []}, "licence"),
                               ({"license": ["Apache-2.0"]}, "license"), ({"version": "1.0"}, "version")):
            faults = faults_of({**self.manifest, **changes})
            self.assertEqual(len(faults), 1, faults)
            self.assertTrue(faults[0].startswith(words), faults)
        del self.manifest["tagline"]
        self.assertEqual(faults_of(self.manifest), ["tagline: is missing"])

    def test_the_manifest_says_what_older_blenders_read(self):
        tree = ast.parse((FOLDER / "__init__.py").read_text())
        info = next(ast.literal_eval(node.value) for node in tree.body
                    if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info")
        self.assertEqual(".".join(map(str, info["version"])), self.manifest["version"])
        self.assertEqual((info["name"], info["author"]), (self.manifest["name"], self.manifest["maintainer"]))

    def test_blender_accepts_the_manifest(self):
        said = subprocess.run([BLENDER, "--version"], capture_output=True, text=True).stdout if BLENDER else ""
        version = tuple(map(int, re.findall(r"\d+", said)[:2])) if said else (0, 0)
        if version < (4, 2):
            self.skipTest(f"needs Blender 4.2 or later, found {'.'.join(map(str, version)) if said else 'none'}")
        done = subprocess.run([BLENDER, "--command", "extension", "validate", FOLDER], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class LayeredAction:
    """An action as of Blender 5: layers of strips, with a channelbag for each slot, and no fcurves."""

    class Strip:
        def __init__(self, bags):
            self.bags = bags

        def channelbag(self, slot):
            return self.bags.get(slot)

    def __init__(self, *layers):
        self.layers = [SimpleNamespace(strips=[self.Strip(bags) for bags in strips]) for strips in layers]


class CurvesTest(unittest.TestCase):
    def bag(self, *curves):
        return SimpleNamespace(fcurves=list(curves))

    def test_actions_without_slots(self):
        action = SimpleNamespace(fcurves=["location", "lens"])
        self.assertEqual(fcurves_of(SimpleNamespace(action=action)), ["location", "lens"])

    def test_layered_actions_give_the_curves_of_the_slot_alone(self):
        action = LayeredAction([{"camera": self.bag("x", "y"), "cube": self.bag("z")}], [{"camera": self.bag("lens")}])
        self.assertFalse(hasattr(action, "fcurves"))
        self.assertEqual(fcurves_of(SimpleNamespace(action=action, action_slot="camera")), ["x", "y", "lens"])
        self.assertEqual(fcurves_of(SimpleNamespace(action=action, action_slot="cube")), ["z"])
        self.assertEqual(fcurves_of(SimpleNamespace(action=action, action_slot="light")), [])

    def test_data_without_animation_has_no_curves(self):
        for animation in (None, SimpleNamespace(action=None), SimpleNamespace(action=None, action_slot=None),
                          SimpleNamespace(action=LayeredAction(), action_slot=None)):
            self.assertEqual(fcurves_of(animation), [])

    def test_nothing_else_in_the_addon_asks_for_what_blender_5_lacks(self):
        for file in sorted(FOLDER.glob("*.py")):
            if file.name == "curves.py":
                continue
            for word in (".fcurves", ".node_tree", ".sequences", ".use_nodes", "action.groups"):
                self.assertNotIn(word, file.read_text(), f"{file.name}: {word} is gone or deprecated in Blender 5")


if __name__ == "__main__":
    unittest.main()

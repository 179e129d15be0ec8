# SPDX-License-Identifier: Apache-2.0
"""Checks includes, for check_house.py: a folder of lf/ includes only what its lf_folder(... DEPENDS ...) allows, a
third-party header is included only in the folders that own it, nothing in lf/ or python/ includes tools/ or tests/,
nothing but tools/ includes CLI11, and rooms do not depend on each other in a cycle. A room is a folder directly in lf/,
with the folders inside it. No CMakeLists.txt outside of tools/ links CLI11 or compiles a source of tools/.
"""
import re

import folder_list
from folder_list import room_of

# Third-party headers, and the only folders that may include them (doc/design.md, "Dependencies").
OWNERS = {
    "OpenEXR/": {"pixels/files"},
    "OpenColorIO/": {"film/develop"},
    "png.h": {"pixels/files"},
    "tiff": {"pixels/files"},
    "jpeglib.h": {"pixels/files"},
    "jerror.h": {"pixels/files"},
    "lcms2.h": {"pixels/files"},
    "webp/": {"pixels/files"},
    "openjpeg.h": {"pixels/files"},
    "jxl/": {"pixels/files"},
    "libheif/": {"pixels/files"},
    "hdf5.h": {"pixels/files"},
    "yaml-cpp/": {"camera/path"},
    "nlohmann/": {"camera/path", "densify", "distribute/compress", "distribute/preprocess", "film/compare",
                  "import/exports", "import/formats", "import/report", "light_field/transforms_json", "render/state"},
    "pugixml": {"import/exports"},
    "simdjson": {"light_field/transforms_json"},
    "tbb/": {"core"},
    "hwy/": {"pixels/codec", "pixels/prediction", "collection", "collection/prefilter", "densify", "rebinning",
             "storage/load", "analysis/depth"},
    "nanoflann": {"rebinning"},
    "zstd": {"pixels/codec", "film/plate"},
    "xxhash": {"core"},
    "unicode/": {"light_field/model"},
    "sqlite3": {"storage/sqlite"},
    "curl/": {"storage/remote"},
    "CLI/": set(),
    "microhttpd": set(),
}


# Folders beside lf/ and tools/ that have sources in C++.
OTHERS = ("python", "tests", "bench", "examples")
OF_COMMAND_LINES = re.compile(r"\bCLI11::|\btools/")

INCLUDE = re.compile(r'\s*#\s*include\s*[<"]([^>"]+)[>"]')


def folder_faults(folders):
    """Yields the faults of the lf_folder(...) calls: other paths than their own, and unknown folders in DEPENDS."""
    for folder, words in folders.items():
        named = " ".join(words.get("", ["no path"]))
        if named != folder:
            yield f"lf/{folder}/CMakeLists.txt: lf_folder names {named}, expected {folder}"
        for other in words.get("DEPENDS", ()):
            if other not in folders:
                yield f"lf/{folder}/CMakeLists.txt: DEPENDS names {other}, which is no folder of lf/"


def include_fault(folder, allowed, name):
    """Returns why a source of a folder must not include a name, or None."""
    if name.startswith(("tools/", "tests/")):
        return f"the library must not include {name}"
    if name.startswith("lf/") and name[len("lf/"):].rpartition("/")[0] not in allowed:
        return f"{folder} may not include {name}"
    for prefix, owners in OWNERS.items():
        if name.startswith(prefix) and folder not in owners:
            return f"<{name}> belongs to {sorted(owners) or 'tools'}"
    return None


def source_faults(root, source, folders):
    """Yields the faults of one source of lf/."""
    folder = source.parent.relative_to(root / "lf").as_posix()
    if folder == ".":  # lf/lfrendertools.h shows what lf/api offers
        folder = "api"
    if folder not in folders:
        yield f"{source.relative_to(root)}: no lf_folder(...) is beside it"
        return
    allowed = {folder, *folders[folder].get("DEPENDS", ())}
    for number, line in enumerate(source.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        fault = include_fault(folder, allowed, match.group(1)) if match else None
        if fault:
            yield f"{source.relative_to(root)}:{number}: {fault}"


def other_faults(root):
    """Yields the faults of the sources beside lf/ and tools/, and of what any folder but tools/ links and compiles."""
    for source in sorted(p for name in OTHERS for p in (root / name).rglob("*") if p.suffix in (".cc", ".h")):
        place = source.relative_to(root)
        for number, line in enumerate(source.read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            name = match.group(1) if match else ""
            if name.startswith("CLI/"):
                yield f"{place}:{number}: <{name}> belongs to tools"
            if place.parts[0] == "python" and name.startswith(("tools/", "tests/")):
                yield f"{place}:{number}: python stands on lf alone, and must not include {name}"
    for cmake in sorted(p for name in ("lf", *OTHERS) for p in (root / name).rglob("CMakeLists.txt")):
        for number, line in enumerate(cmake.read_text().splitlines(), 1):
            match = OF_COMMAND_LINES.search(line.partition("#")[0])
            if match:
                yield f"{cmake.relative_to(root)}:{number}: only tools may have {match.group().strip()}"


def reached_from(room, rooms):
    """Returns the rooms that a room depends on, directly or through others."""
    reached, open_rooms = set(), [room]
    while open_rooms:
        for other in rooms.get(open_rooms.pop(), ()):
            if other not in reached:
                reached.add(other)
                open_rooms.append(other)
    return reached


def room_faults(folders):
    """Yields a fault for each dependency that is part of a cycle of rooms."""
    arrows = sorted({(folder, other) for folder, words in folders.items() for other in words.get("DEPENDS", ())
                     if room_of(folder) != room_of(other)})
    rooms = {}
    for folder, other in arrows:
        rooms.setdefault(room_of(folder), set()).add(room_of(other))
    for folder, other in arrows:
        if room_of(folder) in reached_from(room_of(other), rooms):
            yield (f"lf/{folder}/CMakeLists.txt: DEPENDS {other} is part of a cycle: {room_of(other)} depends on "
                   f"{room_of(folder)}, directly or through other rooms")


def check_includes(root):
    """Yields the faults of all folders of lf/."""
    folders = folder_list.read_folders(root)
    yield from folder_faults(folders)
    yield from room_faults(folders)
    yield from other_faults(root)
    for source in sorted(path for path in (root / "lf").rglob("*") if path.suffix in (".cc", ".h")):
        yield from source_faults(root, source, folders)

#!/usr/bin/python3
"""Fails if a folder of lf/ includes what its lf_folder(... DEPENDS ...) does not allow, if a
third-party header is included outside the one folder that owns it, or if anything in lf/ includes
tools/ or tests/.

usage: check_includes.py REPOSITORY
"""
import pathlib
import re
import sys

# Third-party headers, and the only folders that may include them (doc/design.md, "Dependencies").
OWNERS = {
    "OpenImageIO/": {"imageio"},
    "jpeglib.h": {"imageio"},
    "jerror.h": {"imageio"},
    "yaml-cpp/": {"path"},
    "nlohmann/": {"calibration", "native", "record"},
    "simdjson": {"native"},
    "tbb/": {"core"},
    "hwy/": {"codec", "collection", "rebinning", "store"},
    "nanoflann": {"rebinning"},
    "zstd": {"codec", "plate"},
    "xxhash": {"core"},
    "sqlite3": {"database"},
    "CLI/": set(),
    "microhttpd": set(),
}


def folder_depends(cmake: str) -> set:
    words = re.search(r"lf_folder\((.*?)\)", cmake, re.S).group(1).split()
    depends, reading = set(), False
    for word in words[1:]:
        if word.isupper() or word in ("PUBLIC_LIBS", "TEST_LIBS"):
            reading = word == "DEPENDS"
        elif reading:
            depends.add(word)
    return depends


def main() -> int:
    root = pathlib.Path(sys.argv[1])
    faults = []
    files = 0
    for folder in sorted(p for p in (root / "lf").iterdir() if p.is_dir()):
        allowed = folder_depends((folder / "CMakeLists.txt").read_text()) | {folder.name}
        for source in sorted(folder.glob("*.cc")) + sorted(folder.glob("*.h")):
            files += 1
            for number, line in enumerate(source.read_text().splitlines(), 1):
                match = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
                if not match:
                    continue
                place, name = f"{source.relative_to(root)}:{number}", match.group(1)
                if name.startswith(("tools/", "tests/")):
                    faults.append(f"{place}: the library must not include {name}")
                if name.startswith("lf/") and name.split("/")[1] not in allowed:
                    faults.append(f"{place}: {folder.name} may not include {name}")
                for prefix, owners in OWNERS.items():
                    if name.startswith(prefix) and folder.name not in owners:
                        faults.append(f"{place}: <{name}> belongs to {sorted(owners) or 'tools'}")
    print("\n".join(faults) or f"{files} files, no forbidden include")
    return 1 if faults or files == 0 else 0


if __name__ == "__main__":
    sys.exit(main())

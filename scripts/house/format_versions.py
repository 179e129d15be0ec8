# SPDX-License-Identifier: Apache-2.0
"""The versions of the project's file formats, for the table of doc/formats/README.md that doc_tables.py makes."""
import re

# Each format: its name, its page as linked from doc/formats/, how a file states the version, the source that has the
# version, and the words before the number there.
FORMATS = [
    ("camera path", "path.md", "the key `format: lfpath {}`", "lf/camera/path/path_yaml.cc", '{"lfpath '),
    ("packed store", "packed_store.md", "`user_version` {}", "lf/storage/packed/packed_format.h",
     '{"packed store", 0x4C465053 /* "LFPS" */, '),
    ("shard of a packed store", "packed_store.md#shards", "`user_version` {}", "lf/storage/packed/packed_format.h",
     '{"shard of a packed store", 0x4C465348 /* "LFSH" */,'),
    ("encoded LF image", "lf_image.md", "the number {} behind `LFIM`", "lf/pixels/codec/code_head.cc",
     "constexpr uint64_t kVersion = "),
    ("package", "package.md", "`user_version` {}", "lf/render/package/package_format.h",
     '{"package", 0x4C465047 /* "LFPG" */, '),
    ("sensor plate", "plate.md", "the number {} behind `LFPLATE`", "lf/film/plate/plate_format.h",
     "constexpr uint32_t kVersion = "),
    ("sensor plate with gaps", "plate.md#gaps", "the number {} behind `LFPLATE`", "lf/film/plate/plate_format.h",
     "constexpr uint32_t kVersionWithGaps = "),
    ("rebinned rays", "rays.md", "the number {} behind `LFCELLS`", "lf/rebinning/ray_map_format.h", '{"LFCELLS\\n", '),
    ("kept pixels", "kept_pixels.md", "the number {} behind `LFPIXEL`", "lf/rebinning/kept_pixels_format.h",
     '{"LFPIXEL\\n", '),
    ("report of a render", "../checkpoints.md", '`"format": "lfreport {}"`', "lf/render/state/report.cc",
     '"lfreport '),
    ("job of `lfsubmit`", "../cluster.md", '`"format": "lfjob {}"`', "lf/distribute/cluster/job.cc", '"lfjob '),
]


def rows(root):
    """Yields the row of each format: name, version, and how its files state it."""
    for name, page, statement, source, words in FORMATS:
        found = re.search(re.escape(words) + r"\s*(\d+)", (root / source).read_text())
        if not found:
            raise ValueError(f"{source} has no version behind '{words}' (scripts/house/format_versions.py)")
        yield [f"[{name}]({page})", found[1], statement.format(found[1])]

# SPDX-License-Identifier: Apache-2.0
"""The common options, and the programs that offer them.

tests/programs/program_options_test.py compares the lists with the programs. scripts/doc_tables.py makes the table of
doc/design.md of them.
"""
# How a page shows each option, and the effect of the option.
COMMON = {
    "--threads": ("--threads N", "number of threads; 0: as many as the machine has. Results have the same bits for any "
                  "number"),
    "--seed": ("--seed N", "seed of random numbers: poses and noise (`lfsynth`); the order of the LF images, and which "
               "rays are rebinned (others)"),
    "--strict": ("--strict", "the first missing or broken LF image is an error (exit code 3)"),
    "--allow-missing": ("--allow-missing N|PERCENT", "accepts that up to N LF images are left out: exit code 0 instead "
                        "of 6 (`lfvisualizer`: only with `--export`)"),
    "--progress": ("--progress auto|bar|plain|json|none", "shows progress; auto: a bar on a terminal, else lines now "
                   "and then"),
    "--verbose": ("-v", "tells more: what was opened and how, the plan of the memory, passes, checkpoints, processes "
                  "that are started"),
    "--quiet": ("-q", "prints warnings and errors only"),
    "--json": ("--json", "prints the report to stdout as JSON"),
}
# The programs in the order of the data flow. A program has a common option only if the option has this effect:
#   --threads        the program has a thread pool, or passes the number to lfrenderer
#   --seed           sets poses and noise (lfsynth), the order of LF images, rebinned rays
#   --strict         a missing or broken LF image is an error
#   --progress       the work is long enough to be shown
#   --verbose        the program, or a library that it calls, has debugging messages
#   --quiet          the program has messages that are no warnings
#   --json           the program has a report
#   --allow-missing  the program may leave out requested LF images
OFFERED = {
    "lfsynth": {"--threads", "--seed", "--progress", "--quiet"},
    "lfimport": set(COMMON) - {"--seed"},
    "lfexample": {"--threads", "--verbose", "--quiet"},
    "lfcammvminfo": {"--quiet", "--json"},
    "lfpath": {"--verbose", "--quiet", "--json"},
    "lfpreprocessor": set(COMMON),
    "lfcompressor": set(COMMON) - {"--seed"},
    "lfdensify": set(COMMON) - {"--seed"},
    "lfrenderer": set(COMMON),
    # lfr and lffocus alone only list commands, whose options follow their names.
    "lfr": set(),
    "lffocus": set(),
    "lffocus stack": set(COMMON),
    "lffocus epi": set(COMMON) - {"--seed"},
    "lffocus views": set(COMMON) - {"--seed"},
    "lffocus depth": set(COMMON) - {"--seed"},
    "lffocus sharp": set(COMMON) - {"--seed"},
    "lffocus through": set(COMMON) - {"--seed"},
    # --allow-missing follows the two dashes, because it is an option of lfrenderer.
    "lfsubmit": set(COMMON) - {"--seed", "--allow-missing"},
    "lfmerge": set(COMMON) - {"--seed", "--strict"},
    "lfquilt": {"--threads", "--progress", "--quiet", "--json"},
    "lfcompare": {"--threads", "--progress", "--quiet", "--json"},
    "lfvisualizer": set(COMMON) - {"--strict", "--json"},
}

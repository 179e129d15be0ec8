// SPDX-License-Identifier: Apache-2.0
// The description of a program as JSON, which the hidden option --describe prints. Man pages,
// completion in shells and the reference page are made from it (scripts/program_pages).
//
// {
//   "format": "lfrendertools program 1",
//   "name": "lfrenderer",                  as it is called; "lffocus stack" for a command
//   "version": "0.1.0",
//   "summary": "Films a ...",              one sentence
//   "usage": ["lfrenderer LIGHTFIELD PATH -o DIR [OPTIONS]", ...],
//   "examples": ["lfrenderer capture/ path.yaml -o frames", ...],
//   "details": "DIR receives ...",         paragraphs of --help-all, separated by empty lines; a
//                                          line that begins with two spaces stays as it is
//   "exit_codes": "0 success, ...",        one sentence or two
//   "commands": [{"name": "stack",         first words that have an own description; may be empty
//                 "call": "lffocus stack",     the program or command that runs, with --describe
//                 "summary": "..."}],          empty if only its own description states it
//   "rest": {"program": "lfrenderer",      program whose options may follow "--"; null: none
//            "without": ["-o", ...]},      names of those of its options that are refused there
//   "groups": [{"name": "Input",           in the order of --help-all
//               "shown": true,             true if --help shows the group, too
//               "options": [...]}]         positional arguments first
// }
//
// An option or positional argument:
// {
//   "names": ["-o", "--output"],           ["LIGHTFIELD"] for a positional argument
//   "positional": false,
//   "placeholder": "DIR",                  "" for flags and positional arguments
//   "type": "text",                        flag, choice, whole number, number or text
//   "value_count": 1,                      values of one use: 0 for a flag, 3 for X Y Z
//   "repeats": false,                      true if any number of values may be given
//   "required": true,
//   "default": "0",                        "" if there is none
//   "default_means": "all",                "" if the default means what it says
//   "values": "0 to 512",                  allowed numbers, "" if not limited
//   "choices": [{"value": "auto", "meaning": "a bar on a terminal, otherwise plain"}],
//                                          empty if the value may be another text; the meaning is
//                                          "" if the help does not state it
//   "files": {"kinds": ["folder"],         kinds as in file_kinds.h; null if the option takes none
//             "extensions": [".lfp"],      empty: any
//             "folders": true},
//   "needs": ["--view"], "excludes": ["--packages"],
//   "summary": "Folder of the frames",     without the default
//   "details": ["..."]                     the lines of --help-all after the summary, without those
//                                          that tell the meanings of choices
// }
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/common/help.h"

namespace lf {

// The name of the hidden option.
inline constexpr const char* kDescribe = "--describe";

// Returns the description of a program, with a line break at its end.
std::string DescriptionOf(const CLI::App& app, const HelpTexts& texts,
                          const std::vector<CommandText>& commands);

}  // namespace lf

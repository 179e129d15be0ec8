// SPDX-License-Identifier: Apache-2.0
// Commands that reports and messages advise: the next step, and the same call with other options.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lf/core/shell_word.h"

namespace lf {

// Returns the command of a call again, with options added. A command line that ends with words
// after "--" keeps them last.
//   call     its words, the first of which is the program
//   added    put after the other options. An option without a value is not repeated if the call
//            has it; an option with values replaces those of the call
//   dropped  options without a value, which are left out
std::string SameCall(std::span<const std::string> call, const std::vector<std::string>& added,
                     const std::vector<std::string>& dropped = {});

// Keeps the words of the command line of this process. Program::Run() calls it.
void SetCallOfProgram(std::vector<std::string> words);
// Returns a function that repeats the call of this process with options added, as SameCall() does.
CallAgain CallOfProgram();

// Returns packages as words of a shell: as a pattern such as FOLDER/package-*.lfp if it matches
// them and no others, otherwise one by one.
std::string ShellPackages(const std::vector<std::string>& packages);

// Returns a name for an output that an advised command writes: the first of STEM.EXT, STEM-2.EXT,
// ... that does not exist or is empty.
std::string FreeName(const std::string& stem, const std::string& extension);

// Returns the line of a report that advises the next step: "next: lfrenderer ... -o frames". The
// folder is a FreeName().
//   input    words of a shell: LIGHTFIELD PATH, or packages
//   options  further options of lfrenderer, not quoted
std::string NextRender(const std::string& input, const std::vector<std::string>& options = {});

}  // namespace lf

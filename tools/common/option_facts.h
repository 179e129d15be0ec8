// SPDX-License-Identifier: Apache-2.0
// Facts about the options of a program, from which its help (help.h) and its description
// (describe.h) are made.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace lf {

using Options = std::vector<const CLI::Option*>;

// True if --help shows the group; --help-all shows all groups that have a name.
bool IsShownGroup(const std::string& group);
// Returns the names of the groups in the order in which they are shown.
//   is_all  includes the groups that only --help-all shows
std::vector<std::string> GroupsOf(const CLI::App& app, bool is_all);
// Returns the options of a group, positional arguments first.
Options InGroup(const CLI::App& app, const std::string& group);

// True if any number of values may be given.
bool Repeats(const CLI::Option& option);
// Returns "DIR" of "-o, --output DIR", and "" for a flag or a positional argument.
std::string PlaceholderOf(const CLI::Option& option);
// Returns the kind of the value: "flag", "choice", "whole number", "number" or "text".
std::string TypeOf(const CLI::Option& option);
// Returns "-o, --output DIR", or the name of a positional argument: "PACKAGE...".
std::string NamesOf(const CLI::Option& option);
// Returns the default of an option as the parser states it; "empty" for an empty list; "" for a
// flag, a positional argument, or if there is no default.
std::string DefaultOf(const CLI::Option& option);
// Returns what the default means, such as "(all)", if the summary ends with such words that are not
// the default itself; otherwise "".
std::string DefaultMeaningOf(const CLI::Option& option);
// Returns the summary of an option, followed by its default in parentheses, unless the summary ends
// with words in parentheses or the default is empty.
std::string SummaryOf(const CLI::Option& option);
// Returns the help of an option after its summary.
std::string DetailsOf(const CLI::Option& option);
// Returns the allowed numbers, such as "0 to 180", or "" if they are not limited.
std::string ValuesOf(const CLI::Option& option);
// Returns the words of which the value must be one; empty if it may be another text.
std::vector<std::string> ChoicesOf(const CLI::Option& option);
// Return the names of the options that this one needs, or that must not be given with it.
std::vector<std::string> NeedsOf(const CLI::Option& option);
std::vector<std::string> ExcludesOf(const CLI::Option& option);
// Returns the facts that the parser knows (whether the option is required, its default, its values,
// the options that it needs or excludes), such as "Default: 0 (all); values: 0 to 180; not with
// --packages".
std::string FactsOf(const CLI::Option& option);

}  // namespace lf

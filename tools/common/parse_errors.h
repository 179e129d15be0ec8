// SPDX-License-Identifier: Apache-2.0
// Messages about the words of a command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace lf {

// Returns the message of an error of CLI11. If a value is outside of its range or no number, or if
// an option has too few values, the message names the option, the value that was found and what is
// expected; other messages are those of CLI11.
//   argc, argv  the command line that was parsed
std::string ParseErrorText(const CLI::App& app, const CLI::ParseError& error, int argc,
                           const char* const* argv);

// Returns the message for the first option whose list has an empty part, such as --grid 5x5x; ""
// if there is none. CLI11 drops empty parts without an error.
std::string EmptyPartText(const CLI::App& app, int argc, const char* const* argv);

}  // namespace lf

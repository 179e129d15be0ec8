// SPDX-License-Identifier: Apache-2.0
// Makes the commands that messages advise, and quotes words that people paste into a shell.
//
// A command that a message advises is made by ShellCommand() and ends its line, after ": ". The
// test tests.advice finds such commands in what the programs print, and runs them.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lf {

// Returns the word; in single quotes if a shell would not read it literally.
std::string ShellWord(const std::string& word);

// Returns a file name as an argument of our programs, not quoted: "./" is put before a name that a
// program would take for an option or for a list in brackets.
std::string FileArgument(const std::filesystem::path& file);

// Returns the command of these words, the first of which is the name of a program.
std::string ShellCommand(std::span<const std::string> words);
inline std::string ShellCommand(const std::vector<std::string>& words) {
  return ShellCommand(std::span<const std::string>(words));
}

// Returns the command of the running call with options added, for messages.
using CallAgain = std::function<std::string(const std::vector<std::string>& added)>;

}  // namespace lf

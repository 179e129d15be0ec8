// Words for people to paste into a shell.
#pragma once

#include <string>

namespace lf {

// A word of a command line, quoted so that a shell takes it as it is.
std::string ShellWord(const std::string& word);

}  // namespace lf

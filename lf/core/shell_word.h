// Words for people to paste into a shell.
#pragma once

#include <string>

namespace lf {

// Returns the word, quoted if a shell would not take it as it is.
std::string ShellWord(const std::string& word);

}  // namespace lf

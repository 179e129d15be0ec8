// SPDX-License-Identifier: Apache-2.0
// Quotes words that people paste into a shell.
#pragma once

#include <string>

namespace lf {

// Returns the word; in single quotes if a shell would not read it literally.
std::string ShellWord(const std::string& word);

}  // namespace lf

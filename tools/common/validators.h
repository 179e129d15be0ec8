// SPDX-License-Identifier: Apache-2.0
// Checks of the words of options, which CLI11 calls while it reads a command line.
#pragma once

#include <CLI/CLI.hpp>

namespace lf {

// Accepts a decimal number from 0 to 2^64 - 1.
CLI::Validator WholeNumber();
// Accepts a word that is not empty.
CLI::Validator NotEmpty();

}  // namespace lf

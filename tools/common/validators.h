// SPDX-License-Identifier: Apache-2.0
// Checks of the words of options, which CLI11 calls while it reads a command line.
#pragma once

#include <CLI/CLI.hpp>

namespace lf {

// The three checks below are those of every option that holds numbers (OptionGroup::Add). Their
// messages are completed by ParseErrorText().
// Accepts a finite decimal number.
CLI::Validator Number();
// Accept a whole decimal number that fits into 64 bits, and remove its leading zeros, with which
// CLI11 would read an octal number.
CLI::Validator WholeNumber();
CLI::Validator WholeNumberFromZero();
// Accepts a rate, and turns a fraction such as 24000/1001 into a number; for transform().
CLI::Validator Rate();
// Accepts a word that is not empty.
CLI::Validator NotEmpty();

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Names of options and arguments in messages. Messages of the library name an option by its key,
// in braces, because the same option is --max-images on a command line and max_images= in Python:
//
//   {max_images}                           an option or argument
//   {mode rebin}                           with a value
//   {lfimport exclude}                     an option of a program, whatever the reader uses
//   {lfpreprocessor lens_weights none}     with a value
//
// A key consists of small letters, digits and underscores; the name of a program is "lf" and small
// letters. Other text in braces is no reference. Code that shows a message to a person must call
// Spelled() first.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace lf {

struct OptionReference {
  std::string_view key = {};    // "max_images"
  std::string_view value = {};  // "rebin"; "" if there is none
  bool is_heading = false;      // true if a colon follows, and then a text about the option
};

using Speller = std::function<std::string(const OptionReference&)>;

// Returns the text with its references to options replaced by what `spell` returns. References to
// options of programs are spelled as for a command line.
std::string Spelled(std::string_view text, const Speller& spell);

// Returns the text with its references spelled by the Speller of this process. Without one, they
// become keys without braces: "max_images", "mode rebin". Several threads may call this.
std::string Spelled(std::string_view text);

// Sets the Speller of this process. main() or a language binding must call this before other
// threads begin.
void SetSpeller(Speller spell);

// Returns an option as a command line has it: --max-images, or --mode rebin. It is the Speller of
// programs.
std::string CommandLineOption(const OptionReference& option);

}  // namespace lf

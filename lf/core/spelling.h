// SPDX-License-Identifier: Apache-2.0
// Names of options and arguments in messages. Messages of the library name an option by its key,
// in braces, because the same option is --max-images on a command line and max_images= in Python:
//
//   {max_images}                           an option or argument
//   {mode rebin}                           with a value
//   {lfimport exclude}                     an option of a program, whatever the reader uses
//   {lfpreprocessor lens_weights none}     with a value
//
// A key consists of small letters, digits and underscores; the name of a program of "lf" and small
// letters. Other text in braces is no reference. Whatever shows a message to a person spells it.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace lf {

struct OptionReference {
  std::string_view key = {};    // "max_images"
  std::string_view value = {};  // "rebin"; "" if there is none
  bool is_heading = false;      // true before a colon, behind which the text is about the option
};

using Speller = std::function<std::string(const OptionReference&)>;

// Returns the text with its references to options replaced by what `spell` returns. References to
// options of programs are spelled as for a command line.
std::string Spelled(std::string_view text, const Speller& spell);

// Returns the text as the readers of this process know options: as SetSpeller() has said; before,
// by their keys alone, such as "max_images" and "mode rebin". May be called by several threads.
std::string Spelled(std::string_view text);

// Sets how the readers of this process know options. For main(), and for the module of a language;
// to be called before other threads begin.
void SetSpeller(Speller spell);

// Returns an option as a command line has it: --max-images, or --mode rebin. It is the Speller of
// programs.
std::string CommandLineOption(const OptionReference& option);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Finds the known word that a misspelt word was meant to be.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace lf {

// Returns how many letters must be changed, added, left out or swapped with their neighbour to turn
// one word into the other (optimal string alignment).
size_t EditDistance(std::string_view a, std::string_view b);

// Returns the nearest of `words`; empty if even the nearest differs in more than a third of the
// letters of the longer word, or if `word` has more than 64 letters.
std::string NearestWord(std::string_view word, std::span<const std::string> words);

}  // namespace lf

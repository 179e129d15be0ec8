// SPDX-License-Identifier: Apache-2.0
#include "lf/core/spelling.h"

#include <algorithm>
#include <utility>

namespace lf {
namespace {

constexpr std::string_view kSmallLetters = "abcdefghijklmnopqrstuvwxyz";

bool IsKey(std::string_view word) {
  return !word.empty() && kSmallLetters.find(word[0]) != word.npos &&
         word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == word.npos;
}

bool IsProgram(std::string_view word) {
  return word.size() > 2 && word.starts_with("lf") &&
         word.find_first_not_of(kSmallLetters) == word.npos;
}

// Removes the text up to the first space, and this space, from `text`, and returns what was before.
std::string_view TakeWord(std::string_view* text) {
  const size_t size = std::min(text->find(' '), text->size());
  const std::string_view word = text->substr(0, size);
  text->remove_prefix(std::min(size + 1, text->size()));
  return word;
}

// Returns the text in braces as a reader should see it; "" if it is no reference.
std::string SpelledReference(std::string_view inside, bool is_heading, const Speller& spell) {
  const std::string_view word = TakeWord(&inside);
  if (IsProgram(word) && !inside.empty()) {
    const std::string_view key = TakeWord(&inside);
    return IsKey(key) ? std::string(word) + " " + CommandLineOption({key, inside}) : "";
  }
  return IsKey(word) ? spell({word, inside, is_heading}) : "";
}

// Returns the place of the brace that closes the one at `begin`, or npos.
size_t ClosingBrace(std::string_view text, size_t begin) {
  int depth = 0;
  for (size_t at = begin; at < text.size(); ++at) {
    depth += text[at] == '{' ? 1 : text[at] == '}' ? -1 : 0;
    if (depth == 0) return at;
  }
  return text.npos;
}

std::string PlainOption(const OptionReference& option) {
  std::string words(option.key);
  if (!option.value.empty()) words.append(" ").append(option.value);
  return words;
}

Speller& SpellerOfProcess() {
  static Speller speller = PlainOption;
  return speller;
}

}  // namespace

std::string Spelled(std::string_view text, const Speller& spell) {
  std::string spelled;
  for (size_t at = 0; at < text.size();) {
    const size_t begin = std::min(text.find('{', at), text.size());
    spelled += text.substr(at, begin - at);
    if (begin == text.size()) break;
    std::string words;
    const size_t end = ClosingBrace(text, begin);
    if (end != text.npos)
      words = SpelledReference(text.substr(begin + 1, end - begin - 1),
                               text.substr(end + 1).starts_with(':'), spell);
    at = words.empty() ? begin + 1 : end + 1;
    spelled += words.empty() ? "{" : words;
  }
  return spelled;
}

std::string Spelled(std::string_view text) { return Spelled(text, SpellerOfProcess()); }

void SetSpeller(Speller spell) { SpellerOfProcess() = std::move(spell); }

std::string CommandLineOption(const OptionReference& option) {
  if (option.key == "guard" && option.value == "off") return "--no-guard";
  std::string words = "--" + std::string(option.key == "max_angle_deg" ? "max-angle" : option.key);
  std::replace(words.begin(), words.end(), '_', '-');
  if (option.key == "output") words = "-o";
  return option.value.empty() ? words : words + " " + std::string(option.value);
}

}  // namespace lf

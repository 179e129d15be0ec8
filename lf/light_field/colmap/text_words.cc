// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/text_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "lf/core/parse_number.h"

namespace lf {
namespace {

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool EndsWord(char c) { return IsBlank(c) || c == '\n'; }

// Returns a word in the form in which messages show it: short, and without terminal control
// characters.
std::string Shown(std::string_view word) {
  constexpr size_t kLongest = 40;
  if (word.empty()) return "missing";
  std::string shown(word.substr(0, kLongest));
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return fmt::format("\"{}\"{}", shown, word.size() > kLongest ? "..." : "");
}

// True for each character that a line of numbers may contain: digits, signs, the decimal point,
// exponents, the letters of nan and inf, and commas between numbers.
constexpr std::array<bool, 256> kNumberCharacters = [] {
  std::array<bool, 256> table = {};
  for (const char c : std::string_view("0123456789+-.,eEnaifNAIF"))
    table[static_cast<unsigned char>(c)] = true;
  return table;
}();

}  // namespace

bool TextWords::NextLine() {
  if (line_number_ > 0) {
    for (;;) {
      const std::string_view window = stream_->Window();
      if (window.empty()) return false;
      const size_t end = window.find('\n');
      stream_->Skip(end == std::string_view::npos ? window.size() : end + 1);
      if (end != std::string_view::npos) break;
    }
  }
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (line_number_ == 0 && stream_->Window().starts_with(kByteOrderMark))
    stream_->Skip(kByteOrderMark.size());
  if (stream_->Window().empty()) return false;
  ++line_number_;
  return true;
}

bool TextWords::NextEntry() {
  while (NextLine()) {
    SkipBlanks();
    const std::optional<char> first = Peek();
    if (first && *first != '#') return true;
    if (first) NoteComment();
  }
  return false;
}

void TextWords::NoteComment() {
  if (Word() != "#" || Word() != "Number" || Word() != "of") return;
  Word();
  const std::string_view word = Word();
  uint64_t count = 0;
  if (std::from_chars(word.data(), word.data() + word.size(), count).ec == std::errc())
    announced_count_ = count;
}

std::optional<char> TextWords::Peek() {
  const std::string_view window = stream_->Window();
  if (window.empty() || window[0] == '\n') return std::nullopt;
  return window[0];
}

void TextWords::SkipBlanks() {
  for (std::optional<char> c = Peek(); c && IsBlank(*c); c = Peek()) stream_->Skip(1);
}

std::string_view TextWords::Word() {
  SkipBlanks();
  word_.clear();
  for (;;) {
    const std::string_view window = stream_->Window();
    const auto end = std::find_if(window.begin(), window.end(), EndsWord);
    const std::string_view part = window.substr(0, static_cast<size_t>(end - window.begin()));
    // The rest of a word that is too long is not looked for, because the word is wrong in any case.
    const bool is_whole = end != window.end() || window.empty() || word_.size() >= kMaxWordSize;
    if (!is_whole || !word_.empty())
      word_.append(part.substr(0, kMaxWordSize - std::min(word_.size(), kMaxWordSize)));
    stream_->Skip(part.size());
    if (!is_whole) continue;
    std::string_view word = word_.empty() ? part.substr(0, kMaxWordSize) : std::string_view(word_);
    if (word.ends_with(',')) word.remove_suffix(1);
    return word;
  }
}

std::string TextWords::Rest(size_t max_size) {
  SkipBlanks();
  std::string rest;
  while (Peek() && rest.size() <= max_size) {
    const std::string_view window = stream_->Window();
    std::string_view part = window.substr(0, std::min(window.find('\n'), window.size()));
    part = part.substr(0, max_size + 1 - rest.size());
    rest.append(part);
    stream_->Skip(part.size());
  }
  while (!rest.empty() && IsBlank(rest.back())) rest.pop_back();
  return rest;
}

std::optional<uint64_t> TextWords::SkipNumbers() {
  uint64_t word_count = 0;
  bool in_word = false, are_numbers = true;
  while (are_numbers && Peek()) {
    const std::string_view window = stream_->Window();
    size_t size = 0;
    for (; size < window.size() && window[size] != '\n'; ++size) {
      const bool is_blank = IsBlank(window[size]);
      are_numbers &= is_blank || kNumberCharacters[static_cast<unsigned char>(window[size])];
      word_count += !is_blank && !in_word;
      in_word = !is_blank;
    }
    stream_->Skip(size);
  }
  if (!are_numbers) return std::nullopt;
  return word_count;
}

Result<double> TextWords::Number(const char* name) {
  const std::string_view word = Word();
  const std::optional<double> value = ParseNumber(word);
  if (!value) return Fault(fmt::format("{} is {}: expected a finite number", name, Shown(word)));
  return *value;
}

Result<uint64_t> TextWords::Whole(const char* name, uint64_t max) {
  const std::string_view word = Word();
  const std::optional<uint64_t> value = ParseWhole<uint64_t>(word);
  if (!value || *value > max)
    return Fault(
        fmt::format("{} is {}: expected a whole number from 0 to {}", name, Shown(word), max));
  return *value;
}

Error TextWords::Fault(std::string_view message) const {
  if (Result<void> status = stream_->Status(); !status) return status.error();
  return InputError(fmt::format("{}:{}: {}", stream_->path().string(), line_number_, message));
}

}  // namespace lf

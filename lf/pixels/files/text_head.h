// SPDX-License-Identifier: Apache-2.0
// Reads the words and numbers at the start of a picture file. Internal to this folder.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lf {

// The start of a file, word by word. Comments from '#' to the end of a line are skipped.
class TextHead {
 public:
  explicit TextHead(std::string_view text) : text_(text) {}

  // Returns the next word; "" at the end of the text.
  std::string_view Word() {
    while (at_ < text_.size() && (IsBlank(text_[at_]) || text_[at_] == '#'))
      if (text_[at_++] == '#')
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    const size_t begin = at_;
    while (at_ < text_.size() && !IsBlank(text_[at_]) && text_[at_] != '#') ++at_;
    return text_.substr(begin, at_ - begin);
  }

  // Returns the next word as a number from 0 to `most`; none if it is another word.
  std::optional<int64_t> Integer(int64_t most) {
    const std::string_view word = Word();
    if (word.empty()) return std::nullopt;
    int64_t value = 0;
    for (const char c : word) {
      if (c < '0' || c > '9') return std::nullopt;
      value = 10 * value + (c - '0');
      if (value > most) return std::nullopt;
    }
    return value;
  }

  // Returns the rest of the line, without blanks around it, and moves behind its end.
  std::string_view Line() {
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    while (!line.empty() && IsBlank(line.front())) line.remove_prefix(1);
    while (!line.empty() && IsBlank(line.back())) line.remove_suffix(1);
    return line;
  }

  // Number of characters before the next one.
  size_t position() const { return at_; }

 private:
  static bool IsBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  std::string_view text_;
  size_t at_ = 0;
};

}  // namespace lf

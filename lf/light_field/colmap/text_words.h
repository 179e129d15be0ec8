// SPDX-License-Identifier: Apache-2.0
// Splits a text file into lines of words, block by block: lines may have any length. Used by the
// readers of models and camera paths.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"

namespace lf {

// Blanks, tabs and carriage returns separate words, of which each may end in a comma (kapture
// writes "1, 0.5, 2"); a line feed ends a line. A UTF-8 byte order mark at the start of the file,
// as Windows programs write it, is skipped.
class TextWords {
 public:
  static constexpr size_t kMaxWordSize = 1024;  // most bytes that Word() returns

  // `stream` must outlive this object.
  explicit TextWords(ByteStream* stream) : stream_(stream) {}

  // Moves to the next line, even if words of this line were not read. Returns false at the end of
  // the file.
  bool NextLine();
  // Moves to the next line that is not blank and not a comment (#...).
  bool NextEntry();
  // Returns the NUMBER in the last skipped comment "# Number of THINGS: NUMBER...", if there was
  // one.
  const std::optional<uint64_t>& announced_count() const { return announced_count_; }

  // Returns true if this line has no further word.
  bool AtLineEnd() {
    SkipBlanks();
    return !Peek();
  }
  // Returns the next word of this line without a comma at its end, or "" if there is none. If the
  // word is longer than kMaxWordSize, which no word of a model is, only its beginning is read and
  // returned, and the next call continues within the word. Valid until another function of this
  // object is called.
  std::string_view Word();
  // Returns the rest of this line without surrounding blanks. If it is longer than max_size,
  // returns its first max_size + 1 bytes.
  std::string Rest(size_t max_size);
  // Skips the rest of this line. Returns the number of its words; nullopt, before the end of the
  // line, if it contains a character that cannot be part of a number.
  std::optional<uint64_t> SkipNumbers();

  // Number() reads the next word as a finite number, Whole() as a whole number from 0 to max.
  // kInput if the word is missing or no such number; the message names the file, the line, and
  // `name` as the quantity that was expected.
  Result<double> Number(const char* name);
  Result<uint64_t> Whole(const char* name, uint64_t max);

  // Returns kInput with the file, this line and the message. If reading the file failed, returns
  // the error of the reading instead.
  Error Fault(std::string_view message) const;

 private:
  // Returns the next character of this line without removing it; nullopt at the end of the line.
  std::optional<char> Peek();
  void SkipBlanks();
  void NoteComment();

  ByteStream* stream_;
  uint64_t line_number_ = 0;  // number of this line, from 1; 0 before the first line
  std::optional<uint64_t> announced_count_;
  std::string word_;  // the current word, if it crosses the end of a block
};

}  // namespace lf

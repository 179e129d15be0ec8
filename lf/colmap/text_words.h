// A text file as lines of words, a block at a time: lines may be of any length. Internal to
// colmap.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"

namespace lf {

// Words are separated by blanks, tabs and carriage returns, lines end with a line feed.
class TextWords {
 public:
  static constexpr size_t kMaxWordSize = 1024;  // bytes; what is longer is cut

  // The stream must outlive it.
  explicit TextWords(ByteStream* stream) : stream_(stream) {}

  // To the next line, whatever the last one still holds. False at the end of the file.
  bool NextLine();
  // To the next line that holds something other than a comment (#...).
  bool NextEntry();
  // The number in a comment "# Number of THINGS: NUMBER..." that was passed on the way.
  const std::optional<uint64_t>& announced_count() const { return announced_count_; }

  // Whether this line holds no further word.
  bool AtLineEnd() {
    SkipBlanks();
    return !Peek();
  }
  // The next word of this line, "" at its end. Valid until the next call.
  std::string_view Word();
  // What is left of this line without the blanks around it, at most one byte more than max_size.
  std::string Rest(size_t max_size);
  // Skips the rest of this line. The number of its words; none if there is a character that no
  // number has.
  std::optional<uint64_t> SkipNumbers();

  // The next word as a number. kInput with file and line; `name` says what was expected.
  Result<double> Number(const char* name);  // finite
  Result<uint64_t> Whole(const char* name, uint64_t max);

  // An error at this line, or the failure to read it.
  Error Fault(std::string_view message) const;

 private:
  // The next character of this line, not taken; none at its end.
  std::optional<char> Peek();
  void SkipBlanks();
  void NoteComment();

  ByteStream* stream_;
  uint64_t line_number_ = 0;  // 0: before the first
  std::optional<uint64_t> announced_count_;
  std::string word_;  // where a word crosses blocks
};

}  // namespace lf

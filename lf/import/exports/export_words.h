// SPDX-License-Identifier: Apache-2.0
// Reads numbers of text files whose line breaks have no meaning. Internal to this folder.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"
#include "lf/light_field/colmap/text_words.h"

namespace lf {

// Words of a text, separated by blanks and line breaks. Lines that begin with # are comments.
class ExportWords {
 public:
  // `text` and `file` must outlive this object; `file` is for messages.
  ExportWords(std::string_view text, const std::filesystem::path& file)
      : stream_(text, file), words_(&stream_) {}

  // Moves to the next word; returns false at the end of the text.
  bool Advance() {
    while (!is_in_line_ || words_.AtLineEnd()) {
      if (!words_.NextEntry()) return false;
      is_in_line_ = true;
    }
    return true;
  }
  // Reads the next word, as a text of at most TextWords::kMaxWordSize bytes or as a number within
  // +-most. `name` tells what was expected. kInput at the end of the text.
  Result<std::string> Word(const char* name);
  Result<double> Number(const char* name, double most);
  Result<std::vector<double>> Numbers(const char* name, size_t count, double most);
  // Reads the rest of a line, which must hold `count` numbers within +-most. `names` lists them.
  Result<std::vector<double>> NumbersOfLine(const char* names, size_t count, double most);
  // Returns kInput with the file and the line.
  Error Fault(std::string_view message) const { return words_.Fault(message); }
  // The words of the current line.
  TextWords& line() { return words_; }

 private:
  ByteStream stream_;
  TextWords words_;
  bool is_in_line_ = false;
};

}  // namespace lf

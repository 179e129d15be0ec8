// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/raw_stream.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>

namespace lf {

RawStream::RawStream(const ByteSource& source, uint64_t size_bytes)
    : source_(source), size_bytes_(size_bytes) {}

bool RawStream::FillWindow() {
  constexpr size_t kWindowBytes = size_t{1} << 16;
  window_begin_ = Position();
  next_ = 0;
  const uint64_t rest = window_begin_ < size_bytes_ ? size_bytes_ - window_begin_ : 0;
  window_.resize(std::min<uint64_t>(rest, kWindowBytes));
  window_.resize(source_(window_begin_, window_));
  if (window_.empty()) NoteEnd();
  return !window_.empty();
}

int RawStream::read(void* to, size_t size, size_t count) {
  if (size == 0 || count == 0) return 0;
  const uint64_t rest = Position() < size_bytes_ ? size_bytes_ - Position() : 0;
  const size_t whole = static_cast<size_t>(std::min<uint64_t>(count, rest / size));
  // If an element ends beyond the file, its bytes are read but it is not counted, as in fread().
  const size_t wanted = whole == count ? size * count : static_cast<size_t>(rest);
  if (rest == 0) NoteEnd();
  auto* bytes = static_cast<uint8_t*>(to);
  const size_t here = std::min(wanted, window_.size() - next_);
  std::copy_n(window_.data() + next_, here, bytes);
  next_ += here;
  if (here == wanted) return static_cast<int>(whole);
  const size_t got = source_(Position(), std::span(bytes + here, wanted - here));
  window_begin_ = Position() + got;
  window_.clear();
  next_ = 0;
  return static_cast<int>((here + got) / size);
}

int RawStream::seek(INT64 offset, int whence) {
  if (on_next_seek_) std::exchange(on_next_seek_, {})();
  const INT64 from = whence == SEEK_SET   ? 0
                     : whence == SEEK_CUR ? static_cast<INT64>(Position())
                                          : static_cast<INT64>(size_bytes_);
  INT64 target = 0;
  if (__builtin_add_overflow(from, offset, &target) || target < 0) target = 0;
  const auto position = static_cast<uint64_t>(target);
  sought_beyond_end_ = position >= size_bytes_;
  if (position >= window_begin_ && position - window_begin_ <= window_.size()) {
    next_ = static_cast<size_t>(position - window_begin_);
  } else {
    window_begin_ = position;
    window_.clear();
    next_ = 0;
  }
  return 0;
}

char* RawStream::gets(char* line, int size) {
  if (size < 1) return nullptr;
  int length = 0;
  while (length < size - 1) {
    const int c = get_char();
    if (c < 0) break;
    line[length++] = static_cast<char>(c);
    if (c == '\n') break;
  }
  line[length] = 0;
  return length > 0 ? line : nullptr;
}

// Reads a number as fscanf() does, in the format "%d" or "%f"; LibRaw uses no others.
int RawStream::scanf_one(const char* format, void* value) {
  constexpr size_t kMostDigits = 24;
  std::string text;
  int c = get_char();
  while (c == ' ' || c == '\n' || c == '\t' || c == '\r') c = get_char();
  while (c > ' ' && text.size() < kMostDigits) {
    text += static_cast<char>(c);
    c = get_char();
  }
  if (text.empty()) return EOF;
  if (std::strcmp(format, "%d") == 0)
    *static_cast<int*>(value) = static_cast<int>(std::strtol(text.c_str(), nullptr, 10));
  else
    *static_cast<float*>(value) = std::strtof(text.c_str(), nullptr);
  return 1;
}

}  // namespace lf

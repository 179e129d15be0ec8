// SPDX-License-Identifier: Apache-2.0
// Gives LibRaw the bytes of a file. Internal to this folder.
#pragma once

#include <libraw/libraw.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "lf/pixels/files/image_probe.h"

namespace lf {

// A stream over `source`, which must outlive it. LibRaw may not notice that a file ends early;
// therefore the stream records reads beyond the end.
class RawStream final : public LibRaw_abstract_datastream {
 public:
  RawStream(const ByteSource& source, uint64_t size_bytes);

  // Returns true if LibRaw sought a position at or beyond the end of the file and then read there.
  // A decoder may read slightly beyond its last byte, but in a whole file it never seeks there.
  bool ReadBeyondEnd() const { return read_beyond_end_; }
  void ForgetReadBeyondEnd() { read_beyond_end_ = false; }

  // Calls `call` once, on the next seek.
  void OnNextSeek(std::function<void()> call) { on_next_seek_ = std::move(call); }

  int valid() override { return 1; }
  int read(void* to, size_t size, size_t count) override;
  int seek(INT64 offset, int whence) override;
  INT64 tell() override { return static_cast<INT64>(Position()); }
  INT64 size() override { return static_cast<INT64>(size_bytes_); }
  int get_char() override { return next_ < window_.size() || FillWindow() ? window_[next_++] : -1; }
  char* gets(char* line, int size) override;
  int scanf_one(const char* format, void* value) override;
  int eof() override { return Position() >= size_bytes_ ? 1 : 0; }
  void* make_jas_stream() override { return nullptr; }

 private:
  uint64_t Position() const { return window_begin_ + next_; }
  bool FillWindow();
  void NoteEnd() { read_beyond_end_ |= sought_beyond_end_; }

  const ByteSource& source_;
  uint64_t size_bytes_;
  std::vector<uint8_t> window_;  // bytes of the file from window_begin_ on
  uint64_t window_begin_ = 0;
  size_t next_ = 0;  // index in window_ of the next byte to read
  bool sought_beyond_end_ = false;
  bool read_beyond_end_ = false;
  std::function<void()> on_next_seek_;
};

}  // namespace lf

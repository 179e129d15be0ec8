// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/zlib_block.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>

namespace lf {
namespace {

constexpr size_t kHeaderBytes = 2, kChecksumBytes = 4;
// A stored block (RFC 1951, 3.2.4) has a header of kBlockHeaderBytes bytes and at most 65535 bytes
// of content.
constexpr size_t kBlockHeaderBytes = 5, kMostContent = 65535;

// Inflates a stream into one piece of memory after another.
class Inflater {
 public:
  explicit Inflater(std::span<const std::byte> from) : from_(from) {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  // Fills `to`, unless the stream ends earlier. Returns the number of bytes written.
  size_t Next(std::span<uint8_t> to) {
    stream_.next_out = to.data();
    stream_.avail_out = static_cast<uInt>(to.size());
    while (state_ == Z_OK) {
      Refill();
      state_ = inflate(&stream_, Z_NO_FLUSH);
      if (state_ == Z_MEM_ERROR) throw std::bad_alloc();
      if (stream_.avail_out == 0) break;
    }
    return to.size() - stream_.avail_out;
  }
  // True if the stream has ended and its checksum is right.
  bool is_at_end() const { return state_ == Z_STREAM_END; }
  const char* fault() const {
    if (state_ == Z_DATA_ERROR && stream_.msg != nullptr) return stream_.msg;
    return "deflate stream without an end";
  }
  uint32_t checksum() const { return static_cast<uint32_t>(stream_.adler); }

 private:
  void Refill() {
    if (stream_.avail_in > 0) return;
    const size_t count = std::min<size_t>(from_.size(), size_t{1} << 30);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(from_.data()));
    stream_.avail_in = static_cast<uInt>(count);
    from_ = from_.subspan(count);
  }

  std::span<const std::byte> from_;
  z_stream stream_{};
  int state_ = Z_OK;
};

void PutBigEndian(uint32_t value, uint8_t* to) {
  for (int i = 0; i < 4; ++i) to[i] = static_cast<uint8_t>(value >> (24 - 8 * i));
}

void PutBlockHeader(size_t size, bool is_last, uint8_t* to) {
  to[0] = is_last ? 1 : 0;
  to[1] = static_cast<uint8_t>(size & 255);
  to[2] = static_cast<uint8_t>(size >> 8);
  to[3] = static_cast<uint8_t>(~to[1]);
  to[4] = static_cast<uint8_t>(~to[2]);
}

}  // namespace

const char* ZlibBlock::Inflate(std::span<const std::byte> stream, size_t size) {
  const size_t blocks = (size + kMostContent - 1) / kMostContent;
  stored_.resize(kHeaderBytes + blocks * kBlockHeaderBytes + size + kChecksumBytes);
  stored_[0] = 0x78;  // deflate with a window of 32 KiB
  stored_[1] = 0x01;
  Inflater inflater(stream);
  uint8_t* to = stored_.data() + kHeaderBytes;
  for (size_t done = 0; done < size;) {
    const size_t count = std::min(size - done, kMostContent);
    PutBlockHeader(count, done + count == size, to);
    if (inflater.Next({to + kBlockHeaderBytes, count}) < count)
      return inflater.is_at_end() ? "deflate stream that is too short" : inflater.fault();
    to += kBlockHeaderBytes + count;
    done += count;
  }
  PutBigEndian(inflater.checksum(), to);

  // Bytes beyond the first `size` are inflated only because the checksum covers them.
  const size_t most_excess = size + (size_t{1} << 20);
  std::array<uint8_t, 4096> excess;
  for (size_t count = 0; !inflater.is_at_end();) {
    const size_t more = inflater.Next(excess);
    count += more;
    if (more < excess.size() && !inflater.is_at_end()) return inflater.fault();
    if (count > most_excess) return "deflate stream that is too long";
  }
  return nullptr;
}

}  // namespace lf

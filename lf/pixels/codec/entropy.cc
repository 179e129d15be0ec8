// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/entropy.h"

#include <zstd.h>

#include <memory>
#include <new>

#include "lf/core/check.h"

namespace lf {
namespace {

struct Free {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

// Returns a compressor that the thread reuses, because making one takes longer than compressing a
// small tile.
ZSTD_CCtx* Compressor() {
  static thread_local std::unique_ptr<ZSTD_CCtx, Free> context;
  if (context) return context.get();
  context.reset(ZSTD_createCCtx());
  if (!context) throw std::bad_alloc();
  // No length of the content and no checksum is written: the reader knows the length, and the
  // packed store has a checksum.
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_contentSizeFlag, 0);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kEntropyLevel);
  // Packed coefficients repeat only by chance, except for runs of zeros. The less zstd searches for
  // repetitions, the shorter the output is, and the faster it is decoded.
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_minMatch, 7);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_hashLog, 6);
  return context.get();
}

ZSTD_DCtx* Decompressor() {
  static thread_local std::unique_ptr<ZSTD_DCtx, Free> context;
  if (!context) context.reset(ZSTD_createDCtx());
  if (!context) throw std::bad_alloc();
  return context.get();
}

}  // namespace

void AppendCompressed(std::span<const uint8_t> bytes, std::string* code) {
  const size_t begin = code->size(), bound = ZSTD_compressBound(bytes.size());
  code->resize(begin + bound);
  const size_t size =
      ZSTD_compress2(Compressor(), code->data() + begin, bound, bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();  // `bound` bytes always suffice
  code->resize(begin + size);
}

bool Decompress(std::string_view code, std::span<uint8_t> bytes) {
  return ZSTD_decompressDCtx(Decompressor(), bytes.data(), bytes.size(), code.data(),
                             code.size()) == bytes.size();
}

void AppendNumber(uint64_t number, std::string* code) {
  for (; number >= 0x80; number >>= 7) code->push_back(static_cast<char>(number | 0x80));
  code->push_back(static_cast<char>(number));
}

bool TakeNumber(std::string_view* code, uint64_t limit, uint64_t* number) {
  *number = 0;
  for (int shift = 0; shift < 64 && !code->empty(); shift += 7) {
    const auto byte = static_cast<uint8_t>(code->front());
    code->remove_prefix(1);
    *number |= uint64_t{byte & 0x7fu} << shift;
    if (byte < 0x80) return *number <= limit;
  }
  return false;
}

void AppendSigned(int64_t number, std::string* code) {
  AppendNumber((static_cast<uint64_t>(number) << 1) ^ static_cast<uint64_t>(number >> 63), code);
}

bool TakeSigned(std::string_view* code, int64_t* number) {
  uint64_t folded = 0;
  if (!TakeNumber(code, UINT64_MAX, &folded)) return false;
  *number = static_cast<int64_t>((folded >> 1) ^ (0 - (folded & 1)));
  return true;
}

bool TakeBytes(std::string_view* code, size_t count, std::string_view* bytes) {
  if (code->size() < count) return false;
  *bytes = code->substr(0, count);
  code->remove_prefix(count);
  return true;
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "lf/pixels/files/libtiff_handle.h"
#include "lf/pixels/files/picture_decoder.h"
#include "lf/pixels/files/tiff_layout.h"
#include "lf/pixels/files/tiff_samples.h"
#include "lf/pixels/files/zlib_block.h"

namespace lf {
namespace {

bool IsDeflate(int compression) {
  return compression == COMPRESSION_ADOBE_DEFLATE || compression == COMPRESSION_DEFLATE;
}

bool IsFax(int compression) {
  return compression == COMPRESSION_CCITTRLE || compression == COMPRESSION_CCITTRLEW ||
         compression == COMPRESSION_CCITTFAX3 || compression == COMPRESSION_CCITTFAX4;
}

// Returns the largest ratio of the bytes of a block to its compressed bytes; 0 if unknown.
uint64_t LargestRatio(const TiffLayout& layout) {
  constexpr uint64_t kDeflate = 1032, kLzw = 4096, kPackBits = 64, kRowsOfFaxByte = 8;
  if (IsDeflate(layout.compression)) return kDeflate;
  if (IsFax(layout.compression)) return kRowsOfFaxByte * layout.row_bytes();
  if (layout.compression == COMPRESSION_NONE) return 1;
  if (layout.compression == COMPRESSION_LZW) return kLzw;
  return layout.compression == COMPRESSION_PACKBITS ? kPackBits : 0;
}

// A strip or tile: its number in the file, and its pixels that lie in the picture.
struct Block {
  uint32_t index = 0;
  int plane = 0;
  PixelRect rect;
  size_t bytes = 0;  // size after decoding; the last strip may be smaller
};

class TiffDecoder : public PictureDecoder {
 public:
  TiffDecoder(const FileBytes& file, std::unique_ptr<LibtiffHandle> handle, TiffLayout layout)
      : file_(file), handle_(std::move(handle)), layout_(std::move(layout)) {
    const int bits = layout_.palette.empty() ? StoredBitsOf(layout_.type) : 8;
    info_ = {layout_.width, layout_.height,        layout_.channels(),  bits,
             bits == 32,    layout_.channel_names, layout_.orientation, {}};
  }
  const ImageFileInfo& info() const override { return info_; }
  std::string IccProfile() const override {
    uint32_t size = 0;
    const void* bytes = nullptr;
    if (TIFFGetField(handle_->tiff(), TIFFTAG_ICCPROFILE, &size, &bytes) != 1) return "";
    return {static_cast<const char*>(bytes), size};
  }
  Result<void> Read(StoredImage* image) override {
    LF_RETURN_IF_ERROR(CheckBlocksLieInFile());
    const auto resized = [&]<class T>(T) -> Image<T>& {
      return Resized<T>(info_.width, info_.height, info_.channels, image);
    };
    if (!layout_.palette.empty()) return ReadIndices(&resized(uint8_t{}));
    if (info_.bits == 8) return ReadValues(&resized(uint8_t{}));
    if (info_.bits == 16) return ReadValues(&resized(uint16_t{}));
    return ReadValues(&resized(float{}));
  }

 private:
  Block BlockAt(uint32_t index) const;
  Result<void> CheckBlocksLieInFile() const;
  template <class Use>
  Result<void> ForEachBlock(const Use& use);
  template <class T>
  Result<void> ReadValues(Image<T>* image);
  template <class T>
  void Place(const Block& block, Image<T>* image) const;
  Result<void> ReadIndices(Image<uint8_t>* image);
  Result<void> ReadBlock(const Block& block, std::byte* to);
  Result<void> ReadDeflated(const Block& block, std::byte* to);
  Result<void> ReadFax(const Block& block, std::byte* to);
  bool Decode(const Block& block, std::byte* to) const;
  bool HasSamePixels(const std::byte* a, const std::byte* b, size_t bytes) const;

  const FileBytes& file_;
  std::unique_ptr<LibtiffHandle> handle_;
  TiffLayout layout_;
  ImageFileInfo info_;
  std::vector<std::byte> decoded_;  // one decoded block
  // One block as stored in the file. In ReadFax(): the block decoded a second time, to compare.
  std::vector<std::byte> packed_;
  ZlibBlock zlib_;
};

Block TiffDecoder::BlockAt(uint32_t index) const {
  const uint32_t across = layout_.blocks_across(), down = layout_.blocks_down();
  const uint32_t in_plane = index % (across * down);
  const uint32_t x = in_plane % across * layout_.block_width;
  const uint32_t y = in_plane / across * layout_.block_height;
  Block block{index, static_cast<int>(index / (across * down)), {}, layout_.block_bytes()};
  const auto end = [](uint32_t begin, uint32_t size, int limit) {
    return static_cast<int>(
        std::min<uint64_t>(uint64_t{begin} + size, static_cast<uint64_t>(limit)));
  };
  block.rect = {static_cast<int>(x), static_cast<int>(y),
                end(x, layout_.block_width, layout_.width),
                end(y, layout_.block_height, layout_.height)};
  if (!layout_.is_tiled)
    block.bytes = layout_.row_bytes() * static_cast<uint64_t>(block.rect.height());
  return block;
}

template <class Use>
Result<void> TiffDecoder::ForEachBlock(const Use& use) {
  const auto count = static_cast<uint32_t>(layout_.block_count());  // as libtiff counts them
  for (uint32_t index = 0; index < count; ++index) LF_RETURN_IF_ERROR(use(BlockAt(index)));
  return {};
}

// Detects most truncated files, and files that claim more pixels than a file of their size can
// hold, before pixels are allocated.
Result<void> TiffDecoder::CheckBlocksLieInFile() const {
  const uint64_t ratio = LargestRatio(layout_);
  const auto count = static_cast<uint32_t>(layout_.block_count());  // as libtiff counts them
  for (uint32_t index = 0; index < count; ++index) {
    const Block block = BlockAt(index);
    const uint64_t offset = TIFFGetStrileOffset(handle_->tiff(), index);
    // libtiff reads no more bytes of an uncompressed block than its pixels need, even if the file
    // states a larger number.
    const uint64_t bytes = layout_.compression == COMPRESSION_NONE
                               ? block.bytes
                               : TIFFGetStrileByteCount(handle_->tiff(), index);
    if (offset > file_.size_bytes || bytes > file_.size_bytes - offset)
      return InputError(
          fmt::format("{}: truncated or damaged: {} {} of {} lies beyond the end of the file",
                      file_.name, layout_.is_tiled ? "tile" : "strip", index + 1, count));
    if (bytes == 0 || (ratio > 0 && block.bytes / ratio > bytes))
      return InputError(fmt::format(
          "{}: truncated or damaged: {} {} of {} has only {} bytes, too few for its pixels",
          file_.name, layout_.is_tiled ? "tile" : "strip", index + 1, count, bytes));
  }
  return {};
}

template <class T>
Result<void> TiffDecoder::ReadValues(Image<T>* image) {
  // Rows that are stored as the image stores them are decoded directly into the image.
  const bool in_place = !layout_.is_tiled && !layout_.is_separate && IsStoredAs<T>(layout_.type);
  return ForEachBlock([&](const Block& block) -> Result<void> {
    if (in_place) {
      LF_RETURN_IF_ERROR(
          ReadBlock(block, reinterpret_cast<std::byte*>(image->row(block.rect.y_begin))));
    } else {
      decoded_.resize(layout_.block_bytes());
      LF_RETURN_IF_ERROR(ReadBlock(block, decoded_.data()));
      Place(block, image);
    }
    if (!layout_.is_inverted || block.plane != 0) return {};
    for (int y = block.rect.y_begin; y < block.rect.y_end; ++y)
      for (int x = block.rect.x_begin; x < block.rect.x_end; ++x)
        image->at(x, y) = static_cast<T>(std::numeric_limits<T>::max() - image->at(x, y));
    return {};
  });
}

// Converts the decoded block to pixels of the image.
template <class T>
void TiffDecoder::Place(const Block& block, Image<T>* image) const {
  const int samples = layout_.samples_of_block();
  const size_t count = static_cast<size_t>(block.rect.width()) * static_cast<size_t>(samples);
  const auto step = static_cast<size_t>(layout_.is_separate ? info_.channels : 1);
  for (int y = block.rect.y_begin; y < block.rect.y_end; ++y) {
    const size_t row = static_cast<size_t>(y - block.rect.y_begin);
    ConvertSamples(layout_.type, decoded_.data() + row * layout_.row_bytes(), count,
                   &image->at(block.rect.x_begin, y, block.plane), step);
  }
}

Result<void> TiffDecoder::ReadIndices(Image<uint8_t>* image) {
  decoded_.resize(layout_.block_bytes());
  std::vector<uint16_t> indices(layout_.block_width);
  return ForEachBlock([&](const Block& block) -> Result<void> {
    LF_RETURN_IF_ERROR(ReadBlock(block, decoded_.data()));
    for (int y = block.rect.y_begin; y < block.rect.y_end; ++y) {
      const size_t row = static_cast<size_t>(y - block.rect.y_begin);
      const auto width = static_cast<size_t>(block.rect.width());
      UnpackIndices(layout_.type, decoded_.data() + row * layout_.row_bytes(), width,
                    indices.data());
      uint8_t* to = &image->at(block.rect.x_begin, y);
      for (size_t i = 0; i < width; ++i, to += 3)
        std::copy_n(layout_.palette.data() + size_t{3} * indices[i], 3, to);
    }
    return {};
  });
}

bool TiffDecoder::Decode(const Block& block, std::byte* to) const {
  const auto size = static_cast<tmsize_t>(block.bytes);
  return (layout_.is_tiled ? TIFFReadEncodedTile(handle_->tiff(), block.index, to, size)
                           : TIFFReadEncodedStrip(handle_->tiff(), block.index, to, size)) == size;
}

Result<void> TiffDecoder::ReadBlock(const Block& block, std::byte* to) {
  if (IsDeflate(layout_.compression)) return ReadDeflated(block, to);
  if (IsFax(layout_.compression)) return ReadFax(block, to);
  return handle_->Check(Decode(block, to));
}

// libtiff accepts a deflate stream that does not end where the block ends, as is the case for most
// damaged streams, and then does not verify the stream's checksum. The stream is therefore inflated
// by ZlibBlock, and libtiff does the rest (bit order, byte order and predictor) on a stream that is
// not compressed.
Result<void> TiffDecoder::ReadDeflated(const Block& block, std::byte* to) {
  TIFF* const tiff = handle_->tiff();
  packed_.resize(TIFFGetStrileByteCount(tiff, block.index));
  const auto size = static_cast<tmsize_t>(packed_.size());
  const tmsize_t read = layout_.is_tiled
                            ? TIFFReadRawTile(tiff, block.index, packed_.data(), size)
                            : TIFFReadRawStrip(tiff, block.index, packed_.data(), size);
  LF_RETURN_IF_ERROR(handle_->Check(read == size));
  uint16_t fill_order = FILLORDER_MSB2LSB;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_FILLORDER, &fill_order);
  const bool is_reversed = fill_order == FILLORDER_LSB2MSB;
  if (is_reversed) TIFFReverseBits(reinterpret_cast<uint8_t*>(packed_.data()), size);
  const char* const fault = zlib_.Inflate(packed_, block.bytes);
  if (fault != nullptr)
    return InputError(fmt::format("{}: truncated or damaged: {} in rows {} to {}", file_.name,
                                  fault, block.rect.y_begin, block.rect.y_end - 1));
  std::span<uint8_t> stored = zlib_.stored();
  const auto stored_size = static_cast<tmsize_t>(stored.size());
  if (is_reversed) TIFFReverseBits(stored.data(), stored_size);
  return handle_->Check(TIFFReadFromUserBuffer(tiff, block.index, stored.data(), stored_size, to,
                                               static_cast<tmsize_t>(block.bytes)) == 1);
}

// Returns true if the rows of two decoded blocks are equal, except for the bits behind the last
// pixel of a row, which libtiff does not write.
bool TiffDecoder::HasSamePixels(const std::byte* a, const std::byte* b, size_t bytes) const {
  const size_t row_bytes = layout_.row_bytes();
  const uint64_t bits = uint64_t{layout_.block_width} *
                        static_cast<uint64_t>(layout_.samples_of_block() * layout_.type.bits);
  const auto used_bits = std::byte{0xff} << static_cast<int>(8 * row_bytes - bits);
  for (size_t row = 0; row < bytes; row += row_bytes) {
    const size_t last = row + row_bytes - 1;
    if (!std::equal(a + row, a + last, b + row) || ((a[last] ^ b[last]) & used_bits) != std::byte{})
      return false;
  }
  return true;
}

// libtiff does not report that a CCITT stream ends before the block, and leaves the remaining bytes
// of the block as they are. The block is therefore decoded twice, over different bytes: bytes that
// differ afterwards were not decoded.
Result<void> TiffDecoder::ReadFax(const Block& block, std::byte* to) {
  packed_.assign(block.bytes, std::byte{0xff});
  LF_RETURN_IF_ERROR(handle_->Check(Decode(block, packed_.data())));
  std::fill_n(to, block.bytes, std::byte{0});
  LF_RETURN_IF_ERROR(handle_->Check(Decode(block, to)));
  if (HasSamePixels(packed_.data(), to, block.bytes)) return {};
  return InputError(
      fmt::format("{}: truncated or damaged: the compressed data of rows {} to {} end too early",
                  file_.name, block.rect.y_begin, block.rect.y_end - 1));
}

}  // namespace

Result<std::unique_ptr<PictureDecoder>> OpenTiff(const FileBytes& file) {
  LF_ASSIGN_OR_RETURN(std::unique_ptr<LibtiffHandle> handle, LibtiffHandle::OpenToRead(file));
  LF_ASSIGN_OR_RETURN(TiffLayout layout, TiffLayoutOf(handle->tiff(), file.name));
  LF_RETURN_IF_ERROR(handle->Check(true));
  return std::unique_ptr<PictureDecoder>(
      std::make_unique<TiffDecoder>(file, std::move(handle), std::move(layout)));
}

}  // namespace lf

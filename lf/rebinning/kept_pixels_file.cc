// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/kept_pixels_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "lf/core/check.h"
#include "lf/core/file.h"
#include "lf/film/plate/entry_file.h"
#include "lf/rebinning/kept_pixels_format.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// ray_map_file.cc, which is compiled together with this file, has its own kKind and BytesOf().
namespace layout = kept_pixels_format;
using layout::FileHead;
using layout::ImageHead;

// Size of the blocks that are hashed at the same time before they are written, or after they were
// read. They are still in the processor's cache then, and there is work for several threads.
constexpr uint64_t kTogetherBytes = uint64_t{8} << 20;

// The number of bytes that follow the head of a block.
struct BlockSizes {
  uint64_t masked;
  uint64_t places;
  uint64_t values;
  uint64_t depths;
  uint64_t all() const { return masked + places + values + depths; }
};

// Returns the sizes that a head states. Their sum does not overflow, whatever the head is: sides of
// depths above INT32_MAX count as this number, and are a fault (FaultOfDepths()).
BlockSizes SizesOf(const ImageHead& head) {
  const auto side = [](uint32_t size) { return uint64_t{std::min<uint32_t>(size, INT32_MAX)}; };
  return {head.mask_words * uint64_t{8}, head.pixel_count * uint64_t{4},
          head.pixel_count * 2 * layout::ValueCount(head),
          side(head.depth_width) * side(head.depth_height) * 2};
}

ImageHead HeadOf(const KeptImage& image) {
  ImageHead head = {};
  head.id = image.id.value;
  head.width_px = static_cast<uint32_t>(image.width_px);
  head.height_px = static_cast<uint32_t>(image.height_px);
  const PixelRect& rect = image.rect;
  const int ends[] = {rect.x_begin, rect.y_begin, rect.x_end, rect.y_end};
  for (size_t i = 0; i < 4; ++i) head.rect[i] = static_cast<uint32_t>(ends[i]);
  head.mask_words = static_cast<uint32_t>(image.masked.size());
  head.pixel_count = static_cast<uint32_t>(image.places.size());
  if (const Image<uint16_t>& numbers = image.depths.numbers; !numbers.empty()) {
    LF_CHECK(numbers.channels() == 1);
    head.depth_width = static_cast<uint32_t>(numbers.width());
    head.depth_height = static_cast<uint32_t>(numbers.height());
  }
  head.depth_divisor = static_cast<uint32_t>(image.depths.divisor);
  head.bayer = static_cast<uint16_t>(image.bayer);
  head.recorded = static_cast<uint16_t>(image.recorded);
  head.flags = (image.has_opacity ? ImageHead::kOpacity : 0) |
               (image.has_trust ? ImageHead::kTrust : 0) |
               (image.is_sparse ? ImageHead::kSparse : 0);
  head.depth_least = image.depths.least;
  head.depth_greatest = image.depths.greatest;
  return head;
}

// Writes head and content of an LF image; the sizes are those that the head states.
void WriteBlock(const ImageHead& head, const KeptImage& image, entry_file::OutputFile* file) {
  file->Write(&head, sizeof(head));
  file->Write(layout::BytesOf(image.masked));
  file->Write(layout::BytesOf(image.places));
  file->Write(layout::BytesOf(image.values));
  file->Write(layout::BytesOf(image.depths.numbers.pixels()));
}

Result<void> WriteBlocks(const fs::path& path, const PlateEntries& entries,
                         const KeptPixels& pixels, ThreadPool& pool) {
  std::vector<const KeptImage*> images;
  std::vector<ImageHead> heads;
  FileHead head = {};
  for (const auto& [id, image] : pixels.images()) {
    images.push_back(&image);
    heads.push_back(HeadOf(image));
    head.block_bytes += sizeof(ImageHead) + SizesOf(heads.back()).all();
  }
  head.limit = pixels.limit();
  head.image_count = images.size();
  head.pixel_count = pixels.size();
  entry_file::OutputFile file(path);
  file.Write(entry_file::FrontOf(
      layout::kKind, std::string(reinterpret_cast<const char*>(&head), sizeof(head)), entries));
  for (size_t first = 0, end = 0; first < images.size(); first = end) {
    for (uint64_t bytes = 0; end < images.size() && bytes < kTogetherBytes; ++end)
      bytes += sizeof(ImageHead) + SizesOf(heads[end]).all();
    pool.ForEach(end - first, [&](size_t i) {
      heads[first + i].hash = layout::HashOf(heads[first + i], *images[first + i]);
    });
    for (size_t i = first; i < end; ++i) WriteBlock(heads[i], *images[i], &file);
  }
  return file.Close();
}

struct Block {
  ImageHead head = {};
  KeptImage image;
};

// Returns the rectangle of a head. Must be called only after FaultOfFrame().
PixelRect RectOf(const ImageHead& head) {
  return {static_cast<int>(head.rect[0]), static_cast<int>(head.rect[1]),
          static_cast<int>(head.rect[2]), static_cast<int>(head.rect[3])};
}

// Each of these functions returns the first fault of a part of a block, without the name of its LF
// image; empty if there is none. The checksum of the block is right.
std::string FaultOfFrame(const ImageHead& head) {
  if (head.width_px == 0 || head.height_px == 0 || head.width_px > INT32_MAX ||
      head.height_px > INT32_MAX || uint64_t{head.width_px} * head.height_px > UINT32_MAX)
    return fmt::format("a size of {} x {} pixels, expected 1 to {} pixels", head.width_px,
                       head.height_px, UINT32_MAX);
  const auto& [x_begin, y_begin, x_end, y_end] = head.rect;
  if (x_begin > x_end || y_begin > y_end || x_end > head.width_px || y_end > head.height_px)
    return fmt::format("the pixels [{}, {}) x [{}, {}) are not in its {} x {} pixels", x_begin,
                       x_end, y_begin, y_end, head.width_px, head.height_px);
  constexpr auto kLast = static_cast<uint16_t>(BayerPattern::kGbrg);
  if (head.bayer > kLast || head.recorded > kLast)
    return fmt::format("the mosaic {}, recorded as {}, expected 0 to {}", head.bayer, head.recorded,
                       kLast);
  if (head.flags > ImageHead::kAllFlags)
    return fmt::format("the flags {}, expected 0 to {}", head.flags, ImageHead::kAllFlags);
  return {};
}

std::string FaultOfDepths(const ImageHead& head) {
  if (head.depth_divisor == 0 || head.depth_divisor > INT32_MAX ||
      !std::isfinite(head.depth_least) || !std::isfinite(head.depth_greatest))
    return fmt::format("depths from {} to {} with the divisor {}", head.depth_least,
                       head.depth_greatest, head.depth_divisor);
  if (head.depth_width == 0 && head.depth_height == 0) return {};
  const auto expected = [&head](uint32_t size_px) {
    return (uint64_t{size_px} + head.depth_divisor - 1) / head.depth_divisor;
  };
  if (head.depth_width == expected(head.width_px) && head.depth_height == expected(head.height_px))
    return {};
  return fmt::format("{} x {} depths, expected {} x {}", head.depth_width, head.depth_height,
                     expected(head.width_px), expected(head.height_px));
}

// Returns the first fault of the kept pixels, and of the bits of those that are masked.
std::string FaultOfPixels(const KeptImage& image, uint64_t limit) {
  const auto count = static_cast<uint64_t>(image.rect.pixel_count());
  const std::vector<uint64_t>& masked = image.masked;
  if (!masked.empty() && masked.size() != image.masked_words())
    return fmt::format("{} words of masked pixels, expected {}", masked.size(),
                       image.masked_words());
  if (!masked.empty() && count % 64 != 0 && masked.back() >> (count % 64) != 0)
    return "pixels beyond the last one are masked";
  const auto width = static_cast<uint32_t>(image.rect.width());
  const size_t value_count = image.value_count();
  for (size_t i = 0; i < image.places.size(); ++i) {
    const uint32_t place = image.places[i];
    if (place >= count) return fmt::format("a pixel at place {} of {}", place, count);
    if (i > 0 && place <= image.places[i - 1])
      return fmt::format("place {} follows place {}, but places must ascend", place,
                         image.places[i - 1]);
    if (!masked.empty() && (masked[place / 64] >> (place % 64) & 1) != 0)
      return fmt::format("place {} is masked, but is kept", place);
    const uint64_t x = static_cast<uint32_t>(image.rect.x_begin) + place % width;
    const uint64_t y = static_cast<uint32_t>(image.rect.y_begin) + place / width;
    const uint64_t hash =
        KeptPixels::HashOf(image.id, y * static_cast<uint64_t>(image.width_px) + x);
    // Nothing was dropped at the largest limit, not even a pixel of this hash.
    if (limit != UINT64_MAX && hash >= limit)
      return fmt::format("the hash {:016x} of place {} is not below the limit {:016x}", hash, place,
                         limit);
    const uint16_t last_value = image.values[(i + 1) * value_count - 1];
    if (image.has_trust && last_value > LfPixels::kTrusted)
      return fmt::format("the trust {} at place {}, expected at most {}", last_value, place,
                         LfPixels::kTrusted);
  }
  return {};
}

// Completes the LF image of a block by its head. Returns the first fault; empty if there is none.
std::string Complete(uint64_t limit, Block* block) {
  const ImageHead& head = block->head;
  KeptImage& image = block->image;
  const std::string name = fmt::format("LF image {}: ", head.id);
  if (layout::HashOf(head, image) != head.hash) return name + "its checksum differs";
  if (const std::string fault = FaultOfFrame(head); !fault.empty()) return name + fault;
  if (const std::string fault = FaultOfDepths(head); !fault.empty()) return name + fault;
  image.id = LfImageId{head.id};
  image.width_px = static_cast<int>(head.width_px);
  image.height_px = static_cast<int>(head.height_px);
  image.bayer = static_cast<BayerPattern>(head.bayer);
  image.recorded = static_cast<BayerPattern>(head.recorded);
  image.has_opacity = (head.flags & ImageHead::kOpacity) != 0;
  image.has_trust = (head.flags & ImageHead::kTrust) != 0;
  image.is_sparse = (head.flags & ImageHead::kSparse) != 0;
  image.rect = RectOf(head);
  image.depths.least = head.depth_least;
  image.depths.greatest = head.depth_greatest;
  image.depths.divisor = static_cast<int>(head.depth_divisor);
  const std::string fault = FaultOfPixels(image, limit);
  return fault.empty() ? fault : name + fault;
}

// Returns the head in `bytes`. Checks, before memory is allocated, that `source` has as many bytes
// left as the head says, and at most max_pixels pixels.
Result<FileHead> ReadFileHead(const entry_file::Source& source, const std::string& bytes,
                              size_t max_pixels) {
  FileHead head;
  std::memcpy(&head, bytes.data(), sizeof(head));
  if (source.left() < head.block_bytes)
    return InputError(fmt::format("{}: is truncated: {} bytes follow its head, expected {}; {}",
                                  source.name(), source.left(), head.block_bytes,
                                  source.kind().if_broken));
  if (source.left() > head.block_bytes)
    return source.Damaged(fmt::format("{} bytes follow its end", source.left() - head.block_bytes));
  // A pixel has its place and at least one value.
  if (head.image_count > head.block_bytes / sizeof(ImageHead) ||
      head.pixel_count > head.block_bytes / (sizeof(uint32_t) + sizeof(uint16_t)))
    return source.Damaged(fmt::format("{} LF images and {} pixels need more than its {} bytes",
                                      head.image_count, head.pixel_count, head.block_bytes));
  if (head.pixel_count > max_pixels)
    return InputError(fmt::format(
        "{}: contains {} pixels, but {{max_rays}} and {{memory}} allow only {}, because they are "
        "smaller than when the file was written",
        source.name(), head.pixel_count, max_pixels));
  return head;
}

// Reads a block, of which only those sizes are checked for which memory is allocated.
//   pixels_left  number of pixels that this block may have; is reduced by those that it has
Result<Block> ReadBlock(entry_file::Source& source, uint64_t* pixels_left) {
  Block block;
  LF_RETURN_IF_ERROR(source.Read(&block.head, sizeof(block.head)));
  const ImageHead& head = block.head;
  const BlockSizes sizes = SizesOf(head);
  if (head.pixel_count > *pixels_left || sizes.all() > source.left())
    return source.Damaged(fmt::format(
        "LF image {}: {} pixels in {} bytes, at most {} pixels and {} bytes were expected", head.id,
        head.pixel_count, sizes.all(), *pixels_left, source.left()));
  *pixels_left -= head.pixel_count;
  KeptImage& image = block.image;
  image.masked.resize(head.mask_words);
  LF_RETURN_IF_ERROR(source.Read(image.masked.data(), sizes.masked));
  image.places.resize(head.pixel_count);
  LF_RETURN_IF_ERROR(source.Read(image.places.data(), sizes.places));
  image.values.resize(sizes.values / sizeof(uint16_t));
  LF_RETURN_IF_ERROR(source.Read(image.values.data(), sizes.values));
  if (sizes.depths == 0) return block;
  image.depths.numbers =
      Image<uint16_t>(static_cast<int>(std::min<uint32_t>(head.depth_width, INT32_MAX)),
                      static_cast<int>(std::min<uint32_t>(head.depth_height, INT32_MAX)));
  LF_RETURN_IF_ERROR(source.Read(image.depths.numbers.pixels().data(), sizes.depths));
  return block;
}

using EntryCheckOfKept = std::function<Result<void>(const PlateEntries&)>;

Result<KeptFile> ReadBlocks(entry_file::Source& source, size_t max_pixels, ThreadPool& pool,
                            const EntryCheckOfKept& check) {
  LF_ASSIGN_OR_RETURN(entry_file::Front front, entry_file::ReadFront(source, sizeof(FileHead)));
  if (check) LF_RETURN_IF_ERROR(check(front.entries));
  LF_ASSIGN_OR_RETURN(const FileHead head, ReadFileHead(source, front.head, max_pixels));
  KeptFile file = {std::move(front.entries), KeptPixels(max_pixels, head.limit)};
  uint64_t pixels_left = head.pixel_count;
  std::optional<uint32_t> last_id;
  for (uint64_t done = 0; done < head.image_count;) {
    std::vector<Block> blocks;
    const uint64_t left_before = source.left();
    while (done + blocks.size() < head.image_count &&
           left_before - source.left() < kTogetherBytes) {
      LF_ASSIGN_OR_RETURN(Block block, ReadBlock(source, &pixels_left));
      blocks.push_back(std::move(block));
    }
    std::vector<std::string> faults(blocks.size());
    pool.ForEach(blocks.size(), [&](size_t i) { faults[i] = Complete(head.limit, &blocks[i]); });
    std::vector<KeptImage> images;
    for (size_t i = 0; i < blocks.size(); ++i) {
      if (!faults[i].empty()) return source.Damaged(faults[i]);
      const uint32_t id = blocks[i].head.id;
      if (last_id && id <= *last_id)
        return source.Damaged(
            fmt::format("LF image {} follows LF image {}, but ids must ascend", id, *last_id));
      last_id = id;
      images.push_back(std::move(blocks[i].image));
    }
    file.pixels.Add(std::move(images), pool);
    done += blocks.size();
  }
  if (pixels_left != 0 || source.left() != 0)
    return source.Damaged(fmt::format("its LF images lack {} of {} pixels, and {} bytes are left",
                                      pixels_left, head.pixel_count, source.left()));
  return file;
}

}  // namespace

Result<void> WriteKept(const fs::path& path, const PlateEntries& entries, const KeptPixels& pixels,
                       ThreadPool& pool) {
  return WriteAtomically(path, [&](const fs::path& temporary) {
    return WriteBlocks(temporary, entries, pixels, pool);
  });
}

Result<KeptFile> ReadKept(const fs::path& path, size_t max_pixels, ThreadPool& pool,
                          const EntryCheckOfKept& check) {
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<entry_file::Source> source,
                      entry_file::Source::OfFile(path, layout::kKind));
  return ReadBlocks(*source, max_pixels, pool, check);
}

Result<KeptFile> ReadKeptOfBytes(std::string_view bytes, const std::string& name, size_t max_pixels,
                                 ThreadPool& pool) {
  return ReadBlocks(*entry_file::Source::OfBytes(bytes, name, layout::kKind), max_pixels, pool, {});
}

}  // namespace lf

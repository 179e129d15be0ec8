// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/kept_pixels.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "lf/core/check.h"
#include "lf/core/random.h"
#include "lf/rebinning/fill_pixels.h"

namespace lf {
namespace {

bool IsSet(const std::vector<uint64_t>& bits, uint32_t place) {
  return !bits.empty() && (bits[place / 64] >> (place % 64) & 1) != 0;
}

// The values of all pixels of a rectangle, as an LF image has them.
class PixelWriter {
 public:
  PixelWriter(const KeptImage& image, const PixelRect& rect, LfPixels* pixels)
      : image_(image), pixels_(*pixels) {
    pixels_.Reset(rect, image.bayer);
    pixels_.recorded = image.recorded;
    pixels_.depths = image.depths;
    if (image.has_opacity) pixels_.opacity.Resize(rect.width(), rect.height(), LfPixels::kRgbLanes);
    if (image.has_trust) pixels_.trust.Resize(rect.width(), rect.height(), 1);
  }

  // Writes the values of a pixel: [image.value_count()].
  template <class Value>
  void Write(int x, int y, const Value* values) {
    const int column = x - pixels_.rect.x_begin, row = y - pixels_.rect.y_begin;
    if (image_.bayer == BayerPattern::kNone) {
      for (int c = 0; c < 3; ++c) pixels_.radiance.at(column, row, c) = Rounded(*values++);
      pixels_.radiance.at(column, row, LfPixels::kRayLane) = 1;
    } else {
      pixels_.radiance.at(column, row) = Rounded(*values++);
    }
    if (image_.has_opacity) {
      for (int c = 0; c < 3; ++c) pixels_.opacity.at(column, row, c) = Rounded(*values);
      pixels_.opacity.at(column, row, LfPixels::kRayLane) = 1;
      ++values;
    }
    if (image_.has_trust) pixels_.trust.at(column, row) = static_cast<uint8_t>(Rounded(*values));
  }

  // Gives the pixel no value: it sends no ray.
  void Mask(int x, int y) {
    const int column = x - pixels_.rect.x_begin, row = y - pixels_.rect.y_begin;
    pixels_.Mask(column, row);
    if (image_.bayer != BayerPattern::kNone) pixels_.radiance.at(column, row) = 0;
    if (image_.has_trust) pixels_.trust.at(column, row) = 0;
  }

 private:
  static uint16_t Rounded(uint16_t value) { return value; }
  static uint16_t Rounded(float value) {
    return static_cast<uint16_t>(std::clamp(value, 0.0F, 65535.0F) + 0.5F);
  }

  const KeptImage& image_;
  LfPixels& pixels_;
};

// A sparse LF image is filled in tiles of this size, each with the pixels up to this margin around
// it, so that photographs of many megapixels need little memory. Both are even, so that a tile of a
// mosaic begins at the same place of the pattern as any other. The margin grows until it contains a
// kept pixel of the place of the pattern; if the LF image has none, its pixels are masked.
constexpr int kTile_px = 512;
constexpr int kMargin_px = 32;
constexpr size_t kMostValues = 5;  // KeptImage::value_count()
static_assert(size_t{kTile_px + 2 * kMargin_px} * (kTile_px + 2 * kMargin_px) ==
              KeptPixels::kTilePixels);

// Returns freed memory to the system; glibc keeps that between blocks that are in use.
void GiveMemoryBack() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

// Returns the memory of an LF image besides its pixels: its entry in the map, the heads of its four
// blocks of memory, its mask, and its depths.
size_t OtherBytes(const KeptImage& image) {
  constexpr size_t kMapNodeBytes = 48;
  constexpr size_t kHeadBytes = 16;
  return sizeof(KeptImage) + kMapNodeBytes + 4 * kHeadBytes +
         image.masked.size() * sizeof(uint64_t) + image.depths.numbers.size_bytes();
}

// Fills the pixels of `around` whose columns and rows have the same remainders modulo `step` as
// (first_x, first_y), and passes those of `tile` that are not masked to the writer. Returns false,
// and does nothing, if none of them is kept. Light is interpolated by its square root, which is
// nearer to what people see: otherwise dark pixels beside a light would get too much of it.
bool FillTile(const KeptImage& image, const PixelRect& around, const PixelRect& tile, int step,
              int first_x, int first_y, PixelWriter* writer) {
  const size_t count = image.value_count();
  LF_CHECK(count <= kMostValues);
  const size_t colours = image.bayer == BayerPattern::kNone ? 3 : 1;
  const int columns = (around.x_end - first_x + step - 1) / step;
  const int rows = (around.y_end - first_y + step - 1) / step;
  if (columns <= 0 || rows <= 0) return true;
  bool is_any_kept = false;
  std::vector<Image<float>> planes(count, Image<float>(columns, rows));
  Image<float> weight(columns, rows);
  for (int row = 0; row < rows; ++row) {
    const uint32_t begin = image.PlaceOf(around.x_begin, first_y + step * row);
    auto place = std::lower_bound(image.places.begin(), image.places.end(), begin);
    for (; place != image.places.end() && *place < begin + static_cast<uint32_t>(around.width());
         ++place) {
      const int x = around.x_begin + static_cast<int>(*place - begin) - first_x;
      if (x % step != 0) continue;
      weight.at(x / step, row) = 1;
      is_any_kept = true;
      const uint16_t* const values =
          image.values.data() + static_cast<size_t>(place - image.places.begin()) * count;
      for (size_t i = 0; i < count; ++i)
        planes[i].at(x / step, row) =
            i < colours ? std::sqrt(static_cast<float>(values[i])) : static_cast<float>(values[i]);
    }
  }
  if (!is_any_kept) return false;
  FillPixels(&planes, weight);
  for (size_t i = 0; i < colours; ++i)
    for (float& value : planes[i].pixels()) value *= value;
  std::array<float, kMostValues> values;
  for (int row = (std::max(tile.y_begin - first_y, 0) + step - 1) / step; row < rows; ++row) {
    const int y = first_y + step * row;
    if (y >= tile.y_end) break;
    for (int column = (std::max(tile.x_begin - first_x, 0) + step - 1) / step; column < columns;
         ++column) {
      const int x = first_x + step * column;
      if (x >= tile.x_end) break;
      if (IsSet(image.masked, image.PlaceOf(x, y))) continue;
      for (size_t i = 0; i < count; ++i) values[i] = planes[i].at(column, row);
      writer->Write(x, y, values.data());
    }
  }
  return true;
}

// Interpolates the pixels of a sparse LF image that are not kept, and passes all that are wanted
// and not masked to the writer. In a mosaic, each place of the pattern is a picture of its own.
void FillAndWrite(const KeptImage& image, const PixelRect& wanted, PixelWriter* writer) {
  const int step = image.bayer == BayerPattern::kNone ? 1 : 2;
  const PixelRect inside = Intersection(wanted, image.rect);
  for (int y = inside.y_begin / kTile_px * kTile_px; y < inside.y_end; y += kTile_px)
    for (int x = inside.x_begin / kTile_px * kTile_px; x < inside.x_end; x += kTile_px) {
      const PixelRect tile = Intersection({x, y, x + kTile_px, y + kTile_px}, inside);
      for (int place = 0; place < step * step; ++place)
        for (int margin_px = kMargin_px;; margin_px *= 2) {
          const PixelRect around = Intersection(
              {x - margin_px, y - margin_px, x + kTile_px + margin_px, y + kTile_px + margin_px},
              image.rect);
          // Places are counted from an even pixel of the LF image.
          const int first_x = around.x_begin + ((around.x_begin ^ place) & (step - 1));
          const int first_y = around.y_begin + ((around.y_begin ^ (place / step)) & (step - 1));
          if (FillTile(image, around, tile, step, first_x, first_y, writer)) break;
          if (around != image.rect) continue;
          for (int row = tile.y_begin; row < tile.y_end; ++row)
            for (int column = tile.x_begin; column < tile.x_end; ++column)
              if ((column - first_x) % step == 0 && (row - first_y) % step == 0)
                writer->Mask(column, row);
          break;
        }
    }
}

}  // namespace

uint64_t KeptPixels::HashOf(LfImageId id, uint64_t number) {
  return MixBits(MixBits(id.value) ^ number);
}

// Drops the pixels of an LF image whose hashes are not below the limit. Returns the number of those
// that are left.
size_t KeptPixels::Drop(uint64_t limit, KeptImage* image) const {
  if (limit == UINT64_MAX) return image->places.size();
  const size_t count = image->value_count();
  const auto width = static_cast<uint32_t>(image->rect.width());
  size_t left = 0;
  for (size_t i = 0; i < image->places.size(); ++i) {
    const uint32_t place = image->places[i];
    const uint64_t x = static_cast<uint64_t>(image->rect.x_begin) + place % width;
    const uint64_t y = static_cast<uint64_t>(image->rect.y_begin) + place / width;
    if (HashOf(image->id, y * static_cast<uint64_t>(image->width_px) + x) >= limit) continue;
    image->places[left] = place;
    std::copy_n(image->values.begin() + static_cast<std::ptrdiff_t>(i * count), count,
                image->values.begin() + static_cast<std::ptrdiff_t>(left * count));
    ++left;
  }
  image->places.resize(left);
  image->values.resize(left * count);
  // Dropping frees a large part, and what is left stays for hours.
  image->places.shrink_to_fit();
  image->values.shrink_to_fit();
  return left;
}

void KeptPixels::Add(std::vector<KeptImage> images, ThreadPool& pool) {
  std::vector<KeptImage*> added;
  for (KeptImage& image : images) {
    LF_CHECK(image.values.size() == image.places.size() * image.value_count());
    const LfImageId id = image.id;
    const auto [place, is_new] = images_.emplace(id, std::move(image));
    LF_CHECK(is_new);
    added.push_back(&place->second);
    other_bytes_ += OtherBytes(place->second);
  }
  std::atomic<size_t> count = 0;
  pool.ForEach(added.size(), [&](size_t i) { count += Drop(limit_, added[i]); });
  size_ += count;
  if (!is_too_small()) return;
  while (is_too_small() && size_ > 0) {
    limit_ -= limit_ / 8;
    DropFromAll(pool);
  }
}

// Drops the pixels at and above the limit. After each sixteenth of the pixels, gives freed memory
// back, because threads copy what is left from the memory of one thread to that of another.
void KeptPixels::DropFromAll(ThreadPool& pool) {
  const size_t most = std::max(kFewTogether, size_ / 16);
  std::atomic<size_t> count = 0;
  for (auto next = images_.begin(); next != images_.end();) {
    std::vector<KeptImage*> together;
    for (size_t pixels = 0; next != images_.end() && pixels < most; ++next) {
      pixels += next->second.places.size();
      together.push_back(&next->second);
    }
    pool.ForEach(together.size(), [&](size_t i) { count += Drop(limit_, together[i]); });
    GiveMemoryBack();
  }
  size_ = count;
}

size_t KeptPixels::size_bytes() const {
  size_t bytes = other_bytes_;
  for (const auto& [id, image] : images_)
    bytes +=
        image.places.capacity() * sizeof(uint32_t) + image.values.capacity() * sizeof(uint16_t);
  return bytes;
}

void KeptPixels::Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const {
  const KeptImage& image = images_.at(id);
  const PixelRect wanted = Intersection(rect, {0, 0, image.width_px, image.height_px});
  PixelWriter writer(image, wanted, pixels);
  const bool is_sparse = IsSparse(image);
  if (is_sparse) FillAndWrite(image, wanted, &writer);
  const size_t count = image.value_count();
  auto next = image.places.begin();
  for (int y = wanted.y_begin; y < wanted.y_end; ++y) {
    const int first = std::max(wanted.x_begin, image.rect.x_begin);
    const bool is_row = y >= image.rect.y_begin && y < image.rect.y_end && !image.rect.empty();
    if (is_row && !is_sparse)
      next = std::lower_bound(next, image.places.end(), image.PlaceOf(first, y));
    for (int x = wanted.x_begin; x < wanted.x_end; ++x) {
      const bool is_inside = is_row && x >= image.rect.x_begin && x < image.rect.x_end;
      const uint32_t place = is_inside ? image.PlaceOf(x, y) : 0;
      if (is_inside && is_sparse && !IsSet(image.masked, place)) continue;
      if (is_inside && !is_sparse && next != image.places.end() && *next == place) {
        writer.Write(
            x, y, image.values.data() + static_cast<size_t>(next - image.places.begin()) * count);
        ++next;
        continue;
      }
      writer.Mask(x, y);
    }
  }
}

}  // namespace lf

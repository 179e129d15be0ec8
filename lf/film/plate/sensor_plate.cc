// SPDX-License-Identifier: Apache-2.0
#include "lf/film/plate/sensor_plate.h"

#include <algorithm>

namespace lf {
namespace {

uint32_t CountOf(uint64_t word) { return static_cast<uint32_t>(word >> SensorPlate::kSumBits); }
ElementSum Unpack(uint64_t word) { return {word & SensorPlate::kSumMask, CountOf(word)}; }

}  // namespace

std::optional<PlateKind> PlateKindOf(uint32_t channels) {
  for (const PlateKind kind :
       {PlateKind::kColours, PlateKind::kOpacity, PlateKind::kGuarded, PlateKind::kGuardedOpacity})
    if (static_cast<uint32_t>(kind) == channels) return kind;
  return std::nullopt;
}

SensorPlate::SensorPlate(int width, int height, PlateKind kind, uint32_t count_limit)
    : width_(width),
      height_(height),
      kind_(kind),
      count_limit_(count_limit),
      packed_(static_cast<size_t>(width) * height * static_cast<size_t>(kind)),
      wide_mutex_(std::make_unique<std::mutex>()) {
  LF_CHECK(count_limit >= 1 && count_limit <= kMaxCount);
}
SensorPlate::SensorPlate(SensorPlate&&) noexcept = default;
SensorPlate& SensorPlate::operator=(SensorPlate&&) noexcept = default;
SensorPlate::~SensorPlate() = default;

size_t SensorPlate::size_bytes() const {
  constexpr size_t kMapNodeBytes = 64;
  return packed_.size() * sizeof(uint64_t) + wide_.size() * kMapNodeBytes;
}

ElementSum SensorPlate::At(int x, int y, int channel) const {
  return AtWord(IndexOf(x, y, channel));
}

ElementSum SensorPlate::AtWord(size_t index) const {
  ElementSum total = Unpack(packed_[index]);
  if (const auto wide = wide_.find(index); wide != wide_.end()) {
    total.sum += wide->second.sum;
    total.count += wide->second.count;
  }
  return total;
}

void SensorPlate::AddRay(int x, int y, int channel, uint16_t v) { Add(x, y, channel, {v, 1}); }

void SensorPlate::Add(int x, int y, int channel, const ElementSum& rays) {
  LF_DCHECK(rays.sum <= 65535 * rays.count);
  const size_t index = IndexOf(x, y, channel);
  const ElementSum packed = Unpack(packed_[index]);
  if (packed.count + rays.count <= count_limit_) {
    packed_[index] += rays.count * kOneRay + rays.sum;
    return;
  }
  const std::lock_guard lock(*wide_mutex_);
  ElementSum& wide = wide_[index];
  wide.sum += packed.sum + rays.sum;
  wide.count += packed.count + rays.count;
  packed_[index] = 0;
}

void SensorPlate::Merge(const SensorPlate& other) {
  LF_CHECK(width_ == other.width_ && height_ == other.height_ && kind_ == other.kind_);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      for (int channel = 0; channel < channels(); ++channel)
        if (const ElementSum rays = other.At(x, y, channel); rays.count > 0)
          Add(x, y, channel, rays);
}

bool operator==(const SensorPlate& a, const SensorPlate& b) {
  if (a.width_ != b.width_ || a.height_ != b.height_ || a.kind_ != b.kind_) return false;
  if (a.wide_.empty() && b.wide_.empty()) return a.packed_ == b.packed_;
  for (int y = 0; y < a.height_; ++y)
    for (int x = 0; x < a.width_; ++x)
      for (int channel = 0; channel < a.channels(); ++channel)
        if (a.At(x, y, channel) != b.At(x, y, channel)) return false;
  return true;
}

uint32_t SensorPlate::Promote(const PixelRect& rect, uint32_t count_kept) {
  uint32_t largest = 0;
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    for (size_t i = IndexOf(rect.x_begin, y, 0); i < IndexOf(rect.x_end, y, 0); ++i) {
      const uint32_t count = CountOf(packed_[i]);
      if (count <= count_kept) {
        largest = std::max(largest, count);
        continue;
      }
      const std::lock_guard lock(*wide_mutex_);
      ElementSum& wide = wide_[i];
      const ElementSum packed = Unpack(packed_[i]);
      wide.sum += packed.sum;
      wide.count += packed.count;
      packed_[i] = 0;
    }
  }
  return largest;
}

PlateTile::PlateTile(SensorPlate* plate, const PixelRect& rect) : plate_(plate), rect_(rect) {
  LF_CHECK(Intersection(rect, {0, 0, plate->width(), plate->height()}) == rect);
}

void PlateTile::MakeRoom(uint32_t rays) {
  LF_CHECK(rays <= max_reserve());
  // The new headroom depends on the largest count that a word really has, so that room that was
  // reserved but not used can be reserved again.
  const uint32_t limit = plate_->count_limit_;
  headroom_ = limit - plate_->Promote(rect_, limit - rays);
}

std::vector<PlateTile> CutIntoTiles(SensorPlate* plate, const TileGrid& grid) {
  LF_CHECK(plate->width() == grid.plate_width && plate->height() == grid.plate_height);
  std::vector<PlateTile> tiles;
  for (size_t tile = 0; tile < grid.tile_count(); ++tile)
    tiles.emplace_back(plate, grid.RectOf(tile));
  return tiles;
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// The synthetic sensor plate of one frame: sum and count of the rays of every element and channel
// (thesis 4.3.1), exact.
//
// One 64-bit word per element and channel, [height][width][3], R G B: the upper 24 bits count rays,
// the lower 40 hold the sum of their 16-bit values. A ray is one addition of
// kOneRay | value; integer addition commutes, so the plate has the same bits for any order, any
// number of threads and any split of the work. 2^24 - 1 rays of value 65535 just fit; before an
// element could exceed that, its content moves to a side table of wide words. Nothing wraps.
//
// PlateKind lists further channels that a plate may have: their words follow the three words of an
// element's colours, [height][width][channels()].
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "lf/core/check.h"
#include "lf/core/geometry.h"
#include "lf/core/large_vector.h"
#include "lf/film/plate/tile_grid.h"

namespace lf {

struct ElementSum {
  uint64_t sum = 0;    // sum of the rays' values v
  uint64_t count = 0;  // number of rays
  // Mean of the rays' values; there must be a ray.
  double Mean() const { return static_cast<double>(sum) / static_cast<double>(count); }
  friend bool operator==(const ElementSum&, const ElementSum&) = default;
};

// The kinds of plates. The value of a kind is its number of channels.
enum class PlateKind : uint8_t {
  kColours = 3,  // R G B
  // R G B, then the opacity of the same rays. Opacities are values v as
  // light_field/model/lf_pixels.h defines them.
  kOpacity = 4,
  // The plate of a densified light field (doc/densify.md): R G B of the rays of recorded LF images,
  // then the defocus of the same rays in the values of opacities (1 is out of focus), then R G B of
  // the rays of all LF images, and the trust in these rays in the values of opacities. Code that
  // reads three colours reads those of recorded LF images.
  kGuarded = 8,
  // As kGuarded, but the opacity of the same rays follows R G B, both times.
  kGuardedOpacity = 10,
};
// Returns the kind with this number of channels; nullopt if there is none.
std::optional<PlateKind> PlateKindOf(uint32_t channels);

class SensorPlate {
 public:
  static constexpr int kChannels = 3;  // the colours R, G and B
  static constexpr int kOpacityChannel = 3;
  static constexpr int kSumBits = 40;
  static constexpr uint64_t kOneRay = uint64_t{1} << kSumBits;
  static constexpr uint64_t kSumMask = kOneRay - 1;
  static constexpr uint32_t kMaxCount = (1u << 24) - 1;

  // count_limit: the largest count a packed word may hold; below kMaxCount for tests only.
  SensorPlate(int width, int height, PlateKind kind = PlateKind::kColours,
              uint32_t count_limit = kMaxCount);
  SensorPlate(int width, int height, uint32_t count_limit)
      : SensorPlate(width, height, PlateKind::kColours, count_limit) {}
  SensorPlate(SensorPlate&&) noexcept;
  SensorPlate& operator=(SensorPlate&&) noexcept;
  ~SensorPlate();

  int width() const { return width_; }
  int height() const { return height_; }
  PlateKind kind() const { return kind_; }
  int channels() const { return static_cast<int>(kind_); }
  bool has_opacity() const {
    return kind_ == PlateKind::kOpacity || kind_ == PlateKind::kGuardedOpacity;
  }
  bool is_guarded() const {
    return kind_ == PlateKind::kGuarded || kind_ == PlateKind::kGuardedOpacity;
  }
  // Channels of a guarded plate: the defocus; R of the rays of all LF images; the opacity of these
  // rays, if the plate has opacities; the trust in these rays.
  int defocus_channel() const { return has_opacity() ? kOpacityChannel + 1 : kChannels; }
  int all_rays_channel() const { return defocus_channel() + 1; }
  int all_opacity_channel() const { return all_rays_channel() + kChannels; }
  int trust_channel() const { return channels() - 1; }
  size_t size_bytes() const;

  // Returns sum and count of one element and channel, wherever they are stored.
  ElementSum At(int x, int y, int channel) const;

  // Adds one ray of value v. Never overflows, but is slow: for references and tests.
  void AddRay(int x, int y, int channel, uint16_t v);

  // Adds the sum of any number of rays. Needs sum <= 65535 * count.
  void Add(int x, int y, int channel, const ElementSum& rays);

  // Adds all sums and counts of another plate, which must have the same size and kind.
  void Merge(const SensorPlate& other);

  // These functions show how sums and counts are stored, for files. words() are the packed words
  // [height][width][channels()]. wide() holds sums and counts that were moved out of packed words
  // before these could overflow, by the index of the word. AtWord() returns the total of both.
  std::span<const uint64_t> words() const { return packed_; }
  const std::map<size_t, ElementSum>& wide() const { return wide_; }
  ElementSum AtWord(size_t index) const;

  // True if all sums and counts are equal, however they are stored.
  friend bool operator==(const SensorPlate& a, const SensorPlate& b);

 private:
  friend class PlateTile;
  size_t IndexOf(int x, int y, int channel) const {
    return (static_cast<size_t>(y) * width_ + x) * channels() + channel;
  }
  // Moves packed words of `rect` whose count exceeds `count_kept` to the wide table. Returns the
  // largest count of the words of `rect` that stay packed.
  uint32_t Promote(const PixelRect& rect, uint32_t count_kept);

  int width_;
  int height_;
  PlateKind kind_;
  uint32_t count_limit_;
  LargeVector<uint64_t> packed_;
  // The total of an element's channel is its packed word plus its wide word. Wide words are rare,
  // so that one lock is enough for all tiles.
  std::map<size_t, ElementSum> wide_;
  std::unique_ptr<std::mutex> wide_mutex_;
};

// A rectangle of a plate, to which a kernel adds rays. One thread owns a tile at a time; tiles of
// one plate that do not overlap may be written at the same time.
class PlateTile {
 public:
  // Makes a tile of the part `rect` of the plate, which must lie on the plate.
  PlateTile(SensorPlate* plate, const PixelRect& rect);

  const PixelRect& rect() const { return rect_; }

  // Returns the tile's words in row y of the plate, [width][channels()].
  uint64_t* row(int y) {
    LF_DCHECK(y >= rect_.y_begin && y < rect_.y_end);
    return plate_->packed_.data() + plate_->IndexOf(rect_.x_begin, y, 0);
  }
  int channels() const { return plate_->channels(); }

  // The largest number of rays that may be reserved at once.
  uint32_t max_reserve() const { return plate_->count_limit_; }

  // Makes room for `rays` more rays, at most max_reserve(): they may be added to the tile's words,
  // even all to the same one, without overflow. Almost always this is one comparison.
  void Reserve(uint32_t rays) {
    if (rays > headroom_) MakeRoom(rays);
    headroom_ -= rays;
  }

 private:
  void MakeRoom(uint32_t rays);

  SensorPlate* plate_;
  PixelRect rect_;
  uint32_t headroom_ = 0;
};

// Returns all tiles of a plate, which must have the grid's size.
std::vector<PlateTile> CutIntoTiles(SensorPlate* plate, const TileGrid& grid);

}  // namespace lf

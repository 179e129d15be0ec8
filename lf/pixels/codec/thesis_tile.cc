// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/thesis_tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "lf/pixels/codec/entropy.h"
#include "lf/pixels/codec/haar.h"

namespace lf {
namespace {

// Position of a plane's pixels in the tile: every `pitch`th value from `first` on, in every
// `row_pitch`th row from `first_row` on.
struct PlanePlace {
  int width = 0;
  int height = 0;
  int first_row = 0;
  int row_pitch = 1;
  int first = 0;
  int pitch = 1;
  size_t count() const { return static_cast<size_t>(width) * height; }
};

std::vector<PlanePlace> PlacesOf(const CodeHead& head, int width, int height) {
  if (head.info.layout != PixelLayout::kMosaic) {
    const int channels = ChannelsOf(head.info.layout);
    std::vector<PlanePlace> places;
    for (int c = 0; c < channels; ++c) places.push_back({width, height, 0, 1, c, channels});
    return places;
  }
  std::vector<PlanePlace> places;
  for (const int y : {0, 1})
    for (const int x : {0, 1})
      places.push_back({(width + 1 - x) / 2, (height + 1 - y) / 2, y, 2, x, 2});
  return places;
}

int CodeBytes(const CodeHead& head) { return head.quantizer <= 256 ? 1 : 2; }

// ValueOf() returns the coefficient that value `code` of the quantiser stands for. NearestCode()
// returns the `code` whose coefficient is nearest to `value`.
int32_t ValueOf(const CodeHead& head, int64_t code) {
  const int64_t last = head.quantizer - 1;
  return static_cast<int32_t>(head.low + (code * (head.high - head.low) + last / 2) / last);
}
int64_t NearestCode(const CodeHead& head, int32_t value) {
  const int64_t range = head.high - head.low;
  return range == 0 ? 0 : ((value - head.low) * (head.quantizer - 1) + range / 2) / range;
}

// Returns the coefficient that each possible code stands for. Codes above the quantiser's last
// code, which only damaged files have, stand for the same coefficient as the last code.
std::vector<int32_t> Values(const CodeHead& head) {
  std::vector<int32_t> values(size_t{1} << (8 * CodeBytes(head)));
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = ValueOf(head, std::min<int64_t>(static_cast<int64_t>(i), head.quantizer - 1));
  return values;
}

// Returns the sizes of the plane and of its low subband after each level.
std::vector<std::pair<int, int>> SizesOf(const PlanePlace& plane, int levels) {
  std::vector<std::pair<int, int>> sizes = {{plane.width, plane.height}};
  for (int i = 0; i < levels; ++i)
    sizes.emplace_back(LowCount(sizes.back().first), LowCount(sizes.back().second));
  return sizes;
}

size_t AreaOf(std::pair<int, int> size) { return static_cast<size_t>(size.first) * size.second; }

// Returns the number of coefficients of a plane in one resolution.
size_t CountOf(const PlanePlace& plane, int levels, int resolution) {
  const std::vector<std::pair<int, int>> sizes = SizesOf(plane, levels);
  if (resolution == 0) return AreaOf(sizes[levels]);
  const int level = levels + 1 - resolution;
  return AreaOf(sizes[level - 1]) - AreaOf(sizes[level]);
}

template <class Pixel>
std::vector<int32_t> PlaneOf(const PlanePlace& place, ImageView<const Pixel> pixels) {
  std::vector<int32_t> plane;
  plane.reserve(place.count());
  for (int y = 0; y < place.height; ++y) {
    const Pixel* from = pixels.row(place.first_row + y * place.row_pitch) + place.first;
    for (int x = 0; x < place.width; ++x, from += place.pitch)
      plane.push_back(int32_t{*from} << kHaarBits);
  }
  return plane;
}

template <class Pixel>
void StorePlane(const PlanePlace& place, const std::vector<int32_t>& plane,
                ImageView<Pixel> pixels) {
  constexpr int32_t kMost = std::numeric_limits<Pixel>::max();
  const int32_t* from = plane.data();
  for (int y = 0; y < place.height; ++y) {
    Pixel* to = pixels.row(place.first_row + y * place.row_pitch) + place.first;
    for (int x = 0; x < place.width; ++x, to += place.pitch)
      *to =
          static_cast<Pixel>(std::clamp((*from++ + (1 << (kHaarBits - 1))) >> kHaarBits, 0, kMost));
  }
}

}  // namespace

template <class Pixel>
HaarTile TransformTile(const CodeHead& head, double threshold, ImageView<const Pixel> pixels) {
  const int levels = head.info.levels;
  const double limit = threshold * (1 << kHaarBits);
  HaarTile tile;
  tile.streams.resize(levels + 1);
  for (const PlanePlace& place : PlacesOf(head, pixels.width, pixels.height)) {
    if (place.count() == 0) continue;
    std::vector<int32_t> low = PlaneOf(place, pixels);
    const std::vector<std::pair<int, int>> sizes = SizesOf(place, levels);
    for (int level = 1; level <= levels; ++level) {
      const auto [width, height] = sizes[level - 1];
      std::array<std::vector<int32_t>, kBands> bands;
      std::array<int32_t*, kBands> pointers{};
      for (int b = 0; b < kBands; ++b) {
        bands[b].resize(BandSize(static_cast<Band>(b), width, height));
        pointers[b] = bands[b].data();
      }
      AnalyzeHaar(low.data(), width, height, pointers);
      std::vector<int32_t>& stream = tile.streams[levels + 1 - level];
      for (const Band band : {kHighLow, kLowHigh, kHighHigh})
        for (const int32_t value : bands[band])
          stream.push_back(std::abs(value) < limit ? 0 : value);
      low = std::move(bands[kLowLow]);
    }
    tile.streams[0].insert(tile.streams[0].end(), low.begin(), low.end());
  }
  for (const std::vector<int32_t>& stream : tile.streams)
    for (const int32_t value : stream) {
      tile.low = std::min(tile.low, value);
      tile.high = std::max(tile.high, value);
    }
  return tile;
}
template HaarTile TransformTile(const CodeHead&, double, ImageView<const uint8_t>);
template HaarTile TransformTile(const CodeHead&, double, ImageView<const uint16_t>);

std::string CodeOfSection(const CodeHead& head, const HaarTile& tile, int resolution) {
  std::vector<uint8_t> bytes;
  for (const int32_t value : tile.streams[resolution]) {
    const int64_t code = NearestCode(head, value);
    bytes.push_back(static_cast<uint8_t>(code));
    if (CodeBytes(head) == 2) bytes.push_back(static_cast<uint8_t>(code >> 8));
  }
  std::string code;
  AppendCompressed(bytes, &code);
  return code;
}

template <class Pixel>
bool DecodeHaarTile(Transform transform, const CodeHead& head, std::span<std::string_view> sections,
                    ImageView<Pixel> pixels) {
  const int levels = head.info.levels;
  const std::vector<PlanePlace> places = PlacesOf(head, pixels.width, pixels.height);
  const std::vector<int32_t> values = Values(head);
  // The coefficients of each resolution, and the index at which the coefficients of the next plane
  // begin.
  std::vector<std::vector<int32_t>> streams(levels + 1);
  std::vector<size_t> next(levels + 1, 0);
  std::vector<uint8_t> bytes;
  for (int resolution = 0; resolution <= levels; ++resolution) {
    size_t count = 0;
    for (const PlanePlace& place : places) count += CountOf(place, levels, resolution);
    bytes.resize(count * CodeBytes(head));
    if (!Decompress(sections[resolution], bytes)) return false;
    std::vector<int32_t>& stream = streams[resolution];
    stream.resize(count);
    for (size_t i = 0; i < count; ++i)
      stream[i] = values[CodeBytes(head) == 1 ? bytes[i] : bytes[2 * i] | bytes[2 * i + 1] << 8];
  }
  for (const PlanePlace& place : places) {
    if (place.count() == 0) continue;
    const std::vector<std::pair<int, int>> sizes = SizesOf(place, levels);
    const auto take = [&](int resolution) {
      const int32_t* const from = streams[resolution].data() + next[resolution];
      next[resolution] += CountOf(place, levels, resolution);
      return from;
    };
    const int32_t* const low = take(0);
    std::vector<int32_t> plane(low, low + AreaOf(sizes[levels]));
    for (int level = levels; level >= 1; --level) {
      const auto [width, height] = sizes[level - 1];
      const int32_t* const details = take(levels + 1 - level);
      const size_t across = BandSize(kHighLow, width, height);
      const size_t down = BandSize(kLowHigh, width, height);
      std::vector<int32_t> finer(AreaOf(sizes[level - 1]));
      SynthesizeHaar(transform, {plane.data(), details, details + across, details + across + down},
                     width, height, finer.data());
      plane = std::move(finer);
    }
    StorePlane(place, plane, pixels);
  }
  return true;
}
template bool DecodeHaarTile(Transform, const CodeHead&, std::span<std::string_view>,
                             ImageView<uint8_t>);
template bool DecodeHaarTile(Transform, const CodeHead&, std::span<std::string_view>,
                             ImageView<uint16_t>);

}  // namespace lf

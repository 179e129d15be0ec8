// SPDX-License-Identifier: Apache-2.0
// The decoder of wavelet_tile.h.
#include <algorithm>
#include <array>
#include <limits>

#include "lf/pixels/codec/coefficient_coder.h"
#include "lf/pixels/codec/packing.h"
#include "lf/pixels/codec/rgb_planes.h"
#include "lf/pixels/codec/tile_bands.h"
#include "lf/pixels/codec/wavelet_tile.h"

namespace lf {
namespace {

template <class T>
void Unpredict(PlaneExtent size, T* values) {
  const auto sum = [](T a, T b) {
    return static_cast<T>(static_cast<uint32_t>(a) + static_cast<uint32_t>(b));
  };
  const auto width = static_cast<size_t>(size.width);
  for (size_t i = 1; i < width; ++i) values[i] = sum(values[i], values[i - 1]);
  for (size_t i = width; i < size.count(); ++i) values[i] = sum(values[i], values[i - width]);
}

// Memory that each thread keeps, to use it for every tile.
template <class T>
struct WaveletScratch {
  std::array<std::vector<T>, 4> components;
  // Low subbands and details of successive levels, in turn.
  std::array<std::vector<T>, 2> low, details;

  static WaveletScratch& OfThread() {
    static thread_local WaveletScratch scratch;
    return scratch;
  }
  static T* Room(std::vector<T>* memory, size_t count) {
    if (memory->size() < count + kSlack) memory->resize(count + kSlack);
    return memory->data();
  }
};

// Reads the streams of a tile, component by component.
template <class T>
class TileReader {
 public:
  //   tile  size in pixels
  TileReader(Transform transform, const CodeHead& head, PlaneExtent tile,
             std::span<std::string_view> sections)
      : transform_(transform), head_(head), sections_(sections) {
    if (head.info.entropy == Entropy::kPacked) return;
    packets_.resize(sections.size());
    int count = 0;  // components that have values
    for (int c = 0; c < head.components(); ++c)
      count += ComponentSize(head, c, tile).count() > 0 ? 1 : 0;
    for (size_t r = 0; r < sections.size(); ++r) {
      const auto resolution = static_cast<int>(r);
      is_whole_ = is_whole_ && packets_[r].Begin(transform, sections[r], count,
                                                 StripCountOf(head, tile, resolution),
                                                 RoundingOf(head, resolution));
    }
  }

  // Returns true if the streams end here, as they must after all components.
  [[nodiscard]] bool IsAtEnd() const {
    return std::all_of(packets_.begin(), packets_.end(),
                       [](const PacketReader& packet) { return packet.IsAtEnd(); });
  }

  // Reads the next component and synthesises all its levels except the finest. Sets `finest` to the
  // subbands of the finest level, which stay in the scratch memory until the next call. Returns
  // false if a stream is damaged.
  [[nodiscard]] bool Read(int component, PlaneExtent size, CodedBands<T>* finest) {
    if (!Begin(component, size)) return false;
    while (true) {
      if (!ReadLevel(finest)) return false;
      if (resolution_ == head_.info.levels) return true;
      SynthesizeLow(*finest);
    }
  }

  // Reads the next component up to a resolution, from as many sections as it needs. Sets `low` to
  // the low subband that the next finer level would need, which stays in the scratch memory until
  // the next call. Returns false if a stream is damaged.
  [[nodiscard]] bool ReadLow(int component, PlaneExtent size, int resolution, CodedBand<T>* low) {
    if (!Begin(component, size)) return false;
    while (resolution_ < resolution) {
      CodedBands<T> bands;
      if (!ReadLevel(&bands)) return false;
      SynthesizeLow(bands);
    }
    *low = low_;
    return true;
  }

 private:
  // Reads the approximation of a component.
  bool Begin(int component, PlaneExtent size) {
    component_ = component;
    size_ = size;
    resolution_ = 0;
    const PlaneExtent smallest = LowSize(size, head_.info.levels);
    T* const values = WaveletScratch<T>::Room(&scratch_.low[0], smallest.count());
    if (!Take(std::array{ApproximationBand(smallest, values)}, smallest.count(), values))
      return false;
    Unpredict(smallest, values);
    low_ = {values, Step(false), false};
    return true;
  }

  // Reads the details of the next resolution. Sets `bands` to the subbands of its level.
  bool ReadLevel(CodedBands<T>* bands) {
    ++resolution_;
    const PlaneExtent here = LowSize(size_, level() - 1);
    T* const details =
        WaveletScratch<T>::Room(&scratch_.details[resolution_ % 2], DetailCount(here));
    const T* const parents =
        resolution_ > 1 ? scratch_.details[1 - resolution_ % 2].data() : nullptr;
    if (!Take(DetailBands(here, details, parents), DetailCount(here), details)) return false;
    *bands = {here.width, here.height, {}};
    bands->bands[kLowLow] = low_;
    const T* next = details;
    for (const Band band : {kHighLow, kLowHigh, kHighHigh}) {
      bands->bands[band] = {next, Step(band == kHighHigh), false};
      next += BandSize(band, here.width, here.height);
    }
    return true;
  }

  // Reads the coefficients of the component at the resolution. `values` are those of all bands.
  [[nodiscard]] bool Take(std::span<const CoefficientBand<T>> bands, size_t count, T* values) {
    if (head_.info.entropy == Entropy::kPacked)
      return TakeCoefficients(transform_, &sections_[resolution_], count, values);
    return is_whole_ && packets_[resolution_].Take(bands);
  }

  // Synthesises the plane whose subbands ReadLevel() has read.
  void SynthesizeLow(const CodedBands<T>& bands) {
    const PlaneExtent here = {bands.width, bands.height};
    T* const values = WaveletScratch<T>::Room(&scratch_.low[resolution_ % 2], here.count());
    Synthesize(transform_, bands, values);
    const int depth = FirstDepth(head_) + level() - 2;
    low_ = {values, 1, depth > 0 && IsDoubled(head_, depth)};
  }

  // Returns the level whose details are those of the resolution.
  int level() const { return head_.info.levels + 1 - resolution_; }
  T Step(bool is_diagonal) const {
    return static_cast<T>(head_.steps[StepIndex(head_, component_, resolution_, is_diagonal)]);
  }

  const Transform transform_;
  const CodeHead& head_;
  const std::span<std::string_view> sections_;
  std::vector<PacketReader> packets_;  // index: resolution; empty for Entropy::kPacked
  bool is_whole_ = true;
  WaveletScratch<T>& scratch_ = WaveletScratch<T>::OfThread();
  int component_ = 0;
  PlaneExtent size_;
  int resolution_ = 0;  // the last one that was read
  CodedBand<T> low_;    // the low subband of the next level
};

template <class T, class Pixel>
bool DecodeAs(Transform transform, const CodeHead& head, std::span<std::string_view> sections,
              ImageView<Pixel> pixels) {
  WaveletScratch<T>& scratch = WaveletScratch<T>::OfThread();
  TileReader<T> reader(transform, head, {pixels.width, pixels.height}, sections);
  const PixelScale scale{head.fraction_bits, 1 << (head.info.bits - 1), head.is_predicted()};
  CodedBands<T> bands;
  if (head.info.layout == PixelLayout::kGrey) {
    if (!reader.Read(0, {pixels.width, pixels.height}, &bands) || !reader.IsAtEnd()) return false;
    SynthesizePixels(transform, bands, scale, pixels);
    return true;
  }
  CodedBands<T> mosaic{pixels.width, pixels.height, {}};
  for (int c = 0; c < head.components(); ++c) {
    const PlaneExtent size = ComponentSize(head, c, {pixels.width, pixels.height});
    T* const component = WaveletScratch<T>::Room(&scratch.components[c], size.count());
    mosaic.bands[c] = {component, 1, IsDoubled(head, 1)};
    if (size.count() == 0) continue;
    if (!reader.Read(c, size, &bands)) return false;
    Synthesize(transform, bands, component);
  }
  if (!reader.IsAtEnd()) return false;
  if (head.info.layout == PixelLayout::kMosaic) {
    SynthesizePixels(transform, mosaic, scale, pixels);
    return true;
  }
  std::array<const T*, kRgbComponents> components{};
  for (int c = 0; c < kRgbComponents; ++c) components[c] = scratch.components[c].data();
  MergeColours(transform, components, scale, pixels);
  return true;
}

// Returns the number of fraction bits of the low subbands from which reduced pixels are made.
int LowFractionBits(const CodeHead& head) {
  const bool any_doubled = head.info.layout == PixelLayout::kMosaic || head.info.levels > 1;
  return head.fraction_bits + (any_doubled && IsDoubled(head, 1) ? 1 : 0);
}

// Converts the low subbands of the four components of a mosaic to the colours of its squares of 2 x
// 2 pixels, for colours that do not change from one square to the next: then high is odd - even,
// and low their mean. Damaged files may have coefficients of any size, so sums are 64 bits wide.
//   bands  [component][y][x], each of the size of `pixels`
template <class T, class Pixel>
void MergeMosaic(const std::array<const T*, kBands>& bands, const PixelScale& scale,
                 ImageView<Pixel> pixels) {
  constexpr int kFurtherBits = 2;  // nothing is rounded before the end
  const int bits = scale.fraction_bits + kFurtherBits;
  const int64_t half = int64_t{1} << bits >> 1;
  const auto even_and_odd = [](int64_t low, int64_t high) {
    const int64_t even = low - (high >> 1);
    return std::array<int64_t, 2>{even, even + high};
  };
  for (int y = 0; y < pixels.height; ++y) {
    Pixel* out = pixels.row(y);
    for (int x = 0; x < pixels.width; ++x) {
      const size_t i = static_cast<size_t>(y) * pixels.width + x;
      const auto value = [&](Band band) { return int64_t{bands[band][i]} << kFurtherBits; };
      const auto low = even_and_odd(value(kLowLow), value(kLowHigh));
      const auto high = even_and_odd(value(kHighLow), value(kHighHigh));
      for (const int row : {0, 1})
        for (const int64_t colour : even_and_odd(low[row], high[row]))
          *out++ = static_cast<Pixel>(std::clamp<int64_t>(((colour + half) >> bits) + scale.offset,
                                                          0, std::numeric_limits<Pixel>::max()));
    }
  }
}

template <class T, class Pixel>
void ScaleGrey(const T* values, const PixelScale& scale, ImageView<Pixel> pixels) {
  const int32_t half = (1 << scale.fraction_bits) >> 1;
  for (int y = 0; y < pixels.height; ++y) {
    const T* const in = values + static_cast<size_t>(y) * pixels.width;
    Pixel* const out = pixels.row(y);
    for (int x = 0; x < pixels.width; ++x) {
      const auto rounded =
          static_cast<int32_t>(static_cast<uint32_t>(int32_t{in[x]}) + static_cast<uint32_t>(half));
      const int32_t value =
          static_cast<int32_t>(static_cast<uint32_t>(rounded >> scale.fraction_bits) +
                               static_cast<uint32_t>(scale.offset));
      out[x] = static_cast<Pixel>(std::clamp<int32_t>(value, 0, std::numeric_limits<Pixel>::max()));
    }
  }
}

// Copies the low subband of a component, times its step, to a plane of width x height values. The
// high subbands of a mosaic may lack the last column or row, which is then repeated.
template <class T>
void CopyLow(const CodedBand<T>& low, PlaneExtent size, int width, int height, T* plane) {
  for (int y = 0; y < height; ++y) {
    const T* const in = low.values + static_cast<size_t>(std::min(y, size.height - 1)) * size.width;
    T* const out = plane + static_cast<size_t>(y) * width;
    for (int x = 0; x < size.width; ++x)
      out[x] = static_cast<T>(static_cast<uint32_t>(in[x]) * static_cast<uint32_t>(low.step));
    for (int x = size.width; x < width; ++x) out[x] = out[x - 1];
  }
}

template <class T, class Pixel>
bool DecodeReducedAs(Transform transform, const CodeHead& head,
                     std::span<std::string_view> sections, PlaneExtent tile,
                     ImageView<Pixel> pixels) {
  const int resolution = static_cast<int>(sections.size()) - 1;
  const size_t count = static_cast<size_t>(pixels.width) * pixels.height;
  WaveletScratch<T>& scratch = WaveletScratch<T>::OfThread();
  TileReader<T> reader(transform, head, tile, sections);
  std::array<const T*, kBands> planes{};
  for (int c = 0; c < head.components(); ++c) {
    T* const plane = WaveletScratch<T>::Room(&scratch.components[c], count);
    planes[c] = plane;
    const PlaneExtent size = ComponentSize(head, c, tile);
    std::fill_n(plane, size.count() == 0 ? count : 0, T{0});
    if (size.count() == 0) continue;
    CodedBand<T> low;
    if (!reader.ReadLow(c, size, resolution, &low)) return false;
    CopyLow(low, LowSize(size, head.info.levels - resolution), pixels.width, pixels.height, plane);
  }
  if (!reader.IsAtEnd()) return false;
  const PixelScale scale{LowFractionBits(head), 1 << (head.info.bits - 1), false};
  if (head.info.layout == PixelLayout::kRgb)
    MergeColours(transform, std::array{planes[0], planes[1], planes[2]}, scale, pixels);
  else if (head.info.layout == PixelLayout::kMosaic)
    MergeMosaic(planes, scale, pixels);
  else
    ScaleGrey(planes[0], scale, pixels);
  return true;
}

}  // namespace

template <class Pixel>
bool DecodeWaveletTile(Transform transform, const CodeHead& head,
                       std::span<std::string_view> sections, ImageView<Pixel> pixels) {
  if constexpr (sizeof(Pixel) == 1)
    if (head.coefficient_bytes == 2) return DecodeAs<int16_t>(transform, head, sections, pixels);
  return DecodeAs<int32_t>(transform, head, sections, pixels);
}
template bool DecodeWaveletTile(Transform, const CodeHead&, std::span<std::string_view>,
                                ImageView<uint8_t>);
template bool DecodeWaveletTile(Transform, const CodeHead&, std::span<std::string_view>,
                                ImageView<uint16_t>);

template <class Pixel>
bool DecodeReducedTile(Transform transform, const CodeHead& head,
                       std::span<std::string_view> sections, int tile_width, int tile_height,
                       ImageView<Pixel> pixels) {
  const PlaneExtent tile = {tile_width, tile_height};
  if constexpr (sizeof(Pixel) == 1)
    if (head.coefficient_bytes == 2)
      return DecodeReducedAs<int16_t>(transform, head, sections, tile, pixels);
  return DecodeReducedAs<int32_t>(transform, head, sections, tile, pixels);
}
template bool DecodeReducedTile(Transform, const CodeHead&, std::span<std::string_view>, int, int,
                                ImageView<uint8_t>);
template bool DecodeReducedTile(Transform, const CodeHead&, std::span<std::string_view>, int, int,
                                ImageView<uint16_t>);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/wavelet_tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "lf/core/check.h"
#include "lf/pixels/codec/coefficient_coder.h"
#include "lf/pixels/codec/packing.h"
#include "lf/pixels/codec/rgb_planes.h"

namespace lf {
namespace {

// Number of fraction bits of lossy coefficients. They are needed because the transform always
// rounds down: its error has the same sign in every LF image, and therefore does not average out in
// a frame, which is a mean of many LF images. The noise of quantisation does average out. From the
// second level on, coefficients have kMostDoublings more fraction bits.
constexpr int kFractionBits = 3;
constexpr int kMostDoublings = 1;

// Returns true if coefficients of level `depth` are doubled before the next level transforms them:
// the low subband, or all four subbands if level `depth` splits a mosaic. Levels are counted from
// the finest, which is 1; only level 1 can split a mosaic.
bool IsDoubled(const CodeHead& head, int depth) {
  return head.info.profile == CodecProfile::kDefault && depth <= kMostDoublings;
}

// Returns the finest level that transforms components, as IsDoubled() counts levels. It is 2 for a
// mosaic, because level 1 splits the mosaic into its components.
int FirstDepth(const CodeHead& head) { return head.info.layout == PixelLayout::kMosaic ? 2 : 1; }

struct Size {
  int width = 0;
  int height = 0;
  size_t count() const { return static_cast<size_t>(width) * height; }
};

// ComponentSize() returns the size of a component of a tile. LowSize() returns the size of the low
// subband of a component of this size after `levels` levels.
Size ComponentSize(const CodeHead& head, int component, int tile_width, int tile_height) {
  if (head.info.layout != PixelLayout::kMosaic) return {tile_width, tile_height};
  const auto band = static_cast<Band>(component);
  return {BandWidth(band, tile_width), BandHeight(band, tile_height)};
}
Size LowSize(Size size, int levels) {
  for (int i = 0; i < levels; ++i) size = {LowCount(size.width), LowCount(size.height)};
  return size;
}

size_t DetailCount(Size size) { return size.count() - LowSize(size, 1).count(); }

// Number of strips that the bands of a resolution are coded in, in all components of a tile.
int StripCountOf(const CodeHead& head, Size tile, int resolution) {
  // The first component is the largest.
  const Size size = ComponentSize(head, 0, tile.width, tile.height);
  return StripCount(LowSize(size, head.info.levels + 1 - std::max(resolution, 1)).width);
}

Rounding RoundingOf(const CodeHead& head, int resolution) {
  return resolution == 0 || head.info.profile == CodecProfile::kLossless ? Rounding::kNearest
                                                                         : Rounding::kDeadZone;
}

// Returns the band of an approximation.
template <class T>
CoefficientBand<T> ApproximationBand(Size size, T* values) {
  return {values, size.width, size.height};
}

// Returns the bands of details, which follow each other in memory.
//   size     of the plane that was split into these bands
//   parents  details of the next coarser level; null if there are none
template <class T>
std::array<CoefficientBand<T>, 3> DetailBands(Size size, T* values,
                                              const std::remove_const_t<T>* parents) {
  std::array<CoefficientBand<T>, 3> bands;
  const Size coarser = LowSize(size, 1);
  size_t i = 0;
  for (const Band band : {kHighLow, kLowHigh, kHighHigh}) {
    CoefficientBand<T>& coded = bands[i++];
    coded.values = values;
    coded.width = BandWidth(band, size.width);
    coded.height = BandHeight(band, size.height);
    coded.kind = band == kHighLow   ? BandKind::kVertical
                 : band == kLowHigh ? BandKind::kHorizontal
                                    : BandKind::kEven;
    values += BandSize(band, size.width, size.height);
    if (parents == nullptr) continue;
    coded.parent = parents;
    coded.parent_width = BandWidth(band, coarser.width);
    coded.parent_height = BandHeight(band, coarser.height);
    parents += BandSize(band, coarser.width, coarser.height);
  }
  return bands;
}

int StepIndex(const CodeHead& head, int component, int resolution, bool is_diagonal) {
  const int first = component * (1 + 2 * head.info.levels);
  return resolution == 0 ? first : first + 2 * resolution - 1 + (is_diagonal ? 1 : 0);
}

// Returns the norm of the error in the image that an error of 1 in a coefficient causes: the
// product of the norms of both dimensions and of the colour transform. The coefficient is in a
// subband of level `level` of its component; level 1 is the finest.
double Norm(const CodeHead& head, int component, int level, bool high_across, bool high_down) {
  const auto along = [&](bool is_high, bool component_is_high) {
    std::vector<bool> path(level, false);
    path[0] = is_high;
    if (head.info.layout == PixelLayout::kMosaic) path.push_back(component_is_high);
    return SynthesisNorm(path);
  };
  const double of_colour = head.info.layout == PixelLayout::kRgb ? kRgbNorms[component] : 1;
  return of_colour * along(high_across, component == kHighLow || component == kHighHigh) *
         along(high_down, component == kLowHigh || component == kHighHigh);
}

// --- Encoding

// Returns the planes of the pixels less their prediction, or less the middle of the range of values
// if the prediction is empty.
template <class Pixel>
std::vector<std::vector<int32_t>> PlanesOf(const CodeHead& head, ImageView<const Pixel> pixels,
                                           ImageView<const Pixel> prediction) {
  const int channels = ChannelsOf(head.info.layout);
  const int32_t middle = 1 << (head.info.bits - 1);
  const size_t count = static_cast<size_t>(pixels.width) * pixels.height;
  std::vector<std::vector<int32_t>> planes(channels, std::vector<int32_t>(count + kSlack));
  for (int c = 0; c < channels; ++c) {
    int32_t* out = planes[c].data();
    for (int y = 0; y < pixels.height; ++y) {
      const Pixel* in = pixels.row(y) + c;
      if (prediction.empty()) {
        for (int x = 0; x < pixels.width; ++x, in += channels)
          *out++ = (int32_t{*in} - middle) << head.fraction_bits;
      } else {
        const Pixel* predicted = prediction.row(y) + c;
        for (int x = 0; x < pixels.width; ++x, in += channels, predicted += channels)
          *out++ = (int32_t{*in} - *predicted) * (1 << head.fraction_bits);
      }
    }
  }
  if (head.info.layout == PixelLayout::kRgb)
    SeparateColours(planes[0].data(), planes[1].data(), planes[2].data(), count);
  return planes;
}

// Splits a plane into its subbands, and doubles the low subband if is_doubled is true.
using BandPlanes = std::array<std::vector<int32_t>, kBands>;
BandPlanes Analyzed(Transform transform, const std::vector<int32_t>& plane, Size size,
                    bool is_doubled) {
  BandPlanes bands;
  std::array<int32_t*, kBands> pointers{};
  for (int b = 0; b < kBands; ++b) {
    bands[b].resize(BandSize(static_cast<Band>(b), size.width, size.height) + kSlack);
    pointers[b] = bands[b].data();
  }
  Analyze(transform, plane.data(), size.width, size.height, pointers);
  if (is_doubled)
    for (int32_t& value : bands[kLowLow]) value *= 2;
  return bands;
}

int32_t LargestOf(const std::vector<int32_t>& values, size_t count) {
  int32_t largest = 0;
  for (size_t i = 0; i < count; ++i) largest = std::max(largest, std::abs(values[i]));
  return largest;
}

// Appends for each of the first `count` values (|value| + rounding) / step, rounded down, with the
// sign of the value.
//   rounding  step / 2 rounds to the nearest; step / 3 makes values below two thirds of a step 0
void AppendQuantized(const std::vector<int32_t>& values, size_t count, int32_t step,
                     int32_t rounding, std::vector<int32_t>* out) {
  const size_t begin = out->size();
  out->resize(begin + count);
  int32_t* const to = out->data() + begin;
  if (step == 1) {
    std::copy_n(values.data(), count, to);
    return;
  }
  const float inverse = 1.0F / static_cast<float>(step);
  for (size_t i = 0; i < count; ++i) {
    const int32_t value = values[i];
    const auto level =
        static_cast<int32_t>(static_cast<float>(std::abs(value) + rounding) * inverse);
    to[i] = value < 0 ? -level : level;
  }
}

// Subtracts from each value the value above it, or, in the first row, the value to its left.
void Predict(Size size, std::vector<int32_t>* values) {
  const auto width = static_cast<size_t>(size.width);
  for (size_t i = size.count(); i-- > width;) (*values)[i] -= (*values)[i - width];
  for (size_t i = std::min(width, size.count()); i-- > 1;) (*values)[i] -= (*values)[i - 1];
}

// --- Decoding

template <class T>
void Unpredict(Size size, T* values) {
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
  TileReader(Transform transform, const CodeHead& head, Size tile,
             std::span<std::string_view> sections)
      : transform_(transform), head_(head), sections_(sections) {
    if (head.info.entropy == Entropy::kPacked) return;
    packets_.resize(sections.size());
    int count = 0;  // components that have values
    for (int c = 0; c < head.components(); ++c)
      count += ComponentSize(head, c, tile.width, tile.height).count() > 0 ? 1 : 0;
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
  [[nodiscard]] bool Read(int component, Size size, CodedBands<T>* finest) {
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
  [[nodiscard]] bool ReadLow(int component, Size size, int resolution, CodedBand<T>* low) {
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
  bool Begin(int component, Size size) {
    component_ = component;
    size_ = size;
    resolution_ = 0;
    const Size smallest = LowSize(size, head_.info.levels);
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
    const Size here = LowSize(size_, level() - 1);
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
    const Size here = {bands.width, bands.height};
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
  Size size_;
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
    const Size size = ComponentSize(head, c, pixels.width, pixels.height);
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
void CopyLow(const CodedBand<T>& low, Size size, int width, int height, T* plane) {
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
                     std::span<std::string_view> sections, Size tile, ImageView<Pixel> pixels) {
  const int resolution = static_cast<int>(sections.size()) - 1;
  const size_t count = static_cast<size_t>(pixels.width) * pixels.height;
  WaveletScratch<T>& scratch = WaveletScratch<T>::OfThread();
  TileReader<T> reader(transform, head, tile, sections);
  std::array<const T*, kBands> planes{};
  for (int c = 0; c < head.components(); ++c) {
    T* const plane = WaveletScratch<T>::Room(&scratch.components[c], count);
    planes[c] = plane;
    const Size size = ComponentSize(head, c, tile.width, tile.height);
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

void SetSteps(const CodecSettings& settings, CodeHead* head) {
  const CodeInfo& info = head->info;
  head->steps.assign(head->StepCount(), 1);
  head->fraction_bits = 0;
  if (info.profile == CodecProfile::kLossless) return;
  head->fraction_bits = kFractionBits;
  const double step = 1.5 * settings.threshold;
  for (int c = 0; c < head->components(); ++c)
    for (int resolution = 0; resolution <= info.levels; ++resolution)
      for (const bool is_diagonal : {false, true}) {
        const int level = resolution == 0 ? info.levels : info.levels + 1 - resolution;
        const int depth = FirstDepth(*head) + level - 1;
        const double unit = std::exp2(kFractionBits + std::min(depth - 1, kMostDoublings));
        const bool is_detail = resolution > 0;
        const double norm = Norm(*head, c, level, is_detail, is_detail && is_diagonal);
        const double exact = std::clamp(std::round(step * unit / norm), 1.0, 32767.0);
        head->steps[StepIndex(*head, c, resolution, is_diagonal)] = static_cast<int32_t>(exact);
      }
}

template <class Pixel>
QuantizedTile QuantizeTile(Transform transform, const CodeHead& head, ImageView<const Pixel> pixels,
                           ImageView<const Pixel> prediction) {
  const int levels = head.info.levels;
  std::vector<std::vector<int32_t>> planes = PlanesOf(head, pixels, prediction);
  if (head.info.layout == PixelLayout::kMosaic) {
    BandPlanes bands = Analyzed(transform, planes[0], {pixels.width, pixels.height}, false);
    planes.assign(std::make_move_iterator(bands.begin()), std::make_move_iterator(bands.end()));
    if (IsDoubled(head, 1))
      for (std::vector<int32_t>& plane : planes)
        for (int32_t& value : plane) value *= 2;
  }
  QuantizedTile tile{pixels.width, pixels.height, {}, 0};
  for (int c = 0; c < head.components(); ++c) {
    const Size whole = ComponentSize(head, c, pixels.width, pixels.height);
    const size_t first = tile.streams.size();
    tile.streams.resize(first + 1 + levels);
    if (whole.count() == 0) continue;
    std::vector<int32_t> low = std::move(planes[c]);
    for (int level = 1; level <= levels; ++level) {
      const int resolution = levels + 1 - level;
      const Size size = LowSize(whole, level - 1);
      const bool is_doubled = level < levels && IsDoubled(head, FirstDepth(head) + level - 1);
      BandPlanes bands = Analyzed(transform, low, size, is_doubled);
      for (const Band band : {kHighLow, kLowHigh, kHighHigh}) {
        const int32_t step = head.steps[StepIndex(head, c, resolution, band == kHighHigh)];
        const size_t count = BandSize(band, size.width, size.height);
        tile.largest = std::max(tile.largest, LargestOf(bands[band], count));
        AppendQuantized(bands[band], count, step, step / 3, &tile.streams[first + resolution]);
      }
      low = std::move(bands[kLowLow]);
      tile.largest = std::max(tile.largest, LargestOf(low, LowSize(size, 1).count()));
    }
    const int32_t step = head.steps[StepIndex(head, c, 0, false)];
    const Size smallest = LowSize(whole, levels);
    AppendQuantized(low, smallest.count(), step, step / 2, &tile.streams[first]);
    Predict(smallest, &tile.streams[first]);
  }
  return tile;
}
template QuantizedTile QuantizeTile(Transform, const CodeHead&, ImageView<const uint8_t>,
                                    ImageView<const uint8_t>);
template QuantizedTile QuantizeTile(Transform, const CodeHead&, ImageView<const uint16_t>,
                                    ImageView<const uint16_t>);

// The synthesis adds two values, each at most 2.5 times as large as the largest value of a subband.
// 2 * 2.5 * 6000 is within the range of int16_t.
bool FitsInTwoBytes(int32_t largest) { return largest <= 6000; }

namespace {

std::string PackedSection(const CodeHead& head, const QuantizedTile& tile, int resolution) {
  std::string code;
  for (int c = 0; c < head.components(); ++c) {
    const std::vector<int32_t>& stream = tile.streams[c * (1 + head.info.levels) + resolution];
    if (head.coefficient_bytes == 2)
      AppendCoefficients<int16_t>(stream, &code);
    else
      AppendCoefficients<int32_t>(stream, &code);
  }
  return code;
}

}  // namespace

std::string CodeOfSection(const CodeHead& head, const QuantizedTile& tile, int resolution) {
  if (head.info.entropy == Entropy::kPacked) return PackedSection(head, tile, resolution);
  const int levels = head.info.levels;
  const Size pixels = {tile.width, tile.height};
  PacketWriter writer(StripCountOf(head, pixels, resolution), RoundingOf(head, resolution));
  for (int c = 0; c < head.components(); ++c) {
    const Size whole = ComponentSize(head, c, pixels.width, pixels.height);
    if (whole.count() == 0) continue;
    const std::vector<int32_t>* const streams =
        &tile.streams[static_cast<size_t>(c) * (1 + levels)];
    const int32_t* const values = streams[resolution].data();
    if (resolution == 0) {
      writer.Append(std::array{ApproximationBand(LowSize(whole, levels), values)});
    } else {
      const int32_t* const parents = resolution > 1 ? streams[resolution - 1].data() : nullptr;
      writer.Append(DetailBands(LowSize(whole, levels - resolution), values, parents));
    }
  }
  return writer.Packet();
}

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
  const Size tile = {tile_width, tile_height};
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

// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/wavelet_tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lf/pixels/codec/coefficient_coder.h"
#include "lf/pixels/codec/packing.h"
#include "lf/pixels/codec/rgb_planes.h"
#include "lf/pixels/codec/tile_bands.h"

namespace lf {
namespace {

// Number of fraction bits of lossy coefficients. They are needed because the transform always
// rounds down: its error has the same sign in every LF image, and therefore does not average out in
// a frame, which is a mean of many LF images. The noise of quantisation does average out. From the
// second level on, coefficients have kMostDoublings more fraction bits.
constexpr int kFractionBits = 3;

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
BandPlanes Analyzed(Transform transform, const std::vector<int32_t>& plane, PlaneExtent size,
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
void Predict(PlaneExtent size, std::vector<int32_t>* values) {
  const auto width = static_cast<size_t>(size.width);
  for (size_t i = size.count(); i-- > width;) (*values)[i] -= (*values)[i - width];
  for (size_t i = std::min(width, size.count()); i-- > 1;) (*values)[i] -= (*values)[i - 1];
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
    const PlaneExtent whole = ComponentSize(head, c, {pixels.width, pixels.height});
    const size_t first = tile.streams.size();
    tile.streams.resize(first + 1 + levels);
    if (whole.count() == 0) continue;
    std::vector<int32_t> low = std::move(planes[c]);
    for (int level = 1; level <= levels; ++level) {
      const int resolution = levels + 1 - level;
      const PlaneExtent size = LowSize(whole, level - 1);
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
    const PlaneExtent smallest = LowSize(whole, levels);
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
  const PlaneExtent pixels = {tile.width, tile.height};
  PacketWriter writer(StripCountOf(head, pixels, resolution), RoundingOf(head, resolution));
  for (int c = 0; c < head.components(); ++c) {
    const PlaneExtent whole = ComponentSize(head, c, pixels);
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

}  // namespace lf

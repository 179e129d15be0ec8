// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/radiance_conversion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <variant>

#include "lf/core/check.h"

namespace lf {
namespace {

static_assert(std::endian::native == std::endian::little, "lane 0 is the low end of a word");
constexpr uint64_t kOneRay = uint64_t{1} << (16 * LfPixels::kRayLane);

void StorePixel(uint64_t lanes, uint16_t* out) { std::memcpy(out, &lanes, sizeof(lanes)); }

// The pixels to which values are converted. rows_done is the argument of ConvertRadiance().
struct Converted {
  LfPixels* pixels;
  const RowsDone& rows_done;
};

// Bytes of converted rows between two calls of rows_done(): few enough to be in the caches still,
// and enough that the calls take little time.
constexpr int kBytesAtOnce = 128 << 10;

// Calls convert_row(y, in, out, width) for each row y of to.pixels->rect.
template <class T, class Row>
void ForEachRow(const Image<T>& stored, const PixelRect& stored_rect, const Converted& to,
                const Row& convert_row) {
  const PixelRect rect = to.pixels->rect;
  LF_CHECK(Intersection(rect, stored_rect) == rect);
  const size_t first = static_cast<size_t>(rect.x_begin - stored_rect.x_begin) * stored.channels();
  const int rows_at_once = std::max(1, kBytesAtOnce / std::max(1, 8 * rect.width()));
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    convert_row(y, stored.row(y - stored_rect.y_begin) + first,
                to.pixels->radiance.row(y - rect.y_begin), rect.width());
    const int row_count = y + 1 - rect.y_begin;
    if (to.rows_done && (row_count % rows_at_once == 0 || y + 1 == rect.y_end))
      to.rows_done(row_count);
  }
}

uint64_t Lanes(uint16_t r, uint16_t g, uint16_t b) {
  return uint64_t{r} | uint64_t{g} << 16 | uint64_t{b} << 32 | kOneRay;
}

// Converts each stored value to its radiance, which v_of(channel, value) returns.
template <class T, class ValueOf>
void ConvertByValue(const Image<T>& stored, const PixelRect& stored_rect, int colours,
                    const ValueOf& v_of, const Converted& to) {
  const int channels = stored.channels();
  const LfPixels* const pixels = to.pixels;
  if (pixels->bayer != BayerPattern::kNone) {
    ForEachRow(stored, stored_rect, to, [&](int y, const T* in, uint16_t* out, int width) {
      const int begin = pixels->rect.x_begin;
      const int of_columns[2] = {BayerChannel(pixels->bayer, begin, y),
                                 BayerChannel(pixels->bayer, begin + 1, y)};
      for (int x = 0; x < width; ++x) out[x] = v_of(of_columns[x % 2], in[x]);
    });
    return;
  }
  const int second = colours == 1 ? 0 : 1, third = colours == 1 ? 0 : 2;
  ForEachRow(stored, stored_rect, to, [&](int, const T* in, uint16_t* out, int width) {
    for (int x = 0; x < width; ++x, in += channels, out += LfPixels::kRgbLanes)
      StorePixel(Lanes(v_of(0, in[0]), v_of(1, in[second]), v_of(2, in[third])), out);
  });
}

// Converts 8-bit RGB by a table look-up and an | for each colour, and a single store for each
// pixel.
void ConvertByLanes(const Image<uint8_t>& stored, const PixelRect& stored_rect,
                    const LaneTable& lanes, const Converted& to) {
  const int channels = stored.channels();
  ForEachRow(stored, stored_rect, to, [&](int, const uint8_t* in, uint16_t* out, int width) {
    for (int x = 0; x < width; ++x, in += channels, out += LfPixels::kRgbLanes)
      StorePixel(lanes[0][in[0]] | lanes[1][in[1]] | lanes[2][in[2]], out);
  });
}

// Computes QuantizeRadiance() inline, bit-identical to it, for light that is not NaN.
class Quantizer {
 public:
  explicit Quantizer(const RadianceEncoding& encoding)
      : most_(encoding.max_radiance), scale_(encoding.Scale()), pedestal_(encoding.pedestal) {}

  uint16_t operator()(double light, double gain) const {
    const double v = std::clamp(std::min(light * gain, most_) * scale_, -kFarOut, kFarOut);
    const auto whole = static_cast<int32_t>(v);  // rounded towards 0, so that the rest is exact
    const double rest = v - whole;
    const int32_t rounded = whole + (rest >= 0.5) - (rest <= -0.5);
    return static_cast<uint16_t>(
        static_cast<int32_t>(std::clamp(rounded + pedestal_, 0.0, 65535.0)));
  }

 private:
  static constexpr double kFarOut = 200000;  // beyond all 16-bit values and pedestals
  double most_, scale_, pedestal_;
};

// Computes the falloff of each pixel of a row, bit-identical to
// Vignetting::Falloff(RadiusSquared()).
class RowFalloff {
 public:
  RowFalloff(const Intrinsics& k, int begin, int width)
      : k_(k), begin_(begin), falloff_(static_cast<size_t>(width)) {}

  const std::vector<double>& Of(int y) {
    const double dy = y + 0.5 - k_.cy_px, width = k_.width_px, height = k_.height_px;
    const double diagonal = width * width + height * height;
    const Vignetting vignetting = k_.vignetting;
    for (size_t i = 0; i < falloff_.size(); ++i) {
      const double dx = begin_ + static_cast<int>(i) + 0.5 - k_.cx_px;
      falloff_[i] = vignetting.Falloff(4 * (dx * dx + dy * dy) / diagonal);
    }
    return falloff_;
  }

 private:
  const Intrinsics& k_;
  const int begin_;
  std::vector<double> falloff_;
};

// Converts each stored value to radiance, multiplied by the gain and divided by the falloff.
// light_of(value) returns the radiance before gain and falloff, which is never NaN.
template <class T, class LightOf>
void ConvertWithFalloff(const Image<T>& stored, const PixelRect& stored_rect, int colours,
                        const LightOf& light_of, const RadianceEncoding& encoding,
                        const ChannelGains& gains, const Intrinsics& k, const Converted& to) {
  const LfPixels* const pixels = to.pixels;
  const int channels = stored.channels(), begin = pixels->rect.x_begin;
  const bool is_mosaic = pixels->bayer != BayerPattern::kNone;
  const Quantizer quantize(encoding);
  RowFalloff falloffs(k, begin, pixels->rect.width());
  std::vector<double> light(static_cast<size_t>(pixels->rect.width()));
  std::vector<uint16_t> values(light.size());
  ForEachRow(stored, stored_rect, to, [&](int y, const T* in, uint16_t* out, int width) {
    const std::vector<double>& falloff = falloffs.Of(y);
    const auto end = static_cast<size_t>(width);
    if (is_mosaic) {
      for (size_t i = 0; i < end; ++i) {
        const int channel = BayerChannel(pixels->bayer, begin + static_cast<int>(i), y);
        out[i] = quantize(light_of(in[i]), gains[static_cast<size_t>(channel)] / falloff[i]);
      }
      return;
    }
    for (size_t c = 0; c < 3; ++c) {
      const T* const of_channel = in + (colours == 1 ? 0 : c);
      for (size_t i = 0; i < end; ++i)
        light[i] = light_of(of_channel[i * static_cast<size_t>(channels)]);
      const double gain = gains[c];
      for (size_t i = 0; i < end; ++i) values[i] = quantize(light[i], gain / falloff[i]);
      for (size_t i = 0; i < end; ++i) out[i * LfPixels::kRgbLanes + c] = values[i];
    }
    for (size_t i = 0; i < end; ++i) out[i * LfPixels::kRgbLanes + LfPixels::kRayLane] = 1;
  });
}

void ConvertFalloff(const ImagePart& part, int colours, const RadianceEncoding& encoding,
                    const ChannelGains& gains, const Intrinsics& k, const Converted& to) {
  std::visit(
      [&]<class T>(const Image<T>& stored) {
        if constexpr (std::is_floating_point_v<T>) {
          ConvertWithFalloff(
              stored, part.rect, colours,
              [](T value) -> double { return std::isnan(value) ? 0 : value; }, encoding, gains, k,
              to);
        } else {
          const std::vector<double> light = LightTable(encoding, int{8 * sizeof(T)});
          ConvertWithFalloff(
              stored, part.rect, colours, [&light](T value) { return light[value]; }, encoding,
              gains, k, to);
        }
      },
      part.image);
}

void ConvertByTables(const ImagePart& part, int colours, const RadianceTables& tables,
                     const RadianceEncoding& encoding, const ChannelGains& gains,
                     const Converted& to) {
  if (const auto* floats = std::get_if<Image<float>>(&part.image)) {
    ConvertByValue(
        *floats, part.rect, colours,
        [&](int c, float radiance) {
          return QuantizeRadiance(encoding, radiance, gains[static_cast<size_t>(c)]);
        },
        to);
    return;
  }
  const auto convert = [&](const auto& image, const std::array<const uint16_t*, 3>& of_channels) {
    ConvertByValue(
        image, part.rect, colours,
        [of_channels](int c, auto value) { return of_channels[static_cast<size_t>(c)][value]; },
        to);
  };
  if (const auto* words = std::get_if<Image<uint16_t>>(&part.image)) {
    convert(*words, {tables.of_16bit(0), tables.of_16bit(1), tables.of_16bit(2)});
    return;
  }
  const auto& bytes = std::get<Image<uint8_t>>(part.image);
  if (colours == 3 && to.pixels->bayer == BayerPattern::kNone)
    ConvertByLanes(bytes, part.rect, tables.lanes(), to);
  else
    convert(bytes, {tables.of_8bit(0), tables.of_8bit(1), tables.of_8bit(2)});
}

std::vector<std::vector<uint16_t>> TablesThatFit(const RadianceEncoding& encoding, int bits,
                                                 const ChannelGains& gains) {
  std::vector<std::vector<uint16_t>> tables;
  if (!LevelsFit(encoding, bits)) return tables;
  for (size_t c = 0; c < (gains.are_equal() ? 1 : 3); ++c)
    tables.push_back(RadianceTable(encoding, bits, gains[c]));
  return tables;
}

}  // namespace

RadianceTables::RadianceTables(const RadianceEncoding& encoding, const ChannelGains& gains,
                               int bits) {
  if (bits == 16) of_16bit_ = TablesThatFit(encoding, 16, gains);
  if (bits != 8) return;
  of_8bit_ = TablesThatFit(encoding, 8, gains);
  if (of_8bit_.empty()) return;
  for (size_t value = 0; value < lanes_[0].size(); ++value)
    for (size_t c = 0; c < lanes_.size(); ++c)
      lanes_[c][value] =
          uint64_t{of_8bit(static_cast<int>(c))[value]} << (16 * c) | (c == 0 ? kOneRay : 0);
}

RadianceTables::RadianceTables(const RadianceEncoding& encoding, const ChannelGains& gains)
    : RadianceTables(encoding, gains, 8) {
  of_16bit_ = TablesThatFit(encoding, 16, gains);
}

void ConvertRadiance(const ImagePart& part, int colours, const RadianceTables& plain,
                     const RadianceEncoding& encoding, const LfCamera& camera, const Intrinsics& k,
                     LfPixels* pixels, const RowsDone& rows_done) {
  const ChannelGains& gains = camera.gain;
  const Converted to = {pixels, rows_done};
  if (!k.vignetting.is_none()) {
    ConvertFalloff(part, colours, encoding, gains, k, to);
    return;
  }
  if (gains == ChannelGains()) {
    ConvertByTables(part, colours, plain, encoding, gains, to);
    return;
  }
  const int bits =
      std::visit([]<class T>(const Image<T>&) { return int{8 * sizeof(T)}; }, part.image);
  ConvertByTables(part, colours, RadianceTables(encoding, gains, bits), encoding, gains, to);
}

}  // namespace lf

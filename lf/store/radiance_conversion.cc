#include "lf/store/radiance_conversion.h"

#include <bit>
#include <cstring>
#include <variant>

#include "lf/core/check.h"

namespace lf {
namespace {

static_assert(std::endian::native == std::endian::little, "lane 0 is the low end of a word");
constexpr uint64_t kOneRay = uint64_t{1} << (16 * LfPixels::kRayLane);
constexpr uint64_t kGrey = 0x0000'0001'0001'0001;

void StorePixel(uint64_t lanes, uint16_t* out) { std::memcpy(out, &lanes, sizeof(lanes)); }

// rows(in, out, width) converts one row.
template <class T, class Row>
void ForEachRow(const Image<T>& stored, const PixelRect& stored_rect, LfPixels* pixels,
                const Row& convert_row) {
  const PixelRect& rect = pixels->rect;
  LF_CHECK(Intersection(rect, stored_rect) == rect);
  const size_t first = static_cast<size_t>(rect.x_begin - stored_rect.x_begin) * stored.channels();
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    convert_row(stored.row(y - stored_rect.y_begin) + first, pixels->radiance.row(y - rect.y_begin),
                rect.width());
}

// v_of(value) is the radiance of a stored value.
template <class T, class ValueOf>
void ConvertByValue(const Image<T>& stored, const PixelRect& stored_rect, int colours,
                    const ValueOf& v_of, LfPixels* pixels) {
  const int channels = stored.channels();
  if (pixels->bayer != BayerPattern::kNone) {
    ForEachRow(stored, stored_rect, pixels, [&](const T* in, uint16_t* out, int width) {
      for (int x = 0; x < width; ++x) out[x] = v_of(in[x]);
    });
    return;
  }
  if (colours == 1) {
    ForEachRow(stored, stored_rect, pixels, [&](const T* in, uint16_t* out, int width) {
      for (int x = 0; x < width; ++x, in += channels, out += LfPixels::kRgbLanes)
        StorePixel(v_of(in[0]) * kGrey | kOneRay, out);
    });
    return;
  }
  ForEachRow(stored, stored_rect, pixels, [&](const T* in, uint16_t* out, int width) {
    for (int x = 0; x < width; ++x, in += channels, out += LfPixels::kRgbLanes)
      StorePixel(uint64_t{v_of(in[0])} | uint64_t{v_of(in[1])} << 16 | uint64_t{v_of(in[2])} << 32 |
                     kOneRay,
                 out);
  });
}

// One look-up and one | a colour, one store a pixel.
void ConvertByLanes(const Image<uint8_t>& stored, const PixelRect& stored_rect,
                    const LaneTable& lanes, LfPixels* pixels) {
  const int channels = stored.channels();
  ForEachRow(stored, stored_rect, pixels, [&](const uint8_t* in, uint16_t* out, int width) {
    for (int x = 0; x < width; ++x, in += channels, out += LfPixels::kRgbLanes)
      StorePixel(lanes[0][in[0]] | lanes[1][in[1]] | lanes[2][in[2]], out);
  });
}

std::vector<uint16_t> TableIfItFits(const RadianceEncoding& encoding, int bits, double gain) {
  return LevelsFit(encoding, bits) ? RadianceTable(encoding, bits, gain) : std::vector<uint16_t>();
}

void ConvertByTables(const ImagePart& part, int colours, const RadianceTables& tables,
                     const RadianceEncoding& encoding, double gain, LfPixels* pixels) {
  if (const auto* floats = std::get_if<Image<float>>(&part.image)) {
    ConvertByValue(
        *floats, part.rect, colours,
        [&](float radiance) { return QuantizeRadiance(encoding, radiance, gain); }, pixels);
    return;
  }
  if (const auto* words = std::get_if<Image<uint16_t>>(&part.image)) {
    const uint16_t* table = tables.of_16bit().data();
    ConvertByValue(
        *words, part.rect, colours, [table](uint16_t value) { return table[value]; }, pixels);
    return;
  }
  const auto& bytes = std::get<Image<uint8_t>>(part.image);
  if (colours == 3 && pixels->bayer == BayerPattern::kNone) {
    ConvertByLanes(bytes, part.rect, tables.lanes(), pixels);
    return;
  }
  const uint16_t* table = tables.of_8bit().data();
  ConvertByValue(
      bytes, part.rect, colours, [table](uint8_t value) { return table[value]; }, pixels);
}

}  // namespace

RadianceTables::RadianceTables(const RadianceEncoding& encoding, double gain, int bits) {
  if (bits == 16) of_16bit_ = TableIfItFits(encoding, 16, gain);
  if (bits != 8) return;
  of_8bit_ = TableIfItFits(encoding, 8, gain);
  for (size_t value = 0; value < of_8bit_.size(); ++value)
    for (size_t c = 0; c < lanes_.size(); ++c)
      lanes_[c][value] = uint64_t{of_8bit_[value]} << (16 * c) | (c == 0 ? kOneRay : 0);
}

RadianceTables::RadianceTables(const RadianceEncoding& encoding, double gain)
    : RadianceTables(encoding, gain, 8) {
  of_16bit_ = TableIfItFits(encoding, 16, gain);
}

void ConvertRadiance(const ImagePart& part, int colours, const RadianceTables& plain,
                     const RadianceEncoding& encoding, double gain, LfPixels* pixels) {
  if (gain == 1) {
    ConvertByTables(part, colours, plain, encoding, gain, pixels);
    return;
  }
  const int bits =
      std::visit([]<class T>(const Image<T>&) { return int{8 * sizeof(T)}; }, part.image);
  ConvertByTables(part, colours, RadianceTables(encoding, gain, bits), encoding, gain, pixels);
}

}  // namespace lf

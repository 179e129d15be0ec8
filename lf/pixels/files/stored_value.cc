#include "lf/pixels/files/stored_value.h"

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace lf {
namespace {

template <class T>
void Widen(const std::byte* values, size_t step, size_t count, float* to, size_t to_step) {
  for (size_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, values + i * step, sizeof(T));
    to[i * to_step] = static_cast<float>(value);
  }
}

// Calls OpenImageIO once for all values, so they are copied into a contiguous array.
void HalvesToFloats(const std::byte* values, size_t step, size_t count, float* to, size_t to_step) {
  std::vector<uint16_t> halves(count);
  for (size_t i = 0; i < count; ++i) std::memcpy(&halves[i], values + i * step, sizeof(uint16_t));
  std::vector<float> floats(count);
  OIIO::convert_pixel_values(OIIO::TypeDesc::HALF, halves.data(), OIIO::TypeDesc::FLOAT,
                             floats.data(), static_cast<int>(count));
  for (size_t i = 0; i < count; ++i) to[i * to_step] = floats[i];
}

}  // namespace

void FloatsOf(OIIO::TypeDesc type, const std::byte* values, size_t step, size_t count, float* to,
              size_t to_step) {
  switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
      return Widen<uint8_t>(values, step, count, to, to_step);
    case OIIO::TypeDesc::INT8:
      return Widen<int8_t>(values, step, count, to, to_step);
    case OIIO::TypeDesc::UINT16:
      return Widen<uint16_t>(values, step, count, to, to_step);
    case OIIO::TypeDesc::INT16:
      return Widen<int16_t>(values, step, count, to, to_step);
    case OIIO::TypeDesc::UINT32:
      return Widen<uint32_t>(values, step, count, to, to_step);
    case OIIO::TypeDesc::INT32:
      return Widen<int32_t>(values, step, count, to, to_step);
    case OIIO::TypeDesc::UINT64:
      return Widen<uint64_t>(values, step, count, to, to_step);
    case OIIO::TypeDesc::INT64:
      return Widen<int64_t>(values, step, count, to, to_step);
    case OIIO::TypeDesc::FLOAT:
      return Widen<float>(values, step, count, to, to_step);
    case OIIO::TypeDesc::DOUBLE:
      return Widen<double>(values, step, count, to, to_step);
    default:
      return HalvesToFloats(values, step, count, to, to_step);
  }
}

void StoreHalves(const float* values, size_t step, size_t count, std::byte* to, size_t to_step) {
  std::vector<float> floats(count);
  for (size_t i = 0; i < count; ++i) floats[i] = values[i * step];
  std::vector<uint16_t> halves(count);
  OIIO::convert_pixel_values(OIIO::TypeDesc::FLOAT, floats.data(), OIIO::TypeDesc::HALF,
                             halves.data(), static_cast<int>(count));
  for (size_t i = 0; i < count; ++i) std::memcpy(to + i * to_step, &halves[i], sizeof(uint16_t));
}

}  // namespace lf

#include "lf/imageio/stored_value.h"

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <cstring>

namespace lf {
namespace {

template <class T>
float ValueAt(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<float>(value);
}

}  // namespace

float FloatOf(OIIO::TypeDesc type, const std::byte* bytes) {
  switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
      return ValueAt<uint8_t>(bytes);
    case OIIO::TypeDesc::INT8:
      return ValueAt<int8_t>(bytes);
    case OIIO::TypeDesc::UINT16:
      return ValueAt<uint16_t>(bytes);
    case OIIO::TypeDesc::INT16:
      return ValueAt<int16_t>(bytes);
    case OIIO::TypeDesc::UINT32:
      return ValueAt<uint32_t>(bytes);
    case OIIO::TypeDesc::INT32:
      return ValueAt<int32_t>(bytes);
    case OIIO::TypeDesc::UINT64:
      return ValueAt<uint64_t>(bytes);
    case OIIO::TypeDesc::INT64:
      return ValueAt<int64_t>(bytes);
    default:
      break;
  }
  float value = 0;
  OIIO::convert_pixel_values(type, bytes, OIIO::TypeDesc::FLOAT, &value, 1);
  return value;
}

}  // namespace lf

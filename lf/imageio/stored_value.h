// Stored values of any type as floats, and floats as halves. Internal to this folder.
#pragma once

#include <OpenImageIO/typedesc.h>

#include <cstddef>

namespace lf {

// to[i * to_step], for i < count, from the value `step` bytes after the one before. The values
// themselves: OpenImageIO would scale integers to [0, 1].
void FloatsOf(OIIO::TypeDesc type, const std::byte* values, size_t step, size_t count, float* to,
              size_t to_step);

// The halves nearest to values[i * step], each `to_step` bytes after the one before.
void StoreHalves(const float* values, size_t step, size_t count, std::byte* to, size_t to_step);

}  // namespace lf

// Converts stored values of any type to floats, and floats to halves. Internal to this folder.
#pragma once

#include <OpenImageIO/typedesc.h>

#include <cstddef>

namespace lf {

// Sets to[i * to_step], for i < count, to the stored value `step` bytes after the one before. The
// numbers stay as they are, while OpenImageIO would scale integers to [0, 1].
void FloatsOf(OIIO::TypeDesc type, const std::byte* values, size_t step, size_t count, float* to,
              size_t to_step);

// Stores the halves nearest to values[i * step], with `to_step` bytes from one to the next.
void StoreHalves(const float* values, size_t step, size_t count, std::byte* to, size_t to_step);

}  // namespace lf

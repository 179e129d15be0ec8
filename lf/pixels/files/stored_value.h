// Converts stored values of any type to floats, and floats to halves. Internal to this folder.
#pragma once

#include <OpenImageIO/typedesc.h>

#include <cstddef>

namespace lf {

// Converts `count` stored values, which are `step` bytes apart, to floats. Value i becomes
// to[i * to_step]. The numbers stay as they are, while OpenImageIO would scale integers to [0, 1].
void FloatsOf(OIIO::TypeDesc type, const std::byte* values, size_t step, size_t count, float* to,
              size_t to_step);

// Stores `count` halves, `to_step` bytes apart: half i is the one nearest to values[i * step].
void StoreHalves(const float* values, size_t step, size_t count, std::byte* to, size_t to_step);

}  // namespace lf

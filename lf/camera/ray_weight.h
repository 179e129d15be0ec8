// How much a ray counts (doc/ray.md, "What is added").
#pragma once

#include <cstdint>

namespace lf {

// Weights are integers, the part of the lens that the ray's LF camera stands for: sum += weight v,
// count += weight.
inline constexpr uint32_t kMaxWeight = 255;

}  // namespace lf

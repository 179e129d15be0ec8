// The list LightField::intrinsics while it grows. For the readers of calibrations.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "lf/camera/pinhole.h"
#include "lf/core/distinct.h"
#include "lf/core/hash.h"

namespace lf {

// Of numbers; both zeros are one.
template <size_t kCount>
uint64_t HashOfNumbers(std::array<double, kCount> numbers) {
  for (double& x : numbers) x += 0.0;
  return HashBytes({reinterpret_cast<const char*>(numbers.data()), sizeof(numbers)});
}

inline uint64_t HashOfIntrinsics(const Intrinsics& k) {
  std::array<double, 8 + std::tuple_size_v<DistortionParameters> + 3> numbers = {
      k.fx_px,
      k.fy_px,
      k.cx_px,
      k.cy_px,
      k.skew_px,
      static_cast<double>(k.width_px),
      static_cast<double>(k.height_px),
      static_cast<double>(k.distortion.model)};
  std::copy(k.distortion.parameters.begin(), k.distortion.parameters.end(), numbers.begin() + 8);
  std::copy(k.vignetting.v.begin(), k.vignetting.v.end(), numbers.end() - 3);
  return HashOfNumbers(numbers);
}

using DistinctIntrinsics = Distinct<Intrinsics, HashOfIntrinsics>;

}  // namespace lf

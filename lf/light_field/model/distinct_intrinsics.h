// SPDX-License-Identifier: Apache-2.0
// Collects LightField::intrinsics while a calibration is read: equal intrinsics are stored once.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "lf/camera/intrinsics_numbers.h"
#include "lf/camera/pinhole.h"
#include "lf/core/distinct.h"
#include "lf/core/hash.h"

namespace lf {

// Returns a hash of the numbers. +0 and -0 have the same hash.
template <size_t kCount>
uint64_t HashOfNumbers(std::array<double, kCount> numbers) {
  for (double& x : numbers) x += 0.0;
  return HashBytes({reinterpret_cast<const char*>(numbers.data()), sizeof(numbers)});
}

inline uint64_t HashOfIntrinsics(const Intrinsics& k) {
  constexpr size_t kOfPlate = kIntrinsicsNumbers,
                   kOfDistortion = std::tuple_size_v<DistortionParameters>;
  std::array<double, kOfPlate + 1 + kOfDistortion + 3> numbers;
  const std::array<double, kOfPlate> plate = NumbersOfIntrinsics(k);
  auto end = std::copy(plate.begin(), plate.end(), numbers.begin());
  *end++ = static_cast<double>(k.distortion.model);
  end = std::copy(k.distortion.parameters.begin(), k.distortion.parameters.end(), end);
  std::copy(k.vignetting.v.begin(), k.vignetting.v.end(), end);
  return HashOfNumbers(numbers);
}

using DistinctIntrinsics = Distinct<Intrinsics, HashOfIntrinsics>;

}  // namespace lf

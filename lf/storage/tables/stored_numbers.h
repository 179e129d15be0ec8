// SPDX-License-Identifier: Apache-2.0
// Converts numbers to and from blobs (least significant byte first) and text, and checks the
// numbers of packages and packed stores against limits. The readers of calibration files and camera
// paths have the same limits.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"

namespace lf {

static_assert(std::endian::native == std::endian::little);

template <class Number>
std::string BytesOf(std::span<const Number> numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()};
}

// Returns the numbers that the bytes hold. Ignores an incomplete number at the end.
template <class Number>
std::vector<Number> NumbersOf(std::string_view bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}

// Count of the numbers of a pose: 9 of the rotation, row by row, then 3 of the translation.
inline constexpr size_t kPoseNumbers = 12;
std::array<double, kPoseNumbers> NumbersOfPose(const RigidTransform& pose);
RigidTransform PoseOfNumbers(std::span<const double, kPoseNumbers> numbers);

// Returns the numbers of a text, separated by single spaces; none for an empty text; nullopt if a
// word is not a finite number.
std::optional<std::vector<double>> ParseNumbers(const std::string& text);

// Limits, all inclusive: width and height of an LF image, its number of pixels, the number of LF
// images, and the absolute value of other numbers.
inline constexpr int64_t kMostSide_px = 65536;
inline constexpr int64_t kMostPixels = int64_t{1} << 30;
inline constexpr int64_t kMostImages = int64_t{1} << 24;
inline constexpr double kMostNumber = 1e12;

inline bool IsWithin(double value, double low, double high) {
  return value >= low && value <= high;
}
bool IsPose(const RigidTransform& pose);
// True if focal lengths, principal point, skew and number of pixels are within plausible limits.
// Does not check the distortion.
bool IsCamera(const Intrinsics& k);
bool IsStoredDistortion(const Distortion& distortion);

}  // namespace lf

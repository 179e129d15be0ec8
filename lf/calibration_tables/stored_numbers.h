// Numbers in blobs, the least byte first; and what is believed of numbers that a file holds: as the
// readers of calibrations and paths allow.
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

// As many as fit in.
template <class Number>
std::vector<Number> NumbersOf(std::string_view bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}

// Rotation by rows, translation.
inline constexpr size_t kPoseNumbers = 12;
std::array<double, kPoseNumbers> NumbersOfPose(const RigidTransform& pose);
RigidTransform PoseOfNumbers(std::span<const double, kPoseNumbers> numbers);

// Numbers of a text, separated by spaces; none if one is none.
std::optional<std::vector<double>> ParseNumbers(const std::string& text);

inline constexpr int64_t kMostSide_px = 65536;
inline constexpr int64_t kMostPixels = int64_t{1} << 30;
inline constexpr int64_t kMostImages = int64_t{1} << 24;
inline constexpr double kMostNumber = 1e12;

inline bool IsWithin(double value, double low, double high) {
  return value >= low && value <= high;
}
bool IsPose(const RigidTransform& pose);
// Without its distortion.
bool IsCamera(const Intrinsics& k);
bool IsStoredDistortion(const Distortion& distortion);

}  // namespace lf

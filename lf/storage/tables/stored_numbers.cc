// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/tables/stored_numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lf {
namespace {

bool IsRotation(const Mat3& r) {
  return r.allFinite() && (r * r.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-6;
}

}  // namespace

std::array<double, kPoseNumbers> NumbersOfPose(const RigidTransform& pose) {
  std::array<double, kPoseNumbers> numbers;
  size_t i = 0;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) numbers[i++] = pose.rotation(row, column);
  for (int row = 0; row < 3; ++row) numbers[i++] = pose.translation[row];
  return numbers;
}

RigidTransform PoseOfNumbers(std::span<const double, kPoseNumbers> numbers) {
  RigidTransform pose;
  size_t i = 0;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) pose.rotation(row, column) = numbers[i++];
  for (int row = 0; row < 3; ++row) pose.translation[row] = numbers[i++];
  return pose;
}

std::optional<std::vector<double>> ParseNumbers(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    double number = 0;
    const auto [rest, error] = std::from_chars(at, end, number);
    if (error != std::errc{} || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
    at = rest;
    if (at != end && *at++ != ' ') return std::nullopt;
  }
  return numbers;
}

bool IsPose(const RigidTransform& pose) {
  return IsRotation(pose.rotation) && pose.translation.allFinite() &&
         pose.translation.cwiseAbs().maxCoeff() <= kMostNumber;
}

bool IsCamera(const Intrinsics& k) {
  return IsWithin(std::abs(k.fx_px), 1e-6, 1e9) && IsWithin(std::abs(k.fy_px), 1e-6, 1e9) &&
         std::abs(k.cx_px) <= 1e9 && std::abs(k.cy_px) <= 1e9 && std::abs(k.skew_px) <= 1e9 &&
         int64_t{k.width_px} * k.height_px <= kMostPixels;
}

bool IsStoredDistortion(const Distortion& distortion) {
  return IsDistortion(distortion) &&
         std::all_of(distortion.parameters.begin(), distortion.parameters.end(),
                     [](double p) { return std::abs(p) <= 1e6; });
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Finds the pixels of one image in another one, if the scene is a plane: the homographies that
// planes of constant depth induce between two pinhole cameras (thesis 2.2), in integers. The
// encoder makes them from a calibration and writes them down. A decoder computes with integers
// alone, so that it finds the same positions on every machine.
//
// Planes are perpendicular to the optical axis of the target, the camera whose image is predicted.
// Their inverse depths are evenly spaced and have an index d, 0 to kDepthSteps - 1. The pixel (x,
// y) of the target lies in the reference image at
//
//   (u / w, v / w)    with (u, v, w) = far * (x, y, 1) + d * step
//
// because the plane of inverse depth r induces K_r (R + r t (0 0 1)) K^-1: only the last column
// depends on r. Positions are pixel indices: the centre of pixel (3, 2) is (3, 2).
//
// Lenses with distortion have no such homography; their images are resampled first, or are not
// predicted. A file states the kind of its warps, so that others can be added.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "lf/core/geometry.h"

namespace lf {

inline constexpr int kDepthSteps = 64;
inline constexpr int kMostPredictedSide = 1 << 15;  // width and height of predicted images

// Numbers of a warp are fractions with kWarpBits bits. With the limits below, positions up to
// kMostPredictedSide + 64 pixels from the origin are computed in 64 bits without overflow, for any
// depth index.
inline constexpr int kWarpBits = 28;
inline constexpr int64_t kMostSlope = int64_t{1} << 33;   // magnitude of far[.][0] and far[.][1]
inline constexpr int64_t kMostOrigin = int64_t{1} << 49;  // magnitude of far[.][2]
inline constexpr int64_t kMostStep = int64_t{1} << 43;    // magnitude of step[.]

struct PlaneWarp {
  std::array<std::array<int64_t, 3>, 3> far{};  // homography of depth index 0
  std::array<int64_t, 3> step{};
  friend bool operator==(const PlaneWarp&, const PlaneWarp&) = default;
};

// The warp that leaves every pixel where it is.
PlaneWarp IdentityWarp();

// Returns true if all numbers are within the limits above.
bool IsWithinLimits(const PlaneWarp& warp);

// A pinhole camera without distortion.
struct PinholeView {
  Mat3 intrinsics = Mat3::Identity();  // K, for continuous pixel coordinates (doc/conventions.md)
  RigidTransform cam_from_world;
};

// Returns the camera of the picture whose pixels are squares of 2 x 2 pixels of the view's. Mosaics
// are predicted as such pictures (predict.h).
PinholeView Halved(const PinholeView& view);

// Inverse depths along the optical axis of the target, in 1 / world units. Depth index 0 stands for
// `least`, kDepthSteps - 1 for `greatest`.
struct InverseDepthRange {
  double least = 0;
  double greatest = 0;
};

// Returns the warp from the target to the reference image. Returns nothing if its numbers exceed
// the limits, as for cameras that look in opposite directions.
std::optional<PlaneWarp> MakePlaneWarp(const PinholeView& target, const PinholeView& reference,
                                       const InverseDepthRange& depths);

// Positions and displacements of positions have kPositionBits fraction bits.
inline constexpr int kPositionBits = 10;
struct WarpedPosition {
  int32_t x = 0;
  int32_t y = 0;
  friend bool operator==(const WarpedPosition&, const WarpedPosition&) = default;
};

// Returns the position of the target's pixel (x, y) in the reference image: u / w and v / w,
// rounded to the nearest, halves up, and clipped to +-2^16 pixels. Pixels with w <= 0, which are
// behind the camera of the reference image, stay where they are.
//   warp   within its limits
//   depth  0 to kDepthSteps - 1
//   x, y   -64 to kMostPredictedSide + 64
WarpedPosition Warped(const PlaneWarp& warp, int depth, int x, int y);

}  // namespace lf

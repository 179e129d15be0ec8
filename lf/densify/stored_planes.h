// SPDX-License-Identifier: Apache-2.0
// Converts depth planes between working images and LF images as they were recorded, in which the
// packed store keeps them. Internal to this folder.
#pragma once

#include "lf/camera/pinhole.h"
#include "lf/densify/depth_plane.h"
#include "lf/storage/packed/packed_planes.h"

namespace lf {

// Returns the plane with more columns and rows, which repeat the last ones.
DepthPlane PaddedTo(const DepthPlane& plane, PlaneSize size);
// Returns the first columns and rows.
DepthPlane CutTo(const DepthPlane& plane, int width, int height);

// Returns the plane of an LF image as it was recorded, with its lens distortion. Blocks of divisor
// x divisor pixels take the depth at the ideal position of their middle; 0 if there is none.
//   plane        of the working image
//   k            intrinsics of the LF camera
//   interrupted  once it is set, the result must not be used
DepthPlane AsRecorded(const DepthPlane& plane, const Intrinsics& k, int divisor,
                      InterruptFlag interrupted = nullptr);

}  // namespace lf

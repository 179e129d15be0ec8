// SPDX-License-Identifier: Apache-2.0
// Everything that is decided before a light field is densified: what is compared at which depths,
// and where virtual LF cameras stand.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/camera_plane.h"
#include "lf/densify/inverse_depths.h"
#include "lf/densify/virtual_cameras.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

struct DensifyChoices {
  // Range of depths of the scene along the axes of LF cameras, in world units; none: it is searched
  // in the LF images (FindInverseDepths()).
  std::optional<DepthRange> depths;
  // Largest distance between neighbouring copies of a point that is out of focus: in elements of
  // the frames if there are any, otherwise in pixels of the virtual LF images, for a focus at one
  // end of the scene and a point at the other.
  double spacing_px = 1.5;
  size_t most_virtual = 2000;  // if more virtual LF images are needed, they stand less densely
  int divisor = 1;             // a pixel of a virtual LF image is divisor x divisor LF pixels
  // Frames that will be rendered; only virtual LF images that contribute to one of them are made.
  // Empty: virtual LF images are made wherever LF cameras are around.
  std::vector<RenderCamera> frames;
  bool force = false;  // true: no light field is refused
};

struct DensifyPlan {
  CameraPlane plane;
  std::vector<std::vector<uint32_t>> compare_with;  // CompareWith() of the LF cameras
  InverseDepths range;
  int divisor = 1;                // DensifyChoices::divisor
  int planes = 0;                 // number of inverse depths that are compared
  double tolerance = 0;           // inverse depths that differ by less count as equal
  double shift_per_depth_px = 0;  // median ShiftPerInverseDepth() of compared working images
  double distance_w = 0;          // distance between neighbouring virtual LF cameras
  double spacing_px = 0;  // what the distance brings about: DensifyChoices::spacing_px, or more
  // Says that the LF cameras are dense enough, and then there are no virtual ones; otherwise empty.
  std::string dense;
  std::vector<VirtualCamera> virtual_cameras;
  std::vector<uint32_t> swept;    // LF images whose depths are searched, ascending
  std::vector<uint32_t> sources;  // those that virtual LF images are made of, ascending

  // Shift, in pixels of working images, of the nearest points of the scene against the farthest
  // between LF images that are compared.
  double ShiftPx() const { return (range.greatest - range.least) * shift_per_depth_px; }
};

// Returns the number of inverse depths to compare if points of the scene shift by this much between
// LF images.
int PlanesFor(double shift_px);
// Returns the difference below which inverse depths count as equal: a little more than half a pixel
// of shift, or one compared depth.
double ToleranceFor(const InverseDepths& range, int planes, double shift_per_depth_px);

// Finds the range of inverse depths.
//   compare_with  as DensifyPlan::compare_with
using RangeSearch =
    std::function<Result<InverseDepths>(std::span<const std::vector<uint32_t>> compare_with)>;

// Makes the plan, or says why the light field cannot be densified.
//   store   of the light field, with Mosaics::kToRgb
//   search  in place of FindInverseDepths(), if it is given
// kInput: fewer than three LF cameras, or all on one line; LF images too far from one another (the
// message has the shift or the angle); or an error of FindInverseDepths(). kUsage: no virtual LF
// image contributes to the frames, or most_virtual is too small.
Result<DensifyPlan> PlanDensify(const LightField& light_field, const LfImageStore& store,
                                const DensifyChoices& choices, ThreadPool& pool,
                                const RangeSearch& search = {});

}  // namespace lf

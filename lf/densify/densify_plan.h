// SPDX-License-Identifier: Apache-2.0
// Everything that is decided before a light field is densified: what is compared at which depths,
// and where virtual LF cameras stand.
#pragma once

#include <cmath>
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
#include "lf/densify/inverse_depths.h"
#include "lf/densify/virtual_cameras.h"
#include "lf/densify/watched_loop.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

struct DensifyChoices {
  // Range of depths of the scene along the axes of LF cameras, in world units; none: it is searched
  // in the LF images (FindInverseDepths()).
  std::optional<DepthRange> depths;
  // Largest distance between neighbouring copies of a point that is out of focus: in elements of
  // the frames, for most points that these show (film_blur.h), or for the ends of `depths`; without
  // frames, in pixels of the virtual LF images, for a focus at one end of the scene and a point at
  // the other.
  double spacing_px = 1.5;
  size_t most_virtual = 2000;  // if more virtual LF images are needed, they stand less densely
  int divisor = 1;             // a pixel of a virtual LF image is divisor x divisor LF pixels
  // Frames that will be rendered: virtual LF cameras are put into their lenses (lens_places.h).
  // Empty: they are put wherever LF cameras are around.
  std::vector<RenderCamera> frames;
  bool force = false;  // true: no light field is refused
};

struct DensifyPlan {
  std::optional<Vec3> subject;  // AxesMeetingPoint() of the light field
  // LF cameras with which others are compared, and of which virtual ones are made, ascending:
  // FarEnoughApart() for a film, or all.
  std::vector<uint32_t> used;
  std::vector<std::vector<uint32_t>> compare_with;  // CompareWith() of the LF cameras
  // LF cameras among `used` of which virtual ones may be made, ascending: FilmLenses::Serving(), or
  // all if there are no frames. Their poses are checked.
  std::vector<uint32_t> serving;
  InverseDepths range;
  bool is_film = false;           // true: there are frames
  int divisor = 1;                // DensifyChoices::divisor
  int planes = 0;                 // number of inverse depths that are compared
  double tolerance = 0;           // inverse depths that differ by less count as equal
  double shift_per_depth_px = 0;  // median ShiftPerInverseDepth() of compared working images
  double distance_w = 0;          // distance between neighbouring virtual LF cameras
  double spacing_px = 0;          // spacing at this distance: DensifyChoices::spacing_px, or more
  // Says that the LF cameras are dense enough, and then there are no virtual ones; otherwise empty.
  std::string dense;
  std::vector<VirtualCamera> virtual_cameras;
  // Least radius up to which a lens of the film is filled with virtual LF cameras; infinity if all
  // lenses are filled, or if there are no frames.
  double filled_radius_w = INFINITY;
  // LF images in the lenses of the film, ascending: their depths tell the guard what is in focus.
  std::vector<uint32_t> shown;
  std::vector<uint32_t> sources;  // LF images that virtual ones are made of, ascending
  std::vector<uint32_t> stored;   // LF images whose depths the store has, ascending: both of these
  std::vector<uint32_t> swept;    // LF images whose depths are searched, ascending

  // Shift, in pixels of working images, of the nearest points of the scene against the farthest
  // between LF images that are compared.
  double ShiftPx() const { return (range.greatest - range.least) * shift_per_depth_px; }
};

// kInput, kUsage: the light field has brackets, or virtual LF images already.
Result<void> CheckKind(const LightField& light_field);

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
//   watch   of the search for points that the frames show
// kInput: LF images too far from one another (the message has the shift or the angle); without
// frames, fewer than three LF cameras, or all on one line, or all around the scene; or an error of
// FindInverseDepths(). kUsage: no virtual LF image contributes to the frames, or most_virtual is
// too small.
Result<DensifyPlan> PlanDensify(const LightField& light_field, const LfImageStore& store,
                                const DensifyChoices& choices, ThreadPool& pool,
                                const RangeSearch& search = {}, const Watch& watch = {});

// Returns true if virtual LF cameras stand beyond the hull of the recorded ones.
bool IsWidened(const DensifyPlan& plan);
// Leaves out the virtual LF cameras beyond the hull of the recorded ones, so that the lenses of the
// frames are filled less far.
void DropBeyond(std::span<const RenderCamera> frames, DensifyPlan* plan);

}  // namespace lf

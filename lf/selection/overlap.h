// SPDX-License-Identifier: Apache-2.0
// Finds the pixels of an LF image that can contribute to a frame (thesis 4.2.1, "Extraction of
// Relevant Area in Image Space", Fig. 4.5).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/camera/magnification.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/selection/ideal_cells.h"

namespace lf {

// The pixels from which the value of a ray is computed.
enum class PixelReach {
  kOwn,         // one pixel: rays pass through pixel centres only
  kNeighbours,  // 4 or 16 pixels around the ray, which may pass through any point
  kElement,     // the pixels that a prefilter reads (collection/prefilter/prefilter.h): in a square
                // around the ray that is about six pixels wider than an element
  kCorrectedElement,  // as kElement, and two more pixels on each side, which the correction of a
                      // mosaic reads (Prefilter::correction)
};

// Returns true if the number of pixels depends on the size of elements.
constexpr bool DependsOnElement(PixelReach reach) { return reach >= PixelReach::kElement; }

// Returns the smallest pixel rectangle that contains the overlap, as the LF camera sees it, of the
// lens (for a disk, its circumscribed 16-gon) with the region of the focus plane that the plate
// sees, and the pixels that rays of the overlap need (`reach`). Empty if nothing of the image is in
// the overlap; then no ray is accepted.
//
// With a focal surface, the region consists of blocks (FocalSurface::blocks()), each bounded by the
// LF image of its corners at the smallest and the largest depth of its pieces.
//
// The rectangle contains the pixel of every accepted ray (doc/ray.md) for any position of the LF
// camera: in front of, behind or in the lens plane, in the focus plane, or looking away from the
// lens; also if the plate sees beyond the horizon of a tilted focus plane. The thesis projects the
// lens and the region into the LF image as rectangles and intersects them. This function clips the
// LF image by the half-planes that bound them (camera/ray_forms.h). The result is the same region,
// but no point is projected. Projection would fail for points in the plane through the LF camera's
// centre and normal to its axis.
//
// An LF image with lens distortion cannot be clipped like this. For such an image, the rectangle
// bounds all cells (ideal_cells.h) that no half-plane excludes.
//   cells  MakeIdealCells() of the LF camera's intrinsics; may be empty if the LF camera has no
//          lens distortion
PixelRect ContributingRect(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                           std::span<const IdealCell> cells = {},
                           PixelReach reach = PixelReach::kOwn);

// Properties of a frame that are computed once and used for all LF images.
struct FrameOutline {
  //   reach  PixelReach of the ImageOverlap that uses the outline
  FrameOutline(const RenderCamera& render_camera, PixelReach reach);

  RenderCamera camera;
  std::vector<ApertureEdge> lens_edges;  // edges of a polygon that contains the lens
  double lens_inner_w = 0;  // radius of the largest circle about the lens centre within the lens
  // Set only if DependsOnElement() is true.
  std::optional<MagnificationPoints> magnification;
};

// Computes ContributingRect() of one LF image for many frames. Values that depend only on the LF
// image are computed once. A frame for which PlainlyMisses() is true costs about 30 ns instead of a
// microsecond or more. This speed matters because a dense light field and a long path have millions
// of pairs of LF image and frame, almost all of which plainly miss.
class ImageOverlap {
 public:
  //   cells  must outlive this object
  ImageOverlap(const PinholeCamera& lf_camera, std::span<const IdealCell> cells, PixelReach reach);

  // A quick test. If it returns true, Rect() is empty: no ray of the LF image points forward
  // (doc/ray.md, 2), or a line in the lens plane separates the points where all rays meet this
  // plane from the lens. It tries only one such line, so that Rect() may also be empty if it
  // returns false.
  bool PlainlyMisses(const RenderCamera& render_camera) const;

  PixelRect Rect(const RenderCamera& render_camera) const {
    return PlainlyMisses(render_camera) ? PixelRect() : Rect(FrameOutline(render_camera, reach_));
  }
  // The outline must have been made for the reach of this object.
  PixelRect Rect(const FrameOutline& frame) const;

 private:
  PinholeCamera lf_camera_;
  std::span<const IdealCell> cells_;
  PixelReach reach_;
  Vec3 centre_world_;
  Mat3 direction_world_;  // maps an ideal pixel position to the direction of its ray
  // If has_bounds_, the world directions of all rays are middle_world_ + a_0 axes_world_.col(0) +
  // a_1 axes_world_.col(1) + a_2 axes_world_.col(2) with |a_i| <= 1.
  Vec3 middle_world_;
  Mat3 axes_world_;
  bool has_bounds_;
};

}  // namespace lf

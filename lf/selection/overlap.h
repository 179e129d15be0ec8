// The pixels of an LF image that can contribute to a frame (thesis 4.2.1, "Extraction of Relevant
// Area in Image Space", Fig. 4.5).
#pragma once

#include <span>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/selection/ideal_cells.h"

namespace lf {

// The pixels that a ray takes its value from.
enum class PixelReach {
  kOwn,         // the pixel whose centre it goes through
  kNeighbours,  // the four or sixteen pixels around it: rays go through any point of the image
};

// Returns the smallest pixel rectangle that holds the overlap of the lens (for a disk, its
// circumscribed 16-gon) and the plate's region on the focus plane, both as the LF camera sees them.
// Empty if no ray of the image can be accepted.
//
// The rectangle holds every accepted ray (doc/ray.md) for any position of the LF camera: before,
// behind or in the lens plane, in the focus plane, with the lens behind its back, and with the
// plate beyond the horizon of a tilted focus plane. The thesis projects rectangles and intersects
// them. This function clips the image by the half-planes that bound them (camera/ray_forms.h),
// which gives the same region without projecting points that lie in the plane of the LF camera.
//
// With lens distortion, the image is not a plane of rays that could be clipped: the rectangle
// bounds the cells that no half-plane excludes.
//   cells  MakeIdealCells() of the LF camera's intrinsics; not used without distortion
PixelRect ContributingRect(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                           std::span<const IdealCell> cells = {},
                           PixelReach reach = PixelReach::kOwn);

// The properties of a frame that are computed once for all LF images.
struct FrameOutline {
  explicit FrameOutline(const RenderCamera& render_camera);

  RenderCamera camera;
  std::vector<ApertureEdge> lens_edges;  // of a polygon that contains the lens
  double lens_inner_w = 0;               // radius of a circle within that polygon
};

// Computes ContributingRect() of one LF image for many frames. Values that depend only on the LF
// image are computed once, and a frame that the image plainly misses takes about 30 ns instead of a
// microsecond or more. A dense light field and a long path have millions of pairs of image and
// frame, almost all of which are such misses.
class ImageOverlap {
 public:
  //   cells  must outlive this object
  ImageOverlap(const PinholeCamera& lf_camera, std::span<const IdealCell> cells, PixelReach reach);

  // True if no ray of the image runs forward, or if a line beside the lens separates all rays from
  // the lens. Rect() is then empty. Rect() may also be empty if this is false.
  bool PlainlyMisses(const RenderCamera& render_camera) const;

  PixelRect Rect(const RenderCamera& render_camera) const {
    return PlainlyMisses(render_camera) ? PixelRect() : Rect(FrameOutline(render_camera));
  }
  PixelRect Rect(const FrameOutline& frame) const;

 private:
  PinholeCamera lf_camera_;
  std::span<const IdealCell> cells_;
  PixelReach reach_;
  // If has_bounds_, the world directions of all rays are middle_world_ + a_0 axes_world_.col(0) +
  // a_1 axes_world_.col(1) + ... with |a_i| <= 1.
  Vec3 centre_world_;
  Mat3 direction_world_;  // maps an ideal pixel position to the direction of its ray
  Vec3 middle_world_;
  Mat3 axes_world_;
  bool has_bounds_;
};

}  // namespace lf

// Which pixels of an LF image can contribute to a frame (thesis 4.2.1, "Extraction of Relevant Area
// in Image Space", Fig. 4.5).
#pragma once

#include <span>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/selection/ideal_cells.h"

namespace lf {

// The smallest pixel rectangle holding the overlap of the lens (for a disk its circumscribed
// 16-gon) and the plate's region on the focus plane, both as the LF camera sees them. Empty if no
// ray of the image can be accepted.
//
// Holds every accepted ray (doc/ray.md), wherever the LF camera is: before, behind or in the lens
// plane, in the focus plane, with the lens behind its back, with the plate beyond the horizon of a
// tilted focus plane. Where the thesis projects rectangles and intersects them, this clips the
// image by the half-planes that bound them (camera/ray_forms.h): the same region, without
// projecting points that lie in the plane of the LF camera.
//
// With lens distortion the image is no plane of rays that could be clipped: the rectangle bounds
// those of its `cells` that no half-plane excludes.
//   cells  MakeIdealCells of the LF camera's intrinsics where these have distortion; else not used
//   reach  which pixels a ray takes its value from
enum class PixelReach {
  kOwn,         // the one it goes through the centre of
  kNeighbours,  // those around it, four or sixteen: rays go through any point of the image
};
PixelRect ContributingRect(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                           std::span<const IdealCell> cells = {},
                           PixelReach reach = PixelReach::kOwn);

// A frame as its LF images ask it: what is the same for all of them.
struct FrameOutline {
  explicit FrameOutline(const RenderCamera& render_camera);

  RenderCamera camera;
  std::vector<ApertureEdge> lens_edges;  // of a polygon that holds the lens
  double lens_inner_w = 0;               // radius of a circle within it
};

// The same for many frames: what only the LF image decides is found once, and frames that it
// plainly misses cost some 30 ns instead of a microsecond and more. A dense light field and a long
// path have millions of pairs, of which nearly all are such.
class ImageOverlap {
 public:
  // cells  must outlive this
  ImageOverlap(const PinholeCamera& lf_camera, std::span<const IdealCell> cells, PixelReach reach);

  // Whether no ray of the image runs forward, or one line beside the lens leaves all of them on
  // its other side. Then Rect() is empty; it may be so without.
  bool PlainlyMisses(const RenderCamera& render_camera) const;

  PixelRect Rect(const RenderCamera& render_camera) const {
    return PlainlyMisses(render_camera) ? PixelRect() : Rect(FrameOutline(render_camera));
  }
  PixelRect Rect(const FrameOutline& frame) const;

 private:
  PinholeCamera lf_camera_;
  std::span<const IdealCell> cells_;
  PixelReach reach_;
  // Directions of the rays are among middle + a_0 axes.col(0) + a_1 ... with |a_i| <= 1, in the
  // world, if has_bounds_.
  Vec3 centre_world_;
  Mat3 direction_world_;  // of a ray, from its pixel
  Vec3 middle_world_;
  Mat3 axes_world_;
  bool has_bounds_;
};

}  // namespace lf

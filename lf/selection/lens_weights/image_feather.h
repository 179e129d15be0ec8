// SPDX-License-Identifier: Apache-2.0
// The feather of an LF image: the weight of its rays decreases towards its borders (doc/ray.md,
// "What is added"), so that a frame shows no seam where an LF image ends that is brighter than its
// neighbours.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// Width of the feathered border, as a share of the shorter side of the LF image.
inline constexpr double kFeatherShare = 1.0 / 32;

// Returns the feather, in [0, 1], of a ray that the LF image records at position (x, y). In each
// direction, a factor is 0 at the centres of the outermost pixels and beyond, 1 from a distance of
// kFeatherShare times the shorter side inwards, and smooth in between. The feather is the product
// of the factors of both directions.
double FeatherAt(const Intrinsics& lf_image, double x_px, double y_px);

// Computes the feather of one LF image for any position on the plate of one frame.
class ImageFeather {
 public:
  ImageFeather(const PinholeCamera& lf_camera, const RenderCamera& frame);

  // Writes the feather, in units of 1/kWholeFeather, at the positions (x + kWeightBlock i, y +
  // kWeightBlock j) of the plate to feather[j * columns + i], i in [0, columns), j in [0, rows); 0
  // if the LF camera records no ray through the focus point of the position. Several threads may
  // call this at the same time. Takes about 15 ns for each feathered position, 20 ns for each row,
  // and 50 ns for each call; with lens distortion or a focal surface, 50 ns for each position.
  void OfCorners(int x, int y, int columns, int rows, uint16_t* feather) const;

  // Returns true only if OfCorners() gives kWholeFeather at all positions of the plate in `rect`,
  // borders included. May return false although it gives this, always with lens distortion. Takes
  // about 50 ns, or half a microsecond with a focal surface.
  bool IsWhole(const PixelRect& rect) const;

 private:
  void ComputeRow(int x, int y, int count, uint16_t* feather) const;
  double At(const Vec3& direction) const;
  // True if the position (x, y), given as at = (x z, y z, z), is so far from the borders of the LF
  // image that the feather is whole.
  bool IsInside(const Vec3& at) const {
    return at.z() > 0 && at.x() >= border_px_ * at.z() &&
           at.x() <= (intrinsics_.width_px - border_px_) * at.z() &&
           at.y() >= border_px_ * at.z() && at.y() <= (intrinsics_.height_px - border_px_) * at.z();
  }

  Intrinsics intrinsics_;
  double border_px_;  // width of the feathered border, and a little more
  // Linear maps of the position e = (x, y, 1) on the plate, for one focus plane. X is the focus
  // point of the position, c the centre of the LF camera.
  struct Maps {
    Mat3 to_focus;      // times e: X - c in axes of the LF camera, times a positive factor
    Mat3 to_pixel;      // times e: homogeneous position of X in the LF image, without distortion
    Vec3 before_lens;   // times e: > 0 if X is in front of the lens
    Vec3 runs_forward;  // times e: >= 0 if X - c points forward; otherwise c - X does
  };
  // Linear forms of e, for one focus plane; X and c are those of Maps. Form 0 is positive if X is
  // in front of the lens, form 1 if X is in front of the LF camera. Forms [2, 6) are positive if X
  // is more than 0.5 px inside the four borders of the LF image, forms [6, 10) if it is more than
  // border_px_ inside. All but form 0 have the opposite sign where runs_forward e is negative.
  struct Forms {
    static constexpr int kSeen = 2, kWhole = 6, kCount = 10;
    std::array<double, kCount> x, y, constant;
  };
  class RectForms;
  // Part of a row: the feather is 0 before position seen_begin and from seen_end on, and whole from
  // whole_begin to whole_end, exclusive. All other positions have to be computed.
  struct RowParts {
    int seen_begin, seen_end, whole_begin, whole_end;
  };
  Forms FormsOf(const Maps& maps) const;
  static Maps MapsOf(const PinholeCamera& lf_camera, const RenderCamera& frame);
  bool IsWhole(const PixelRect& rect, const Maps& maps) const;

  PinholeCamera lf_camera_;
  RenderCamera frame_;
  Maps maps_;    // of the whole plate, unless the frame has a focal surface
  Forms forms_;  // of maps_
  mutable std::once_flag map_is_made_;
  // Made by the first call of OfCorners() if the LF camera has lens distortion, because making it
  // is slow.
  mutable std::optional<DistortionMap> map_;
};

}  // namespace lf

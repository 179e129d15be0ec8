// SPDX-License-Identifier: Apache-2.0
// The part of a frame's lens that no collected ray passes near, and the weights with which the LF
// cameras around it complete the frame from kept pixels (thesis 4.3.3). Needs only the calibration
// of the LF cameras, so that it is known before an LF image is read.
//
// The opening is represented by places spread over it. A place is *covered* for an element if
// collected LF images stand for it:
// - it lies within the region that the LF cameras that see the element cover (CoveredRegion), and
// - a collected LF image has a ray that lands in the element and passes the lens plane near the
//   place: within kCoveredDistances times the distance between LF cameras, or within the distance
//   between places, whichever is larger.
// If the frame has hat weights, its rays stand for all of the lens, in so far as they are hats. The
// places that are not covered make the gap, unless no LF camera within kFarthestDistances of them
// sees the element. Gaps occur if an aperture is larger than the captured band, and if a small
// aperture lies between LF cameras. Places of a gap that lie between LF cameras are interpolated by
// natural neighbours; places beyond the capture take the light of the LF cameras at its edge.
//
// All edges are soft, so that nothing jumps while a lens grows or moves.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/core/parallel.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/selection/image_index.h"
#include "lf/selection/lens_weights/frame_weights.h"
#include "lf/selection/select.h"

namespace lf {

class GapLens {
 public:
  // Distance up to which a ray covers a place, and up to which LF cameras may complete the lens;
  // the unit is the distance between LF cameras around the lens.
  static constexpr double kCoveredDistances = 1.5;
  static constexpr double kFarthestDistances = 8;
  static constexpr int kPlaces = 64;  // number of places of the opening
  // An element has no gap if at most the share kNothingMissing of its places is not covered. From
  // there to kLittleMissing, the gap grows from nothing to the whole part that is not covered.
  static constexpr double kNothingMissing = 0.02;
  static constexpr double kLittleMissing = 0.1;
  // Least width of the edge between places that are covered and others, in camera distances.
  static constexpr double kLeastEdge_distances = 0.25;
  // Sigma of the Gaussian by which places beyond the capture are divided among the LF cameras, in
  // distances between most neighbours (DistanceOfMost()). Half as much is as good. Sigmas that grow
  // with the distance from the capture, as those of cells do, lose up to 0.9 dB.
  static constexpr double kSpread_distances = 0.5;

  // The object refers to the light field of `index`.
  //   collected          the lens with which the frame collects rays
  //   ranks              range of the ranks of the LF images that the frame takes. Gaps are those
  //                      of the frame with all of these, even if it is stopped or finished early,
  //                      because pixels for other gaps are not kept
  //   camera_distance_w  CameraDistanceAround() in the whole light field. Must be set if the index
  //                      covers only a part of the light field; unset: measured in `index`
  GapLens(const ImageIndex& index, const RenderCamera& frame, const FrameLens& collected,
          const RankRange& ranks, const SelectOptions& select, ThreadPool& pool,
          std::optional<double> camera_distance_w = {});

  // True if some element has a gap.
  bool exists() const { return weights_ && weights_->HasPart(); }
  // Returns the share of the lens that the gap has in an element, 0 to 1; `exists()` must be true.
  double ShareAt(int x, int y) const { return weights_->PartAt(x, y); }

  // The frame's camera, its aperture replaced by the disk that all rays with a weight pass through.
  const RenderCamera& camera() const { return camera_; }
  // Likewise, with only the elements that the LF image may complete.
  RenderCamera CameraOf(LfImageId id) const;
  // The LF images that complete the frame, by ascending ids.
  const std::vector<LfImageId>& images() const { return images_; }
  bool Takes(LfImageId id) const;
  // Returns the weights of the LF image's rays in the gap. The result refers to this object.
  RayWeights WeightsOf(LfImageId id) const;
  // Returns the factor between ShareAt() and the sum of the weights of an element; 0 if there are
  // none.
  double WeightsPerShare() const { return weights_ ? weights_->WeightsPerShare() : 0; }
  void ReduceWeights(double factor) {
    if (weights_) weights_->Reduce(factor);
  }

 private:
  std::optional<size_t> IndexOf(LfImageId id) const;

  const LightField& light_field_;
  RenderCamera camera_;
  std::vector<LfImageId> near_;  // sorted; the LF cameras of weights_
  std::optional<FrameWeights> weights_;
  std::vector<LfImageId> images_;
};

}  // namespace lf

// The lens of one frame for collection: which rays it lets through, and what they count.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/selection/lens_weights/frame_weights.h"
#include "lf/selection/lens_weights/lens_coverage.h"
#include "lf/selection/select.h"

namespace lf {

// kUsage if the lens of the frame is a pinhole, which kArea cannot weigh.
Result<void> CheckHasArea(const RenderCamera& camera, FrameId frame);

// With lens weights, LF cameras beside the lens also take part, and weights replace the lens test
// (doc/ray.md, "What is added").
class FrameLens {
 public:
  // LF images with rays this near the lens are asked for their share of it. The unit is the
  // distance of neighbouring LF cameras.
  static constexpr double kReach_distances = 8;

  // kArea needs a lens that CheckHasArea() accepts. The object refers to the light field.
  //   camera_distance_w  CameraDistanceAround() in the whole light field, if the index is of a
  //                      part: a part that has all of near() then gives the same weights
  FrameLens(const ImageIndex& index, const RenderCamera& frame, LensWeights kind,
            const SelectOptions& select, ThreadPool& pool,
            std::optional<double> camera_distance_w = {});

  // The frame's camera. With weights, its lens is the disk that holds all rays with a weight.
  const RenderCamera& camera() const { return camera_; }

  // Returns weights that refer to this object. They are 0 beyond the angle that selection allows.
  RayWeights WeightsOf(LfImageId id) const;

  // Returns false if WeightsOf() is 0 all over the plate.
  bool Takes(LfImageId id) const;

  // LF images that were asked for their share, ascending, and how far apart their cameras are
  // around the lens. Empty and 0 without weights.
  std::vector<LfImageId> near() const;
  double camera_distance_w() const { return camera_distance_w_; }

  // Properties of the weights; none without weights.
  struct Facts {
    double hat_share = 0;  // FrameWeights::hat_share()
    LensCoverage coverage;
  };
  std::optional<Facts> facts() const;

  // Returns effective numbers of LF images, (sum w)^2 / sum w^2: so many images of equal weight
  // would make as little noise. The sums are over the images that hold what an element sees; 0 if
  // none does. Computed for the elements in the middle of squares of EffectiveStep() elements.
  // Broken images and masks are not known here.
  // [rows][columns]  Empty without weights.
  Image<float> EffectiveCounts() const;

 private:
  const LightField& light_field_;
  SelectOptions select_;
  RenderCamera camera_;
  double camera_distance_w_ = 0;
  std::optional<FrameWeights> weights_;
  std::map<uint32_t, size_t> cameras_;  // index in weights_, by LF image
};

int EffectiveStep(const Intrinsics& plate);
// Number of columns and rows of squares.
std::pair<int, int> EffectiveSquares(const Intrinsics& plate);
// Interpolates effective numbers to every element, between those that are not 0.  [height][width]
Image<float> SpreadOverPlate(const Image<float>& effective_counts, const Intrinsics& plate);

}  // namespace lf

#include "lf/collector/frame_lens.h"

#include <vector>

namespace lf {

FrameLens::FrameLens(const LightField& light_field, const RenderCamera& frame, LensWeights kind,
                     const SelectOptions& select, ThreadPool& pool)
    : camera_(frame) {
  if (kind == LensWeights::kNone) return;
  std::vector<Vec3> centres;
  centres.reserve(light_field.size());
  for (const LfCamera& camera : light_field.cameras)
    centres.push_back(camera.cam_from_world.Inverse().translation);
  RenderCamera grown = frame;
  grown.aperture = {frame.aperture.radius_w + kReach_distances * CameraDistance(frame, centres), 0,
                    0};
  for (const SelectedImage& image : SelectImages(light_field, std::span(&grown, 1), select, pool))
    cameras_[image.id.value] = 0;
  // In the order of their numbers: the order in which images are taken has no say in weights.
  std::vector<Vec3> near;
  for (auto& [id, camera] : cameras_) {
    camera = near.size();
    near.push_back(centres[id]);
  }
  weights_.emplace(frame, near, kind);
  // A little more, so that what lies on the rim is inside.
  camera_.aperture = {weights_->reach_w() * (1 + 1e-6), 0, 0};
}

RayWeights FrameLens::WeightsOf(LfImageId id) const {
  if (!weights_) return 1;
  const auto found = cameras_.find(id.value);
  if (found == cameras_.end() || !weights_->TakesPart(found->second)) return 0;
  const size_t camera = found->second;
  if (weights_->is_constant()) return weights_->At(camera, 0, 0);
  return RayWeights(weights_->BlocksOf(camera), [this, camera](int end_x, int end_y) {
    return weights_->At(camera, end_x - 1, end_y - 1);
  });
}

std::optional<double> FrameLens::effective_count() const {
  if (!weights_) return std::nullopt;
  return weights_->EffectiveCount();
}

}  // namespace lf

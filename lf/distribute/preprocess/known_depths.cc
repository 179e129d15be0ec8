// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/known_depths.h"

#include "lf/focus/swept_depths.h"
#include "lf/storage/load/open_store.h"

namespace lf {

DepthSource KnowDepths(const LightField& light_field, const CameraPath& path, ThreadPool& pool,
                       PreprocessOptions* options) {
  if (options->depths) return DepthSource::kStated;
  if (light_field.depth_range) return DepthSource::kCalibration;
  const auto store = OpenStore(light_field, Mosaics::kToRgb);
  if (!store || path.frame_count() == 0) return DepthSource::kUnknown;
  const FrameId first = options->frames.empty() ? path.frames().At(0) : options->frames.front();
  options->depths =
      SweptDepths(light_field, **store, path.Camera(first).pinhole.CentreWorld(), pool);
  return options->depths ? DepthSource::kLfImages : DepthSource::kUnknown;
}

}  // namespace lf

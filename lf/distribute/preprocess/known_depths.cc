// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/known_depths.h"

#include "lf/focus/swept_depths.h"
#include "lf/storage/load/open_store.h"

namespace lf {

std::string KnowDepths(const LightField& light_field, const CameraPath& path, ThreadPool& pool,
                       PreprocessOptions* options) {
  if (options->depths) return "--depths";
  if (light_field.depth_range) return "the calibration";
  const FrameId first = options->frames.empty() ? FrameId{1} : options->frames.front();
  const auto store = OpenStore(light_field, Mosaics::kToRgb);
  if (!store || path.frame_count() == 0) return "";
  options->depths =
      SweptDepths(light_field, **store, path.Camera(first).pinhole.CentreWorld(), pool);
  return options->depths ? "LF images" : "";
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// The pixels and the prefilters of an LF image that frames need.
#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "lf/collection/gather_sampling.h"
#include "lf/render/collect/collect_batch.h"

namespace lf {

// Returns how many of the frames, from the first one on, are planned together: all; or, if LF
// images are filtered, those that read the same filtered LF images, so that memory holds only one
// filtered copy of each LF image. The instants of a frame may read different ones; the frame is
// then planned alone.
size_t BatchCollector::CountTogether(const std::vector<BatchImage>& batch,
                                     std::span<const BatchFrame> frames) const {
  if (!reading_.Prefilters()) return frames.size();
  for (const BatchImage& image : batch) {
    std::optional<Prefilter> filter;
    const auto differs = [&](const BatchFrame& frame) {
      if (PlainlyMisses(image, frame.frame)) return false;
      for (size_t e = 0; e < instant_count(); ++e) {
        const Exposure exposure = ExposureOf(frame.frame, e);
        const Prefilter needed =
            SamplingOf(light_field_.Camera(image.id), exposure.camera, exposure.reading).prefilter;
        if (!filter) filter = needed;
        if (needed != *filter) return true;
      }
      return false;
    };
    const auto other = std::find_if(frames.begin(), frames.end(), differs);
    frames = frames.first(std::max<size_t>(1, static_cast<size_t>(other - frames.begin())));
  }
  return frames.size();
}

PixelRect BatchCollector::RectOf(LfImageId id, std::span<const size_t> frames) const {
  const PinholeCamera camera = light_field_.Camera(id);
  std::vector<const RenderCamera*> taking;
  for (const size_t frame : frames)
    for (size_t e = 0; e < exposure_count(); ++e)
      if (const Exposure exposure = ExposureOf(frame, e); !WeightsOf(exposure, id).are_none())
        taking.push_back(&exposure.camera);
  if (taking.empty()) return {};
  if (whole_images_) return {0, 0, camera.intrinsics.width_px, camera.intrinsics.height_px};
  std::vector<IdealCell> cells;
  if (camera.intrinsics.has_distortion()) cells = MakeIdealCells(camera.intrinsics);
  const ImageOverlap overlap(camera, cells, ReachOf(reading_));
  PixelRect rect;
  for (const RenderCamera* const frame : taking) rect = Bounds(rect, overlap.Rect(*frame));
  return rect;
}

std::optional<Prefilter> BatchCollector::OnlyPrefilterOf(LfImageId id,
                                                         std::span<const size_t> frames) const {
  if (!reading_.Prefilters() || back_end_ == CollectBackEnd::kReference || is_guarded())
    return std::nullopt;
  const PinholeCamera camera = light_field_.Camera(id);
  std::vector<IdealCell> cells;
  if (camera.intrinsics.has_distortion()) cells = MakeIdealCells(camera.intrinsics);
  const ImageOverlap overlap(camera, cells, ReachOf(reading_));
  std::optional<Prefilter> only;
  for (const size_t frame : frames)
    for (size_t e = 0; e < exposure_count(); ++e) {
      const Exposure exposure = ExposureOf(frame, e);
      if (!whole_images_ && overlap.PlainlyMisses(exposure.camera)) continue;
      if (WeightsOf(exposure, id).are_none()) continue;
      const Prefilter needed = SamplingOf(camera, exposure.camera, exposure.reading).prefilter;
      if (needed.changes_nothing() || (only && needed != *only)) return std::nullopt;
      only = needed;
    }
  return only;
}

}  // namespace lf

// What one frame needs of a light field (thesis 4.2.1).
#pragma once

#include <optional>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/collector/collect_batch.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/lens_weights/frame_weights.h"
#include "lf/selection/image_index.h"
#include "lf/selection/select.h"

namespace lf {

struct FrameNeeds {
  struct Image {
    LfImageId id;
    PixelRect rect;
  };
  std::vector<Image> images;  // whose rays count, by ascending places
  // LF cameras that these are measured against: lens weights, and limits in numbers of LF images,
  // are the same without any other. Ascending; images are not among them.
  std::vector<LfImageId> neighbours;
  // About how far apart LF cameras around the lens are; with lens weights.
  std::optional<double> camera_distance_w;

  uint64_t RayCount() const;
};

struct NeedsOptions {
  SelectOptions select;
  LensWeights lens_weights = LensWeights::kAuto;
  std::optional<size_t> max_image_count;
};

FrameNeeds NeedsOf(const ImageIndex& index, const RenderCamera& frame, const NeedsOptions& options,
                   ThreadPool& pool);

}  // namespace lf

// What one frame needs of a light field (thesis 4.2.1).
//
// There is one answer for all who ask: packages carry these LF cameras, packed stores are cut to
// these pixels, orders and limits count these LF images, forecasts count these rays, and a render
// reads these pixels and no others (tests/needed_pixels_test.py).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/hybrid/frame_sampling.h"
#include "lf/hybrid/rebinned_rays.h"
#include "lf/hybrid/render_mode.h"
#include "lf/lens_weights/frame_weights.h"
#include "lf/package/package.h"
#include "lf/selection/image_index.h"
#include "lf/selection/select.h"
#include "lf/store/lf_image_store.h"

namespace lf {

// The options of a render that decide what its frames need.
struct NeedsOptions {
  SelectOptions select;  // reach and max_angle_rad
  // kNone with RenderMode::kRebin, which collects no rays that could be weighed.
  LensWeights lens_weights = LensWeights::kAuto;
  std::optional<size_t> max_image_count;  // only with RenderMode::kCollect
  RenderMode mode = RenderMode::kCollect;
  RebinPassOptions rebin;  // query, previews and pixels around rays; not with kCollect

  // Returns whether LF cameras beside those that a frame takes have a say in its picture.
  bool HasNeighbours() const { return lens_weights != LensWeights::kNone || Rebins(mode); }
};

struct FrameNeeds {
  struct Image {
    LfImageId id;
    PixelRect rect;          // bounds of all pixels that are read
    uint64_t ray_count = 0;  // pixels that are tried as rays of the frame, or as rays to be kept
  };
  std::vector<Image> images;  // that are read, by ascending places
  // LF cameras that these are measured against, ascending; images are not among them. Lens weights,
  // limits in numbers of LF images, and rebinned rays of the default options are the same without
  // any other LF camera. Empty without HasNeighbours().
  std::vector<LfImageId> neighbours;
  // With HasNeighbours(): how densely the light field was recorded around the lens.
  std::optional<FrameSampling> sampling;

  std::optional<double> camera_distance_w() const;
  uint64_t RayCount() const;
};

// Both convert to and from the form that a package stores.
FrameSurroundings SurroundingsOf(const FrameSampling& sampling);
FrameSampling SamplingOf(const FrameSurroundings& surroundings);

//   sampling  in the whole light field, where the index is of a part
FrameNeeds NeedsOf(const ImageIndex& index, const RenderCamera& frame, const NeedsOptions& options,
                   ThreadPool& pool, const std::optional<FrameSampling>& sampling = {});

// kInput if the frame reads pixels that were cut off when the packed store was made
// (lfcompressor --needed-pixels). LF images that are missing or broken are no error here.
//   store  as it is read: with mosaics to RGB if the estimator is bilinear
Result<void> CheckKept(const LfImageStore& store, const LightField& light_field, FrameId frame,
                       const FrameNeeds& needs);

}  // namespace lf

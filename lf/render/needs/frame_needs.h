// Computes what one frame needs of a light field (thesis 4.2.1).
//
// All users get the same answer: packages contain these LF cameras, packed stores are cut to these
// pixels, orders and limits count these LF images, forecasts count these rays, and a render reads
// exactly these pixels (tests/needed_pixels_test.py).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/render/hybrid/frame_sampling.h"
#include "lf/render/hybrid/rebinned_rays.h"
#include "lf/render/hybrid/render_mode.h"
#include "lf/render/package/package.h"
#include "lf/selection/image_index.h"
#include "lf/selection/lens_weights/frame_weights.h"
#include "lf/selection/select.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// The options of a render that determine what its frames need.
struct NeedsOptions {
  SelectOptions select;  // reach and max_angle_rad
  // kNone with RenderMode::kRebin, which collects no rays that could be weighted.
  LensWeights lens_weights = LensWeights::kAuto;
  std::optional<size_t> max_image_count;  // only with RenderMode::kCollect
  RenderMode mode = RenderMode::kCollect;
  RebinPassOptions rebin;  // query, previews and pixels around rays; not used with kCollect

  // Returns true if LF cameras other than those a frame reads influence its picture.
  bool HasNeighbours() const { return lens_weights != LensWeights::kNone || Rebins(mode); }
};

struct FrameNeeds {
  struct Image {
    LfImageId id;
    PixelRect rect;          // bounds of all pixels that are read
    uint64_t ray_count = 0;  // number of pixels that are tested as rays of the frame, or as rays to
                             // be kept
  };
  std::vector<Image> images;  // the LF images that are read, by ascending ranks
  // Other LF cameras against which `images` are measured, by ascending ids. With these, lens
  // weights, limits in numbers of LF images, and rebinned rays of the default options are the same
  // as with all LF cameras. Empty without HasNeighbours().
  std::vector<LfImageId> neighbours;
  // Density of the LF cameras around the lens; present with HasNeighbours().
  std::optional<FrameSampling> sampling;

  std::optional<double> camera_distance_w() const;
  uint64_t RayCount() const;
};

// Convert to and from the form that a package stores.
FrameSurroundings SurroundingsOf(const FrameSampling& sampling);
FrameSampling SamplingOf(const FrameSurroundings& surroundings);

// Returns the needs of a frame.
//   sampling  measured in the whole light field, if the index covers only a part of it
FrameNeeds NeedsOf(const ImageIndex& index, const RenderCamera& frame, const NeedsOptions& options,
                   ThreadPool& pool, const std::optional<FrameSampling>& sampling = {});

// kInput if the frame reads pixels that were cut off when the packed store was made (lfcompressor
// --needed-pixels). Missing or broken LF images are no error here.
//   store  opened as it will be read: with mosaics to RGB if the estimator is bilinear
Result<void> CheckKept(const LfImageStore& store, const LightField& light_field, FrameId frame,
                       const FrameNeeds& needs);

}  // namespace lf

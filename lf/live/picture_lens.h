// SPDX-License-Identifier: Apache-2.0
// The lens of a live picture as numbers: which LF images the picture takes, and how much their rays
// count. With these numbers, a renderer elsewhere, such as that of a graphics card, makes the same
// picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/selection/image_index.h"
#include "lf/selection/lens_weights/frame_weights.h"
#include "lf/selection/select.h"

namespace lf {

struct PictureLens {
  struct Image {
    size_t index = 0;  // in the light field of LensOfPicture()
    WeightBlocks blocks;
    int samples = 1;  // GatherSampling::samples
  };
  std::vector<Image> images;  // LF images with a weight somewhere, ascending
  // Numbers of columns and rows of nodes, the points of the plate at which weights are computed.
  // The weight of a block of elements is interpolated between four nodes as by
  // FrameWeights::OfRow().
  int columns = 1;
  int rows = 1;
  std::vector<uint16_t> nodes;  // [image][row][column], weights in 1/256
  Aperture opening;             // a ray is taken only if it passes through this opening
  bool has_feather = false;     // true: weights decrease towards the borders of LF images
  // As in LivePicture.
  size_t used_count = 0;
  double uncovered_share = 1;
  double camera_distance_w = 0;
};

// Returns the number of LF images of a light field that a frame with this lens uses: those with a
// weight somewhere that see a part of what is filmed.
//   index   of the light field of the lens
//   select  as for the lens
size_t UsedCount(const FrameLens& lens, const ImageIndex& index, const SelectOptions& select,
                 ThreadPool& pool);

// Returns the lens of a picture that takes all LF images of the light field, with the weights of
// LiveRenderer::Render().
PictureLens LensOfPicture(const LightField& light_field, const RenderCamera& frame,
                          LensWeights weights, ThreadPool& pool);

}  // namespace lf

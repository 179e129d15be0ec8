// SPDX-License-Identifier: Apache-2.0
// Computes how much each LF image counts in a frame, and thus how much of an error of the LF image
// gets into the frame.
#pragma once

#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/render/package/package.h"
#include "lf/selection/image_index.h"
#include "lf/selection/lens_weights/lens_weights.h"

namespace lf {

// The share of an LF image in an element is its weight divided by the sum of the weights of all LF
// images there. Shares are means over the elements of the frame. An element that an LF image adds
// nothing to counts as 0.
struct ImageShare {
  LfImageId id;
  double share = 0;    // mean of the share
  double squared = 0;  // mean of the squared share
};

// Returns the shares of the LF images that a frame of a package collects rays of, by ascending ids.
// LF images that no element sees are left out.
//
// Shares follow from poses alone, without reading an LF image. They are computed for 12 x 12
// elements that are spread evenly over the frame. Masks, opacities, broken LF images and stop rules
// are not taken into account. Takes about as long as the lens weights of the frame in a render:
// some tens of microseconds for each LF camera around the lens.
//   index    of the package's light field, with its ranks
//   kind     kNone: rays have equal weights. Must be kNone if the package has no neighbours, and
//            must not be kArea if the lens is a pinhole
std::vector<ImageShare> SharesOf(const ImageIndex& index, const Package& package, FrameId frame,
                                 LensWeights kind, ThreadPool& pool);

}  // namespace lf

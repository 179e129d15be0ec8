// SPDX-License-Identifier: Apache-2.0
// Corners of a reduced LF image, and descriptors by which the same corners are found in other LF
// images. Internal to this folder.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/focus/reduced_image.h"

namespace lf {

// Length of a descriptor: 4 x 4 cells, each a histogram of 8 directions of the gradient.
inline constexpr int kDescriptorSize = 128;

using Descriptor = Eigen::Matrix<float, kDescriptorSize, 1>;  // of length 1

struct ImageFeatures {
  std::vector<Vec2> at_px;              // positions of the corners in the LF image
  std::vector<Descriptor> descriptors;  // of the corners
  size_t size() const { return at_px.size(); }
};

// Returns at most `most` corners (Shi and Tomasi, "Good features to track", CVPR 1994), spread over
// the image, with descriptors of 16 x 16 reduced pixels (Lowe, "Distinctive image features from
// scale-invariant keypoints", IJCV 2004, here upright and of one scale). Corners beside masked
// pixels are left out.
ImageFeatures FindFeatures(const ReducedImage& image, size_t most);

struct FeatureMatch {
  uint32_t a = 0, b = 0;  // indices into ImageFeatures::at_px
};

// Returns the pairs of corners that are most like each other, and clearly less like any other, and
// that lie on the epipolar lines of one fundamental matrix, which RANSAC finds from the matches
// alone: poses and intrinsics do not count. Empty if fewer than 16 pairs or half of them do.
//   tolerance_px  largest distance from the epipolar line
std::vector<FeatureMatch> MatchFeatures(const ImageFeatures& a, const ImageFeatures& b,
                                        double tolerance_px);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Interpolates the pixels of a picture that are not known between those that are.
//
// The picture is reduced by two, again and again, until every pixel is known: a reduced pixel is
// the mean of the known ones among its four, and is known if at least one of them is. On the way
// back, each unknown pixel takes its value from the reduced picture, interpolated bilinearly (the
// pull-push algorithm; Gortler et al. 1996), and then, a few times, the mean of its four
// neighbours. This approaches the picture whose Laplacian is 0 at unknown pixels (homogeneous
// diffusion), for which pixels are best known where the Laplacian of the image is large
// (Belhachmi et al. 2009), as Eq. 4.4 chooses them. Dark pixels that are known around a light keep
// its values from the pixels beyond them.
#pragma once

#include <vector>

#include "lf/core/image.h"

namespace lf {

// Each plane [height][width] has one value of every pixel. `weight` [height][width] is 1 for known
// pixels and 0 for the others, whose values are replaced; if no pixel is known, they become 0.
// Known values stay, and no value is below the least or above the largest known one of its plane,
// except for rounding.
void FillPixels(std::vector<Image<float>>* planes, const Image<float>& weight);

}  // namespace lf

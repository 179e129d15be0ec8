// SPDX-License-Identifier: Apache-2.0
// Interpolates the pixels of a picture that are not known between those that are.
//
// The picture is reduced by two, again and again, until every pixel is known: a reduced pixel is
// the mean of the known ones among its four, and is known if at least one of them is. On the way
// back, each unknown pixel takes its value from the reduced picture, interpolated bilinearly (the
// pull-push algorithm; Gortler et al. 1996). Between edges that are known, the result is smooth.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/core/image.h"

namespace lf {

// Values [height][width][channels]. `weight` [height][width] is 1 for known pixels and 0 for the
// others, whose values are replaced; if no pixel is known, they become 0. Known values stay.
void FillPixels(Image<float>* values, const Image<float>& weight);

}  // namespace lf

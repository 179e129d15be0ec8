// SPDX-License-Identifier: Apache-2.0
// Filters a picture of one channel by a weight for each column times a weight for each row.
// Internal to this folder.
#pragma once

#include <vector>

#include "lf/core/image.h"
#include "lf/core/parallel.h"

namespace lf {

// Returns the sum over j and i of down[j] across[i] picture(x + i - r, y + j - s), where r and s
// are the middles of the two lists. Pixels beyond the border have the value of the nearest one.
//   across, down  an odd number of weights each
Image<float> FilterSeparably(const Image<float>& picture, const std::vector<double>& across,
                             const std::vector<double>& down, ThreadPool& pool);

// Returns exp(-i^2 / (2 sigma^2)) for i from -radius to radius, divided by their sum.
std::vector<double> GaussianWeights(double sigma, int radius);

}  // namespace lf

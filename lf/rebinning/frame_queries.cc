// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/frame_queries.h"

#include <algorithm>

namespace lf {

bool FrameQueries::AsksForAny() const {
  return !shares || std::any_of(shares->values.begin(), shares->values.end(),
                                [](float value) { return value > 0; });
}

}  // namespace lf

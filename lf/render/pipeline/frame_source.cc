// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/frame_source.h"

#include <fmt/format.h>

namespace lf {

Result<void> FrameSource::CheckNotAllBroken() const {
  if (!AllBroken() || skipped().empty()) return {};
  return InputError(
      fmt::format("every LF image that the frames need is missing or broken; the first: {}",
                  skipped().front().reason));
}

bool FrameSource::AreAllReleased() const {
  for (size_t f = 0; f < frame_count(); ++f)
    if (!IsReleased(f)) return false;
  return true;
}

}  // namespace lf

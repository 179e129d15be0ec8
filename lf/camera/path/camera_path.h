// The camera path after evaluation: one thin-lens camera per frame (thesis 4.5.1).
#pragma once

#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/check.h"
#include "lf/core/ids.h"

namespace lf {

// Limits of a path, which its readers check before memory is allocated.
inline constexpr int kMostFrames = 1'000'000;
inline constexpr int kLargestPlateSide_px = 65536;
inline constexpr long long kMostPlateElements = 1LL << 30;

struct CameraPath {
  double fps = 30;
  double unit_m = 1;                  // metres per world unit
  std::vector<RenderCamera> cameras;  // one for each frame 1, 2, ...; frame 1 is at time 0

  size_t frame_count() const { return cameras.size(); }
  const RenderCamera& Camera(FrameId frame) const {
    LF_CHECK(frame.value >= 1 && frame.value <= cameras.size());
    return cameras[frame.value - 1];
  }
};

}  // namespace lf

// Explains which LF cameras a frame uses and why it does not use the others: the decisions of
// selection (thesis 4.2.1), for people to look at.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/selection/image_index.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {

// In the order of the tests: a camera has the first one that holds.
enum class CameraUse : uint8_t {
  kUsed,      // pixels of its LF image are rays of the frame
  kOutside,   // no ray through lens and sensor plate passes its position (Fig. 4.4)
  kAngle,     // it looks along another direction than --max-angle allows
  kSeesNone,  // its position is right, but no pixel of its LF image sees both the lens and the
              // filmed scene (Fig. 4.5)
  kLimit,     // it comes after the first --max-images of the order
  kNoWeight,  // no point of the lens is nearest to it (doc/lens-integral.md)
};
inline constexpr size_t kCameraUseCount = 6;
// "used", "outside", "angle", "sees-none", "limit", "no-weight"
std::string_view NameOf(CameraUse use);

struct FrameUse {
  std::vector<CameraUse> of_cameras;        // one per LF camera
  std::vector<FrameNeeds::Image> used;      // in the order in which they are read
  std::optional<double> camera_distance_w;  // approximate camera distance around the lens; set if
                                            // there are lens weights
};

// Decides as a render of the frame with these options would. Tests every LF camera, which takes
// some milliseconds for a hundred thousand.
FrameUse UseOfCameras(const ImageIndex& index, const RenderCamera& frame,
                      const NeedsOptions& options, ThreadPool& pool);

}  // namespace lf

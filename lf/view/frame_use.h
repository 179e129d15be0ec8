// SPDX-License-Identifier: Apache-2.0
// Finds which LF cameras a frame uses, and why it does not use the others: the decisions of
// selection (thesis 4.2.1), to be shown to people.
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

// An LF camera gets the first of these values that applies.
enum class CameraUse : uint8_t {
  kUsed,  // pixels of the LF camera's image are read for the frame
  // no ray that passes through the lens and hits the plate passes the position of the LF camera
  // (thesis Fig. 4.4)
  kOutside,
  // the angle between the optical axes of the LF camera and the frame exceeds --max-angle
  kAngle,
  // rays through the lens to the plate pass the position of the LF camera, but no pixel of its
  // image sees both the lens and the filmed region (thesis Fig. 4.5)
  kSeesNone,
  kLimit,  // LF images earlier in the order already reach the limit --max-images
  // the LF camera has no lens weight, because every point of the lens is nearer to another LF
  // camera (doc/lens-integral.md)
  kNoWeight,
};
inline constexpr size_t kCameraUseCount = 6;
// Returns "used", "outside", "angle", "sees-none", "limit" or "no-weight".
std::string_view NameOf(CameraUse use);

struct FrameUse {
  std::vector<CameraUse> of_cameras;    // [LF camera]: kUsed, or why it is not used
  std::vector<FrameNeeds::Image> used;  // LF images that are read, in reading order
  // approximate distance between neighbouring LF cameras around the lens, in world units; set if
  // NeedsOptions::HasNeighbours() is true
  std::optional<double> camera_distance_w;
};

// Returns the decisions that a render of the frame with these options makes. Tests every LF camera,
// which takes some milliseconds for a hundred thousand LF cameras.
FrameUse UseOfCameras(const ImageIndex& index, const RenderCamera& frame,
                      const NeedsOptions& options, ThreadPool& pool);

}  // namespace lf

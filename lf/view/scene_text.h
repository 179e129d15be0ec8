// SPDX-License-Identifier: Apache-2.0
// Writes the cameras of the light field and of the path, and the LF images that each frame uses, as
// plain text, for scripts that plot them (thesis 4.5).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/selection/image_order.h"
#include "lf/view/frame_use.h"

namespace lf {

// Writes lines of words. Positions are in world units, with enough digits to restore the same bits:
//
//   lf_camera ID X Y Z                 every LF camera, ID from 0
//   render_camera FRAME X Y Z          every requested frame
//   collected FRAME ID SHARE           every LF camera that the frame uses, by ascending ID, and
//                                      the share of the LF image's pixels that are read
//
//   ranks  of the LF images in the order in which the frames take them
//   emit  receives the text in parts. If it returns an error, WriteSceneText() returns this error
Result<void> WriteSceneText(const LightField& light_field, const CameraPath& path,
                            const std::vector<FrameId>& frames, ImageRanks ranks,
                            const NeedsOptions& options, ThreadPool& pool,
                            const std::function<Result<void>(const std::string&)>& emit);

}  // namespace lf

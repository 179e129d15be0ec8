// What a frame's file says about the camera that took it.
#pragma once

#include "lf/camera/render_camera.h"
#include "lf/collector/collect.h"
#include "lf/core/ids.h"
#include "lf/imageio/image_file.h"

namespace lf {

// Keys "lf:...", units as in their names; no clock time, so that equal frames are equal files.
ImageMetadata FrameMetadata(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                            Estimator estimator, double fps, const std::string& version);

}  // namespace lf

// The metadata in the file of a frame, which describe its render camera and its rays.
#pragma once

#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/pixels/files/image_file.h"
#include "lf/render/collect/collect.h"

namespace lf {

// Returns the entry "Software", and entries whose names begin with "lf:". The name of an entry ends
// in the unit of its value, if it has one. No entry is a time of day, so that equal frames have
// equal files.
ImageMetadata FrameMetadata(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                            Estimator estimator, double fps, const std::string& version);

}  // namespace lf

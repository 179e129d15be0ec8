// SPDX-License-Identifier: Apache-2.0
// Reads the text form of COLMAP's models: cameras.txt, images.txt, points3D.txt. Lines that start
// with # are comments; a blank line is significant only as the second line of an image.
//
//   cameras   CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]
//   images    two lines: IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, where NAME is the rest of
//             the line; then the 2D points of the image, X Y POINT3D_ID for each
//   points3D  POINT3D_ID X Y Z R G B ERROR, then the point's track, IMAGE_ID POINT2D_IDX for each
//             image that sees it
//
// Internal to this folder.
#pragma once

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"
#include "lf/light_field/colmap/colmap_scene.h"

namespace lf {

// Each function reads the whole stream. kInput if ColmapScene refuses an entry, a camera model is
// not supported, a number is missing or out of range, a line has too many words, or the stream
// cannot be read. The message names the file, the line and the entry.
Result<void> ReadColmapCamerasText(ByteStream* stream, ColmapScene* scene);
Result<void> ReadColmapImagesText(ByteStream* stream, ColmapScene* scene);
// Sink is ColmapScene or ColmapPointsSeen. It receives each point, followed by the images that
// observe the point.
template <class Sink>
Result<void> ReadColmapPointsText(ByteStream* stream, Sink* sink);

// Returns the number of images in images.txt.
Result<uint64_t> CountColmapImagesText(ByteStream* stream);

}  // namespace lf

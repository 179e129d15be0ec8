// The text form of COLMAP's models: cameras.txt, images.txt, points3D.txt. Lines that start with #
// are comments; blank lines count only as the second line of an image.
//
//   cameras   CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]
//   images    two lines: IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, where NAME is all that is
//             left of the line; then its 2D points, X Y POINT3D_ID each
//   points3D  POINT3D_ID X Y Z R G B ERROR, then its track, IMAGE_ID POINT2D_IDX each
//
// Internal to colmap.
#pragma once

#include "lf/colmap/colmap_scene.h"
#include "lf/core/byte_stream.h"
#include "lf/core/result.h"

namespace lf {

// Each takes the whole stream. kInput with file, line and entry: what ColmapScene refuses, words
// that are missing, too many or no numbers.
Result<void> ReadColmapCamerasText(ByteStream* stream, ColmapScene* scene);
Result<void> ReadColmapImagesText(ByteStream* stream, ColmapScene* scene);
// Sink: ColmapScene or ColmapPointsSeen, which is given points and observations.
template <class Sink>
Result<void> ReadColmapPointsText(ByteStream* stream, Sink* sink);

// The number of entries in images.txt.
Result<uint64_t> CountColmapImagesText(ByteStream* stream);

}  // namespace lf

// Reads the text form of COLMAP's models: cameras.txt, images.txt, points3D.txt. Lines that start
// with # are comments; a blank line is significant only as the second line of an image.
//
//   cameras   CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]
//   images    two lines: IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, where NAME is the rest of
//             the line; then its 2D points, X Y POINT3D_ID each
//   points3D  POINT3D_ID X Y Z R G B ERROR, then its track, IMAGE_ID POINT2D_IDX each
//
// Internal to this folder.
#pragma once

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"
#include "lf/light_field/colmap/colmap_scene.h"

namespace lf {

// Each function reads the whole stream. kInput names the file, the line and the entry: an entry
// that ColmapScene refuses, missing words, words that are not numbers, too many words.
Result<void> ReadColmapCamerasText(ByteStream* stream, ColmapScene* scene);
Result<void> ReadColmapImagesText(ByteStream* stream, ColmapScene* scene);
// Sink receives points and observations: ColmapScene or ColmapPointsSeen.
template <class Sink>
Result<void> ReadColmapPointsText(ByteStream* stream, Sink* sink);

// Returns the number of images in images.txt.
Result<uint64_t> CountColmapImagesText(ByteStream* stream);

}  // namespace lf

// The binary form of COLMAP's models: cameras.bin, images.bin, points3D.bin, little-endian, without
// alignment. All numbers of things are uint64 and come before them:
//
//   cameras   count, then each: uint32 id, int32 model, uint64 width, uint64 height, double
//             parameters[as the model has]
//   images    count, then each: uint32 id, double quaternion[4] (w x y z), double translation[3],
//             uint32 camera id, char name[] and a 0, count of 2D points, each 24 bytes
//   points3D  count, then each: uint64 id, double xyz[3], uint8 rgb[3], double error, count of its
//             track, each uint32 image id, uint32 index of the 2D point
//
// Internal to colmap.
#pragma once

#include "lf/colmap/colmap_scene.h"
#include "lf/core/byte_stream.h"
#include "lf/core/result.h"

namespace lf {

// Each takes the whole stream. kInput with file and entry: what ColmapScene refuses, an end too
// early or too late, a count beyond what the file can hold (checked before memory is taken).
Result<void> ReadColmapCamerasBinary(ByteStream* stream, ColmapScene* scene);
Result<void> ReadColmapImagesBinary(ByteStream* stream, ColmapScene* scene);
// Sink: ColmapScene or ColmapPointsSeen, which is given points and observations.
template <class Sink>
Result<void> ReadColmapPointsBinary(ByteStream* stream, Sink* sink);

// The number of images that the file says it holds.
Result<uint64_t> CountColmapImagesBinary(ByteStream* stream);

}  // namespace lf

// Reads the binary form of COLMAP's models: cameras.bin, images.bin, points3D.bin. They are
// little-endian and unaligned. Every list begins with its length, a uint64:
//
//   cameras   count, then each: uint32 id, int32 model, uint64 width, uint64 height, double
//             parameters[as the model has]
//   images    count, then each: uint32 id, double quaternion[4] (w x y z), double translation[3],
//             uint32 camera id, char name[] and a 0, count of 2D points, each 24 bytes
//   points3D  count, then each: uint64 id, double xyz[3], uint8 rgb[3], double error, count of its
//             track, each uint32 image id, uint32 index of the 2D point
//
// Internal to this folder.
#pragma once

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"
#include "lf/light_field/colmap/colmap_scene.h"

namespace lf {

// Each function reads the whole stream. kInput names the file and the entry: an entry that
// ColmapScene refuses, an end that is too early or too late, a count of more than the file can hold
// (checked before memory is allocated).
Result<void> ReadColmapCamerasBinary(ByteStream* stream, ColmapScene* scene);
Result<void> ReadColmapImagesBinary(ByteStream* stream, ColmapScene* scene);
// Sink receives points and observations: ColmapScene or ColmapPointsSeen.
template <class Sink>
Result<void> ReadColmapPointsBinary(ByteStream* stream, Sink* sink);

// Returns the number of images that the file states.
Result<uint64_t> CountColmapImagesBinary(ByteStream* stream);

}  // namespace lf

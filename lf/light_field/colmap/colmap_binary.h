// SPDX-License-Identifier: Apache-2.0
// Reads the binary form of COLMAP's models: cameras.bin, images.bin, points3D.bin. The files are
// little-endian and unaligned. Every list begins with its length, a uint64:
//
//   cameras   count, then for each camera: uint32 id, int32 model, uint64 width, uint64 height,
//             double parameters[] (as many as the model has)
//   images    count, then for each image: uint32 id, double quaternion[4] (w x y z), double
//             translation[3], uint32 camera id, char name[] and a 0, count of its 2D points, 24
//             bytes for each 2D point
//   points3D  count, then for each point: uint64 id, double xyz[3], uint8 rgb[3], double error,
//             length of its track, then for each entry of the track: uint32 image id, uint32 index
//             of the 2D point
//
// Internal to this folder.
#pragma once

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"
#include "lf/light_field/colmap/colmap_scene.h"

namespace lf {

// Each function reads the whole stream. kInput if an entry is not valid or ColmapScene refuses it,
// the stream ends before or after the end of its list or cannot be read, or a count is larger than
// the file allows (checked before memory is allocated). The message names the file and the entry.
Result<void> ReadColmapCamerasBinary(ByteStream* stream, ColmapScene* scene);
Result<void> ReadColmapImagesBinary(ByteStream* stream, ColmapScene* scene);
// Sink is ColmapScene or ColmapPointsSeen. It receives each point, followed by the images that
// observe the point.
template <class Sink>
Result<void> ReadColmapPointsBinary(ByteStream* stream, Sink* sink);

// Returns the number of images that images.bin states at its start. kInput if the file is too small
// for this number, or cannot be read.
Result<uint64_t> CountColmapImagesBinary(ByteStream* stream);

}  // namespace lf

// What the page draws, as arrays of numbers (little endian) that a browser views without parsing
// (doc/formats/page_data.md).
#pragma once

#include <cstddef>
#include <string>

#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"
#include "lf/path/camera_path.h"
#include "lf/visualizer/film_use.h"
#include "lf/visualizer/frame_use.h"
#include "lf/visualizer/watched_render.h"

namespace lf {

// Near the LF cameras: the world's own origin may be so far away that floats cannot tell them
// apart.
Vec3 SceneOrigin(const LightField& light_field);

// float x, y, z of every LF camera from SceneOrigin(), world units: 12 bytes each.
std::string CamerasBytes(const LightField& light_field);

// double numbers of every frame's camera: centre, right, up, forward (12); fx, fy, cx, cy; radius,
// rotation and blades of the aperture; normal and offset of the focus plane (4); time, focal
// length, sensor width, focus distance, horizontal and vertical tilt; width and height of the
// plate.
inline constexpr size_t kFrameNumbers = 31;
std::string FramesBytes(const CameraPath& path);

// uint32 LF cameras, used ones; float camera distance (NaN: none); uint32 0. Then of each that is
// used, in the order they are taken: uint32 id; then float share of its pixels. Then a byte of each
// LF camera: CameraUse.
std::string FrameUseBytes(const LightField& light_field, const FrameUse& use);

// uint16 of each LF camera: frames that take its image.
std::string FilmUseBytes(const FilmUse::Facts& facts);

// uint32 width and height, of the frame in full, and 1 if rays are known; uint32 0 three times;
// then half floats R, G, B, rays of each element, row by row.
std::string PictureBytes(const GrowingPicture& picture);

}  // namespace lf

// Encodes what the page draws as arrays of numbers (little endian), which a browser can view
// without parsing (doc/formats/page_data.md).
#pragma once

#include <cstddef>
#include <string>

#include "lf/camera/path/camera_path.h"
#include "lf/core/geometry.h"
#include "lf/light_field/model/light_field.h"
#include "lf/view/film_use.h"
#include "lf/view/frame_use.h"
#include "lf/view/watched_render.h"

namespace lf {

// Returns the mean position of the LF cameras. The world's origin may be so far away that floats
// relative to it could not tell the cameras apart.
Vec3 SceneOrigin(const LightField& light_field);

// float x, y, z of every LF camera relative to SceneOrigin(), in world units: 12 bytes each.
std::string CamerasBytes(const LightField& light_field);

// double numbers of every frame's camera: centre, right, up, forward (12); fx, fy, cx, cy; radius,
// rotation and blades of the aperture; normal and offset of the focus plane (4); time, focal
// length, sensor width, focus distance, horizontal and vertical tilt; width and height of the
// plate.
inline constexpr size_t kFrameNumbers = 31;
std::string FramesBytes(const CameraPath& path);

// uint32 number of LF cameras, number of used ones; float camera distance (NaN: none); uint32 0.
// Then, for all used LF images in reading order: uint32 ids, followed by float shares of their
// pixels. Then one byte per LF camera: its CameraUse.
std::string FrameUseBytes(const LightField& light_field, const FrameUse& use);

// uint16 per LF camera: number of frames that use its image.
std::string FilmUseBytes(const FilmUse::Facts& facts);

// uint32 width and height, width and height of the full frame, 1 if ray counts are known, and 0
// three times; then half floats R, G, B and ray count of each element, row by row.
std::string PictureBytes(const GrowingPicture& picture);

}  // namespace lf

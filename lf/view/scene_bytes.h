// SPDX-License-Identifier: Apache-2.0
// Encodes the data that the page of lfvisualizer draws as arrays of little-endian numbers, so that
// a browser can use them without parsing (doc/formats/page_data.md).
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "lf/camera/path/evaluate_path.h"
#include "lf/core/geometry.h"
#include "lf/light_field/model/light_field.h"
#include "lf/view/film_use.h"
#include "lf/view/frame_use.h"
#include "lf/view/watched_render.h"

namespace lf {

// Returns the mean position of the LF cameras. CamerasBytes() encodes positions relative to this
// mean, because the world's origin may be so far away that floats relative to the origin would
// round all LF cameras to the same position.
Vec3 SceneOrigin(const LightField& light_field);

// Returns the position of every LF camera relative to SceneOrigin(), in world units: float x, y, z
// (12 bytes each).
std::string CamerasBytes(const LightField& light_field);

// FramesBytes() returns kFrameNumbers doubles for the camera of each of these frames of a path, in
// which PathFrames::Check() has found no error: centre, right, up,
// forward (12); fx, fy, cx, cy; radius, rotation and blades of the aperture; normal and offset of
// the focus plane (4); time, focal length, sensor width, focus distance, horizontal and vertical
// tilt; width and height of the plate; ratio and roundness of the aperture;
// distance and radius of the hood. Units are as in
// RenderCamera.
inline constexpr size_t kFrameNumbers = 35;
std::string FramesBytes(const PathFrames& path, std::span<const FrameId> frames);

// Returns a head of 16 bytes: uint32 number of LF cameras; uint32 number of LF images that are
// read; float FrameUse::camera_distance_w (NaN if unset); uint32 0 (unused). Then the ids (uint32)
// of the LF images that are read, in reading order. Then, in the same order, for each of them, the
// share of its pixels that is read (float). Then one byte per LF camera: its CameraUse.
std::string FrameUseBytes(const LightField& light_field, const FrameUse& use);

// Returns one uint16 per LF camera: FilmUse::Facts::frames_of_image of its image.
std::string FilmUseBytes(const FilmUse::Facts& facts);

// Returns a head of eight uint32: width and height of the picture; width and height of the full
// frame; 1 if ray counts are known, otherwise 0; three unused zeros. Then four half floats for each
// pixel of the picture, row by row: those of GrowingPicture::elements.
std::string PictureBytes(const GrowingPicture& picture);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Brackets: LF images of one pose with different exposures. A bright image shows the shadows with
// little noise, a dark one shows the highlights that are clipped in the bright ones.
//
// The LF images of a pose are used as one picture: each pixel is taken from the brightest LF image
// in which it is not clipped. Every pose therefore sends exactly one ray per pixel, however bright
// the pixel is. If clipped pixels were just left out, poses that see a light would count less than
// poses that see past it, and lights out of focus would be too dark.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns, for each LF image, the number of the first LF image with the same pose and intrinsics.
// Positions count as equal if they differ by at most 1e-9 of the extent of all positions (plus a
// rounding error), rotation matrices if the norm of their difference is at most 1e-6. Time and
// memory are linear in the number of LF images.
std::vector<uint32_t> FirstOfPose(const LightField& light_field);

// Returns how much light the LF image recorded, relative to other LF images: 1 / gain, where `gain`
// is the geometric mean of the gains of the three channels.
double ExposureOf(const LfCamera& camera);

// Exposures that differ by less than this factor count as equal.
inline constexpr double kOneExposure = 1.1;

// Returns the largest radiance that white of integer files becomes by the gains and falloffs of the
// LF images, rounded up to hundredths; at least 1. White is the stored value of the white level.
//   encoding  of the LF images; that of the light field is not used
double BrightestWhite(const LightField& light_field, const RadianceEncoding& encoding);

// Raises RadianceEncoding::max_radiance so that no gain or falloff clips light that integer files
// recorded. Does nothing if an image is a float file.
void MakeRoomForGains(LightField* light_field);

// Decides which pixels of the LF images of a pose send rays, if encoding.masks_clipped is true, by
// setting two members of LfCamera:
//
// LfCamera::masks_clipped is true if the pose has a darker LF image. Therefore the darkest LF image
// of a pose, or its only one, keeps its clipped pixels: no element becomes black because all of its
// light is bright.
//
// LfCamera::brighter is the LF image of the pose with the next larger exposure; if several count as
// having this exposure, the darkest of them. A pixel sends no ray if the same pixel of the brighter
// LF image is not clipped (storage/load/image_reading.h).
//
// All LF images of a pose get the exact pose of the first of them, so that they share lens weights.
//
// If encoding.masks_clipped is false, both members are reset and 0 is returned. Must be called
// again after LF images were renumbered or gains changed. Returns the number of LF images whose
// pose has a darker one.
size_t ApplyBrackets(LightField* light_field);

}  // namespace lf

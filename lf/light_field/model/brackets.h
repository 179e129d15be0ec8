// Brackets: LF images of one pose with different exposures. A bright one shows the shadows with
// little noise, a dark one the highlights that are clipped in the others.
//
// Together they are one picture: each pixel is taken from the brightest LF image in which it is not
// clipped. Every pose therefore sends exactly one ray per pixel, however bright it is. If clipped
// pixels were just left out, poses that see a light would count less than poses that see past it,
// and lights out of focus would be too dark.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns, for each LF image, the first LF image with the same pose and intrinsics. Positions are
// the same within 1e-9 of the extent of all positions, rotations within 1e-6.
// Time and memory are linear in the number of LF images.
std::vector<uint32_t> FirstOfPose(const LightField& light_field);

// Returns how much light the LF image recorded, relative to other LF images: 1 / lf_gain, as the
// geometric mean of the channels.
double ExposureOf(const LfCamera& camera);

// Exposures that differ by less than this factor count as equal.
inline constexpr double kOneExposure = 1.1;

// Raises max_radiance of integer files so that gains and falloffs clip no recorded light. Float
// files keep their range.
void MakeRoomForGains(LightField* light_field);

// Decides which pixels of the LF images of a pose send rays, if encoding.masks_clipped is set:
// - masks_clipped of an LF image is set if its pose has a darker one. The darkest one therefore
// keeps
//   its clipped pixels, and an LF image without a darker one is not masked: no element becomes
//   black because all of its light is bright.
// - brighter of an LF image is the first LF image of its pose with the next larger exposure. A
// pixel
//   that is not clipped there sends no ray from here (storage/load/image_reading.h).
// - The LF images of one pose get the pose of the first of them, so that they share lens weights.
// If encoding.masks_clipped is not set, no LF image is masked and none is brighter. Must be called
// again after LF images were renumbered or gains changed.
// Returns the number of LF images that have a darker one of their pose.
size_t ApplyBrackets(LightField* light_field);

}  // namespace lf

// Brackets: LF images of one pose with different exposures. A bright one shows the shadows with
// little noise, a dark one the highlights that are clipped in the others.
//
// They are one picture, cut into parts: each pixel is taken from the brightest LF image in which it
// is not clipped. So every pose sends one ray of a pixel, whatever its light. If clipped pixels
// alone were left out, poses that see a light would count less than those that see past it, and
// lights out of focus would be too dark.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/capture/light_field.h"

namespace lf {

// Returns, for each LF image, the first LF image of its pose: one with the same position (within
// 1e-9 of the extent of all positions), rotation (1e-6) and the same intrinsics.
// Time and memory are linear in the number of LF images.
std::vector<uint32_t> FirstOfPose(const LightField& light_field);

// Returns how much light the LF image recorded beside others: 1 / lf_gain, the geometric mean of
// the channels.
double ExposureOf(const LfCamera& camera);

// Exposures that differ by less than this factor are taken for one.
inline constexpr double kOneExposure = 1.1;

// Raises max_radiance of integer files so that no recorded light is clipped by gains and falloffs.
// Float files have a range of their own.
void MakeRoomForGains(LightField* light_field);

// Decides, where encoding.masks_clipped is set, which pixels of the LF images of a pose send rays:
// - masks_clipped of an LF image is set if there is a darker one of its pose. So the darkest one
//   keeps its clipped pixels, and an LF image without a darker one of its pose is not masked: no
//   element is black because all of its light is bright.
// - brighter of an LF image is the first one of the next larger exposure of its pose: where that is
//   not clipped, this one sends no ray (store/image_reading.h).
// - LF images of one pose get the pose of the first of them, so that they share lens weights.
// Otherwise nothing is masked, and none is brighter. Must be called again when LF images were
// renumbered or gains changed.
// Returns how many LF images have a darker one of their pose.
size_t ApplyBrackets(LightField* light_field);

}  // namespace lf

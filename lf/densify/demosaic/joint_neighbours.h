// SPDX-License-Identifier: Apache-2.0
// Chooses the LF images that complete the mosaic of another one. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/densify/inverse_depths.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct ChosenNeighbour {
  uint32_t id = 0;
  // Factor of the weights of its samples, at most 1: less for LF cameras farther away, whose
  // surfaces are hidden by others or lit differently, and for which errors of depths count more.
  float nearness = 1;
};

// Returns up to `most` LF images, near ones that look in about the same direction. LF cameras that
// are close together record the same colours of the same points: of those at similar distances,
// they are such that points in the middle of the scene and of the image move by different fractions
// of the mosaic's period of 2 pixels.
//   centres  of all LF cameras
//   range    of the scene
std::vector<ChosenNeighbour> ChooseNeighbours(const LightField& light_field,
                                              std::span<const Vec3> centres, uint32_t id,
                                              const InverseDepths& range, size_t most);

// Returns, for each LF image, those that its depths are searched with: `compare_with`, or LF images
// farther apart if points of the scene move by less than two pixels between these, because so
// little tells no depths.
//   compare_with  CompareWith() of all LF cameras
//   subject       AxesMeetingPoint()
std::vector<std::vector<uint32_t>> FarEnoughForDepths(
    const LightField& light_field, std::span<const Vec3> centres,
    const std::optional<Vec3>& subject, const InverseDepths& range,
    std::vector<std::vector<uint32_t>> compare_with);

}  // namespace lf

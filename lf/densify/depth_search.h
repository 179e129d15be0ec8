// SPDX-License-Identifier: Apache-2.0
// Finds the range of inverse depths of a scene from a few of its LF images.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/inverse_depths.h"
#include "lf/densify/watched_loop.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Returns the inverse depths that are searched in an LF image: from a little below 0, which is
// infinity, to a shift of 3/10 of the longer side between neighbours. If LF cameras look at one
// point, the shift is measured against this point, because such LF images overlap there and not at
// infinity. If the calibration states a range, inverse depths from 1/2 of its least to 3/2 of its
// greatest one are searched, unless none of these is in the range above.
//   camera              of the LF image
//   shift_per_depth_px  median shift between it and its neighbours per unit of inverse depth
//   subject             AxesMeetingPoint() of the light field
//   stated              LightField::depth_range
InverseDepths SearchedRange(const PinholeCamera& camera, double shift_per_depth_px,
                            const std::optional<Vec3>& subject,
                            const std::optional<DepthRange>& stated);

// Compares eight LF images, spread over the light field and reduced to about 200 pixels, with their
// neighbours at the inverse depths of SearchedRange(). Returns the range of the depths of pixels
// with texture that match well and clearly, without the outermost half percent on each side,
// widened by 6 %. A single LF image can only widen the range of the others by a tenth. The range
// does not go beyond infinity unless the depths of many pixels do, as those of rectified images
// may.
//   compare_with  CompareWith() of the LF cameras
// kInput: an LF image cannot be loaded, or fewer than 200 pixels have a sure depth. kInterrupted.
Result<InverseDepths> FindInverseDepths(const LightField& light_field, const LfImageStore& store,
                                        std::span<const std::vector<uint32_t>> compare_with,
                                        ThreadPool& pool, const Watch& watch = {});

// Returns such pixels of eight of the LF images `ids`, spread over these, as points of the scene in
// world coordinates, [LF image][point], without pixels beyond infinity.
Result<std::vector<std::vector<Vec3>>> FindSurePoints(
    const LightField& light_field, const LfImageStore& store,
    std::span<const std::vector<uint32_t>> compare_with, std::span<const uint32_t> ids,
    ThreadPool& pool, const Watch& watch = {});

}  // namespace lf

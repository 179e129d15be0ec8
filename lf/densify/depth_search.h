// Finds the range of inverse depths of a scene from a few of its LF images.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/inverse_depths.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Compares eight LF images, spread over the light field and reduced to about 200 pixels, with their
// neighbours at inverse depths from a little below 0, which is infinity, to a shift of 3/10 of
// their width between neighbours. Returns the range of the depths of pixels with texture that match
// well and clearly, without the outermost half percent on each side, widened by 6 %. The range does
// not go beyond infinity unless the depths of many pixels do, as those of rectified images may.
//   compare_with  CompareWith() of the LF cameras
// kInput: an LF image cannot be loaded, or fewer than 200 pixels have a sure depth.
Result<InverseDepths> FindInverseDepths(const LightField& light_field, const LfImageStore& store,
                                        std::span<const std::vector<uint32_t>> compare_with,
                                        ThreadPool& pool);

}  // namespace lf

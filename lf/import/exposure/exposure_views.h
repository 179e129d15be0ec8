// SPDX-License-Identifier: Apache-2.0
// Reduced LF images (views, ExposureView) for the comparison of exposures. A view contains the
// light in each channel, and a grey image to find depths. The views of a whole light field are in
// memory at the same time.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/focus/reduced_image.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

struct ExposureView {
  std::shared_ptr<const ReducedImage> grey;  // null: the image could not be loaded
  // Light in R, G and B of the pixels of `grey`  [height][width][3], in steps: 1 + kLightSteps *
  // radiance / (largest radiance that the light field can hold); 0 in all channels if one of the
  // LF pixels that were averaged for the pixel is masked or clipped.
  Image<uint16_t> light;

  // Returns the value of `light` at a position in the LF image, interpolated between four pixels; 0
  // if one of the four is 0, or if the position is outside the centres of the border pixels.
  std::array<float, 3> LightsAt(const Vec2& place_px) const;
};
inline constexpr float kLightSteps = 65534;

struct LoadViewsOptions {
  int width_px = 240;                              // largest width of a view
  const std::atomic<bool>* interrupted = nullptr;  // true ends the loading early; null: never
  std::function<void(size_t done, size_t total)> progress;
};

// Returns the number of bytes that a view occupies if it is at most `width_px` wide, for LF images
// with these intrinsics.
size_t ViewBytes(const Intrinsics& k, int width_px);

// Returns the views of all LF images, each of which is loaded once. The view of an image that
// cannot be loaded has no `grey`.
// kInterrupted: `interrupted` is true. kOutput: the machine lacks memory or open files.
//   light_field  a light field without gains and falloffs (WithoutExposure())
//   store        the store of this light field, with Mosaics::kToRgb
Result<std::vector<ExposureView>> LoadExposureViews(const LightField& light_field,
                                                    const LfImageStore& store,
                                                    const LoadViewsOptions& options,
                                                    ThreadPool& pool);

}  // namespace lf

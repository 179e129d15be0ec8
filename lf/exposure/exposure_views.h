// LF images as their exposure is compared: small, their light by channel, and grey to find depths
// in. All of a light field are in memory at the same time.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/focus/reduced_image.h"
#include "lf/store/lf_image_store.h"

namespace lf {

struct ExposureView {
  std::shared_ptr<const ReducedImage> grey;  // null: the image could not be loaded
  // R, G and B of the same pixels  [height][width][3]: kLightSteps times the light relative to
  // what the light field can hold, 0 where one of the LF pixels is masked or clipped.
  Image<uint16_t> light;

  // Light between pixels; 0 where one of the four around is 0, or beyond the image.
  std::array<float, 3> LightsAt(const Vec2& place_px) const;
};
inline constexpr float kLightSteps = 65534;

struct LoadViewsOptions {
  int width_px = 240;                              // the most that a view is wide
  const std::atomic<bool>* interrupted = nullptr;  // looked at now and then
  std::function<void(size_t done, size_t total)> progress;
};

// Bytes that a view of this width takes, for LF images of these sizes.
size_t ViewBytes(const Intrinsics& k, int width_px);

// The views of all LF images, each of which is loaded once; those that cannot be loaded have none.
// kInterrupted. kOutput: the machine lacks memory or open files.
//   light_field  without gains and falloffs (WithoutExposure())
//   store        of it, with Mosaics::kToRgb
Result<std::vector<ExposureView>> LoadExposureViews(const LightField& light_field,
                                                    const LfImageStore& store,
                                                    const LoadViewsOptions& options,
                                                    ThreadPool& pool);

}  // namespace lf

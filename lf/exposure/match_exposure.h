// Estimates how unevenly the LF images of a light field are exposed, and how much light their
// lenses lose towards the corners, from what neighbouring LF images both show.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "lf/camera/vignetting.h"
#include "lf/capture/light_field.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/store/lf_image_store.h"

namespace lf {

struct MatchExposureOptions {
  bool vignetting = false;  // estimate falloffs, too; else those of the light field are kept
  // Small copies of all LF images are in memory. They are made smaller where they would need more.
  size_t memory_bytes = size_t{2} << 30;
  const std::atomic<bool>* interrupted = nullptr;  // looked at now and then
  std::function<void(size_t done, size_t total)> progress;
};

struct FoundFalloff {
  double corner_min = 1, corner_max = 1;  // share of light left in the farthest corner, of cameras
  double reach = 0;                       // the largest r that a tenth of the samples lies beyond
  size_t camera_count = 0;                // falloffs that were estimated
};

struct MatchedExposure {
  std::vector<ChannelGains> gains;      // as LightField::cameras
  std::vector<Vignetting> falloffs;     // as LightField::intrinsics
  float least_gain = 1, most_gain = 1;  // of the LF images that were matched
  std::optional<FoundFalloff> falloff;  // none: not asked for, or not believable
  // Mean difference of what two neighbouring LF images show of the same place, as a share of it:
  // how strong seams are; with the exposure as the calibration has it, and as it is now.
  double step_before = 0, step_after = 0;
  size_t sample_count = 0;  // colours compared, in which the LF images agree
  size_t component_count = 0;
  std::vector<LfImageId> left_alone;  // too little overlap; the gain stays as it was
  std::vector<LfImageId> unreadable;  // the same
};

// The light field whose store MatchExposure() reads: without gains and falloffs.
LightField WithoutExposure(const LightField& light_field);

// Compares the textured places of each LF image, at the depth where the LF images around agree
// (focus/place_depth.h), with what these and the eight nearest ones show there. Dark, clipped and
// masked pixels do not count; FitExposure() leaves out what does not agree. The geometric mean of
// the gains is 1 in each channel and each group of LF images that overlaps tie together. A falloff
// belongs to distinct intrinsics; where most LF images have their own, to all of one size.
//   store  of WithoutExposure(light_field), with Mosaics::kToRgb
// Each LF image is loaded once. kInput: the gains of fewer than half of the LF images can be told
// (they do not overlap enough, or the light on what they show changes from one to the next, so that
// a gain would be a guess); or too many images for the memory. kInterrupted.
Result<MatchedExposure> MatchExposure(const LightField& light_field, const LfImageStore& store,
                                      const MatchExposureOptions& options, ThreadPool& pool);

// Writes gains and falloffs into the light field, and raises max_radiance of integer files so that
// no recorded light is clipped by them.
void ApplyExposure(const MatchedExposure& matched, LightField* light_field);

}  // namespace lf

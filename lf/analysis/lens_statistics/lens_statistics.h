// SPDX-License-Identifier: Apache-2.0
// Statistics over the lens: a frame whose elements are the minimum, maximum, median or trimmed mean
// of the rays of the LF cameras in the lens, instead of their mean. Things in front of the focus
// plane that hide it from some LF cameras, such as leaves, rain or a fence, then vanish.
//
// Each LF camera has one ray in an element: the value that its LF image has at the element's focus
// point, found as the renderer finds it (estimator bilinear, doc/ray.md), if the ray passes through
// the opening of the lens. All rays count the same (lens weights none). A statistic is the mean of
// a range of ranks of these values, sorted in ascending order:
//
//   kMin      the lowest value            for bright things in front of darker ones
//   kMax      the highest value           for dark things in front of brighter ones
//   kMedian   the value in the middle; the mean of the two in the middle of an even number. For
//             things that hide an element from fewer than half of the LF cameras
//   kTrimmed  the mean without floor(trim * n) of the n values at each end: less noise than the
//             median, for things that hide an element from less than the share `trim`
//   kMean     the mean: the frame of lfrenderer --lens-weights none, bit for bit, unless LF images
//             are mosaics, whose pixels are corrected there
//
// Values are integers before they are developed, and statistics are sums and counts of them.
// Therefore the result has the same bits for any order of LF images, any number of threads and any
// memory.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/collection/gather_sampling.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/develop/develop.h"
#include "lf/light_field/model/light_field.h"
#include "lf/pixels/files/image_file.h"
#include "lf/render/collect/collect.h"
#include "lf/render/state/plate_notes.h"
#include "lf/render/state/run_inputs.h"

namespace lf {

enum class LensStatistic : uint8_t { kMin, kMax, kMedian, kTrimmed, kMean };
// Returns "min", "max", "median", "trimmed" or "mean".
const char* NameOf(LensStatistic statistic);

// The values that are sorted.
enum class StatisticOrder : uint8_t {
  // Each colour by itself, as numpy.median(axis=0) and LFToolbox do: the default, because each
  // colour is then the best estimate. A colour may be one that no ray has.
  kChannels,
  // Rays by their luminance: colours stay together, so that each is that of a ray or a mean of
  // rays. Before white balance, if LF images are raw.
  kLuminance,
};
// Returns "channels" or "luminance".
const char* NameOf(StatisticOrder order);

struct LensStatisticOptions {
  LensStatistic statistic = LensStatistic::kMedian;
  double trim = 0.25;  // share of the values that kTrimmed leaves out at each end; [0, 0.5)
  StatisticOrder order = StatisticOrder::kChannels;
  // kMosaic is refused. kAuto stands for kBilinear for kMin and kMax, because the other filters
  // undershoot and overshoot beside edges; otherwise kBicubic for brackets, and kPrefiltered.
  PixelFilter filter = PixelFilter::kAuto;
  std::optional<PixelFootprint> footprint = std::nullopt;  // unset: stated or measured
  std::optional<double> max_angle_rad = std::nullopt;      // as in SelectOptions
  // If set, a frame has the statistic of the rays of at most this number of LF images, above 0: a
  // random choice of those that contribute to it.
  std::optional<size_t> max_image_count = std::nullopt;
  // Memory of the whole work. Frames of a film whose values fit together read each LF image once.
  // If the values of one frame need more, it is made in parts, bands of whole rows, and all LF
  // images are read and collected again for each.
  size_t memory_bytes = size_t{8} << 30;
  bool strict = false;                      // true: a broken LF image is an error
  bool adds_opacity = false;                // as DevelopOptions::adds_opacity
  const std::atomic<bool>* stop = nullptr;  // once true, the function ends; may be null
};

struct StatisticFrame {
  // The developed frame. ray_count is the number of values of each element, of which the statistic
  // takes some. If LF images have opacity and no background, opacity is a fourth channel with the
  // same statistic (kChannels), or that of the same rays (kLuminance).
  DevelopedFrame picture;
  PlateNotes notes;                   // for the metadata of its file
  bool keeps_opacity = false;         // true: the opacity in `picture` is that of the LF images
  size_t image_count = 0;             // LF images that may have a ray, broken ones included
  size_t part_count = 1;              // parts in which the frame was made
  std::vector<SkippedImage> skipped;  // broken LF images, which were left out
};

// Returns the entries "lf:statistic", "lf:statistic_order" and, if it matters, "lf:statistic_trim",
// for the metadata of the frame's file.
ImageMetadata StatisticMetadata(const LensStatisticOptions& options);

// Returns the same as keys and values, by which a resumed render knows the statistic
// (render/state/run_inputs.h).
RunInputs InputsOfStatistic(const LensStatisticOptions& options);

// kUsage: the lens of the camera has a transmission, which has no share in an order of rays.
Result<void> CheckStatisticLens(const RenderCamera& camera);

// Makes a frame of a camera by a statistic over its lens. Virtual LF images are left out. With a
// focal surface, each element is in focus at its own depth.
//   progress  called with the numbers of LF images that are done and in all, by one thread at a
//             time; if there are parts, LF images count once for each. May be empty
// kUsage: options out of range, a mosaic filter, or a lens with a transmission, which has no share
// in an order. kInput: no LF camera sees the frame through its lens, or a broken LF image with
// `strict`. kOutput: memory_bytes is too small; the message names the least that suffices; or the
// machine lacks something. kInterrupted: *stop became true.
Result<StatisticFrame> MakeStatisticFrame(LightField light_field, FrameId id,
                                          const RenderCamera& camera,
                                          const LensStatisticOptions& options, ThreadPool& pool,
                                          const std::function<void(size_t, size_t)>& progress);

}  // namespace lf

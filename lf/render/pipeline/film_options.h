// The options of a film in memory: what its frames are made of, and how the work is done. render.h
// adds where the frames go.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "lf/film/develop/develop.h"
#include "lf/light_field/model/radiance.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/hybrid/rebinned_rays.h"
#include "lf/render/hybrid/render_mode.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/render/package/package.h"
#include "lf/render/state/shard.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {

// These options decide, with the package, every bit of a frame.
struct FilmOptions {
  RenderMode mode = RenderMode::kCollect;
  // Unused with kCollect. If max_cells is 0, as many cells as fit in half of the memory with
  // kRebin, or in a quarter with kHybrid.
  RebinPassOptions rebin;
  // Its filter must not be kMosaic if CountsRays() is true, because its rays count more than once.
  RayReading reading;
  // Must be kNone if CountsRays() is true, because weighted counts are not ray counts, and if the
  // package has no neighbours.
  LensWeights lens_weights = LensWeights::kNone;
  CollectBackEnd back_end = CollectBackEnd::kFast;

  // If set, a frame takes only the first so many LF images of the order that contribute to it. Must
  // not be more than the package was made for.
  std::optional<size_t> max_image_count;
  // If set, frames take only this part of the LF images, and their plates are to be added to those
  // of the other parts. Not with rules that count rays or measure noise, nor with rebinned rays.
  std::optional<Shard> shard;

  // If set, a frame is finished when its elements have so many rays (sample_rule.h). This is
  // decided after multiples of 64 places of the order (of 128, 256, ... if a frame takes only a
  // part of the LF images), so that the frame has the same bits in any run.
  std::optional<uint32_t> stop_at_samples;
  std::optional<uint32_t> require_samples;  // if set, measured for the report of each frame
  // If set, a frame is finished when its noise is at most this (noise_rule.h), in linear radiance
  // with the light field's white as 1. This is decided at the places of NoiseDecisionAfter(). Works
  // with every mode, estimator, filter and weights: with kRebin, frames collect rays to measure the
  // noise, but their pictures do not use them.
  std::optional<double> stop_at_noise;
  std::optional<double> require_noise;  // if set, measured for the report of each frame
  uint32_t smooth_below = 0;            // this and fill_radius_px: film/develop/develop.h
  int fill_radius_px = kFillRadius_px;

  bool Collects() const { return lf::Collects(mode); }
  bool Rebins() const { return lf::Rebins(mode); }
  // Returns true if an option depends on the number of rays of elements.
  bool CountsRays() const { return stop_at_samples || require_samples || smooth_below > 0; }
  // Returns true if an option depends on the differences between LF images in elements.
  bool MeasuresNoise() const { return stop_at_noise || require_noise; }
  bool HasStopRule() const { return stop_at_samples || stop_at_noise; }
  // Returns true if frames have plates, for their pictures or to measure noise.
  bool HasPlates() const { return Collects() || MeasuresNoise(); }
};

// Returns the options with the values that follow from the package and from each other:
//   lens_weights     kNone with kRebin, and instead of kAuto if rays are counted
//   reading.filter   kMosaic instead of kAuto for mosaics, unless rays are counted
//   max_image_count  unless set, the limit that the package was made with
FilmOptions Resolved(FilmOptions options, const Package& package);

// These options decide how the work is done. The frames have the same bits with any values, except
// that the number of rebinned rays follows from the memory if their max_cells is 0.
struct WorkOptions {
  size_t memory_bytes = size_t{8} << 30;
  bool strict = false;        // a broken LF image is an error, and not skipped
  bool whole_images = false;  // SelectOptions::whole_images: slower
  // If given and set by any thread, a step ends soon with kInterrupted. The caller clears the flag,
  // and may go on with the next step.
  const std::atomic<bool>* interrupted = nullptr;
  // If given and set by any thread, everything ends soon with kInterrupted. The caller must then
  // set `interrupted`.
  const std::atomic<bool>* stop = nullptr;

  bool IsStopped() const { return stop != nullptr && *stop; }
};

// Returns the options that decide which LF images frames of the package need
// (render/needs/frame_needs.h).
NeedsOptions NeedsOfFilm(const Package& package, const FilmOptions& film, const WorkOptions& work);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// All that is said of a film besides its light field and its path: what its frames are made of, and
// how the work is done. The defaults are those of all programs. render/pipeline/folder_options.h
// adds the folder that frames are written into.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "lf/film/develop/develop.h"
#include "lf/render/settings/ray_reading.h"
#include "lf/render/settings/rebin_settings.h"
#include "lf/render/settings/render_mode.h"
#include "lf/render/settings/shard.h"
#include "lf/render/settings/stop_rules.h"
#include "lf/selection/image_order.h"
#include "lf/selection/lens_weights/lens_weights.h"

namespace lf {

// These settings, the light field and the path decide every bit of a frame.
struct FilmSettings {
  // Which rays frames are made of: kCollect, kRebin or kHybrid (doc/rebinning.md).
  RenderMode mode = RenderMode::kCollect;
  // The defaults if the mode is kCollect (CheckMode() in interpolation.h). If rebin.max_cells is 0,
  // there are as many pixels or cells as PlanRenderMemory() (hybrid/render_memory.h) has room for.
  // Its seeds are replaced by `seed`.
  RebinSettings rebin;
  // How rays are read from LF images: reading.estimator is kBilinear or kNearest; reading.filter, a
  // PixelFilter, is used by kBilinear alone.
  RayReading reading = Estimator::kBilinear;
  // How LF cameras are weighted by the part of the lens that each stands for: kAuto, kArea, kHat or
  // kNone (doc/lens-integral.md).
  // If CountsRays() is true, must be kNone or kAuto (which Resolved() then replaces by kNone),
  // because weighted counts are not ray counts. Otherwise, must be kNone if the package has no
  // neighbours.
  LensWeights lens_weights = LensWeights::kAuto;
  // kReference is about 50 times slower; tests use it.
  CollectBackEnd back_end = CollectBackEnd::kFast;
  // True: frames of a densified light field have guarded plates (FilmSetup::is_guarded()), so that
  // they are never worse than frames of its recorded LF images alone (doc/densify.md). Changes
  // nothing for other light fields.
  bool guard = true;

  // The next three settings select the LF images of a whole light field. They are unused if
  // packages are rendered, because a package states them itself (PackageChoices).
  ImageOrder order = ImageOrder::kSpread;  // in which frames take LF images
  uint64_t seed = 0;  // of the orders kSpread, kShuffle and kGroups, and of rebinned rays
  // If set, the largest angle between the axes of LF camera and frame, above 0.
  std::optional<double> max_angle_rad;

  // If set, a frame takes at most this number of LF images: the first ones in the order that
  // contribute to it. Must be above 0, and must not exceed the limit that the package was made
  // with. Must be unset if KeepsCells() (interpolation.h).
  std::optional<size_t> max_image_count;
  // If set, frames take only the LF images of this shard. MergeShards() adds their plates to the
  // plates of the other shards, and the gaps of a hybrid to theirs. Cannot be combined with rules
  // that count rays or measure noise, nor with cells or KeptRays::kEdges.
  std::optional<Shard> shard;

  // A frame is finished when this rule is met.
  //   samples  its elements have this number of rays (HasSamples()). The rule is applied only at
  //            ranks of the order that are multiples of 64 (of 128, 256, ... if a frame takes only
  //            a part of the LF images), so that the frame has the same bits in any run.
  //   noise    its noise is at most this (render/collect/noise_rule.h), in linear radiance where
  //            the light field's white is 1. The rule is applied at the ranks that
  //            NoiseDecisionAfter() gives. It can be combined with every mode, estimator, filter
  //            and weights: with kRebin, frames collect rays only to measure the noise, and their
  //            pictures do not use these rays.
  StopRule stop_when;
  // The report of each frame states how far it meets this rule.
  //   samples  the share of its reachable elements that have at least this number of rays in every
  //            channel
  //   noise    its noise, and this limit
  StopRule require;
  // An element with fewer rays than this in a channel, but at least one, is averaged with its
  // neighbours (DevelopOptions). 0 or 1: none is.
  uint32_t smooth_below = 0;
  // An element without a ray in a channel takes light from elements that have one, at most this
  // number of elements away; it stays black if there are none. 0: all stay black.
  int fill_radius_px = kFillRadius_px;
  // True: all frames have an opacity (DevelopOptions::adds_opacity).
  bool adds_opacity = false;

  bool Collects() const { return lf::Collects(mode); }
  bool Rebins() const { return lf::Rebins(mode); }
  // Returns true if a setting depends on how many rays each element has.
  bool CountsRays() const { return stop_when.samples || require.samples || smooth_below > 1; }
  // Returns true if a setting depends on the noise, which is measured by how much the LF images
  // differ within an element.
  bool MeasuresNoise() const { return stop_when.noise || require.noise; }
  bool HasStopRule() const { return stop_when.samples || stop_when.noise; }
  // Returns true if frames have plates. With kRebin, they have plates only to measure the noise.
  bool HasPlates() const { return Collects() || MeasuresNoise(); }
};

// These settings decide how the work is done. The frames have the same bits for any values, with
// one exception: if rebin.max_cells is 0, the number of rebinned rays follows from memory_bytes.
struct WorkSettings {
  // Memory for LF images, frames and rebinned rays. Films that need more are rendered in parts.
  size_t memory_bytes = size_t{8} << 30;
  // Number of threads of RenderFrame(), FrameRenderer and RenderFilm() (api/); 0: one for each
  // processor.
  int threads = 0;
  bool strict = false;        // true: a broken LF image is an error; false: it is skipped
  bool whole_images = false;  // value of SelectOptions::whole_images; true is slower
  // If not null: when any thread sets it to true, a step ends soon with kInterrupted. The caller
  // then clears the flag, and may continue with the next step.
  const std::atomic<bool>* interrupted = nullptr;
  // If not null: when any thread sets it to true, all functions that take these settings end soon
  // with kInterrupted. That thread must then set `interrupted` to true as well, because a step
  // (FrameRenderer::Step()) reads only `interrupted`.
  const std::atomic<bool>* stop = nullptr;

  bool IsStopped() const { return stop != nullptr && *stop; }
};

}  // namespace lf

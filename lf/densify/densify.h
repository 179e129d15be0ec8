// SPDX-License-Identifier: Apache-2.0
// Makes a sparse light field dense: puts virtual LF images between the recorded ones, and writes
// all of them into a packed store.
//
//   1. The inverse depth of every pixel is found by comparing an LF image with its neighbours
//      (depth_sweep.h).
//   2. Depths on which neighbours do not agree are replaced.
//   3. Virtual LF images are made of the recorded ones around them (synthesis.h).
//
// A virtual LF image depends only on a few recorded LF images, so that it has the same bits for any
// number of threads, and however often the work was interrupted.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/densify_plan.h"
#include "lf/densify/self_test.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct DensifyOptions {
  std::filesystem::path store;  // path of the packed store, such as STORE.lfs
  DensifyChoices choices;
  size_t memory_bytes = size_t{2} << 30;  // for LF images that are kept in memory
  // Folder in which depth planes are kept for other calls (depth_cache.h); empty: they are not
  // kept.
  std::filesystem::path cache = {};
  // True: resumes an unfinished store, or begins a new one if there is none. If the store is
  // complete, it must match the options and the light field, except for its background, and is
  // kept.
  bool resume = false;
  bool overwrite = false;   // true: replaces an existing store, unfinished or complete
  bool strict = false;      // true: an LF image that cannot be read is an error
  std::string source_name;  // LIGHTFIELD, as the user gave it
  std::vector<std::string> source_options = {};  // its options, which advised commands repeat
  std::string version;                           // version of the program
  const std::atomic<bool>* interrupted = nullptr;
};

struct DensifyProgress {
  const char* step = "";  // items of the step that is being done
  size_t done = 0;
  size_t total = 0;
  // Work of all steps of this call, in comparisons of a pixel with a neighbour at one depth; other
  // work counts as the comparisons that take as long. The total is a guess until the range of
  // depths is known.
  uint64_t work_done = 0;
  uint64_t work_total = 1;
};

struct DensifyReport {
  // Says that the LF cameras are dense enough, and then nothing was written; otherwise empty.
  std::string dense;
  bool was_there = false;  // true if the store was complete, so that nothing was written
  struct Skipped {
    std::string name;
    std::string reason;
  };
  std::vector<Skipped> skipped;  // LF images that are not used because they cannot be read
  size_t recorded_count = 0;     // number of recorded LF images that are used
  size_t virtual_count = 0;
  // Names of LF images that are not used because their poses are wrong: they contradict those in
  // the lenses of the film (GroupOfFilm()), whose share of the nearness to the lenses is also told.
  std::vector<std::string> left_out;
  double kept_share = 1;
  size_t asked_count() const { return recorded_count + skipped.size() + left_out.size(); }
  InverseDepths range;
  int planes = 0;         // number of inverse depths that were compared
  double shift_px = 0;    // DensifyPlan::ShiftPx()
  double distance_w = 0;  // distance between neighbouring virtual LF cameras
  double spacing_px = 0;  // DensifyPlan::spacing_px
  // Diameter of the largest lens of the film that would be filled with virtual LF images all around
  // its middle; unset: all lenses are filled, or there is no film.
  std::optional<double> filled_diameter_w;
  std::vector<LeftOut> tests;
  // Share of the pixels on whose depth two neighbours agree, without transparent pixels.
  double agreeing_share = 0;
  // Mean of VirtualImage::weak_share of the virtual LF images that were made.
  double weak_share = 0;
  size_t cached_planes = 0;  // number of depth planes that were kept by an earlier call
  // Work of this call: CPU time, and the number of pixels that were swept and made.
  double sweep_cpu_s = 0, synthesis_cpu_s = 0;
  double swept_pixels = 0, made_pixels = 0;
};

// Writes the recorded LF images and virtual ones into options.store, unless the LF cameras are
// dense enough already (DensifyReport::dense). If alpha is light, virtual LF images have opacities,
// whatever the background is, and the store records the alpha and the background of the light
// field. kInput: the light field cannot be densified
// (PlanDensify()), has brackets, has groups of LF images that contradict each other, none of which
// clearly stands in the lenses of a film (FindContradiction()), or fails its test
// (TestByLeavingOut()) unless choices.force is set; or an LF image cannot be read and `strict` is
// set, or fewer than three can. kUsage, kOutput as PackedStoreWriter; the store exists and no
// option says what to do with it. kInterrupted: finished work is kept.
Result<DensifyReport> Densify(const LightField& light_field, const DensifyOptions& options,
                              ThreadPool& pool,
                              const std::function<void(const DensifyProgress&)>& progress);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/develop_frame.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "lf/core/median.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/render/collect/develop_options.h"
#include "lf/render/state/run_inputs.h"

namespace lf {
namespace {

// Returns the median of the values above 0; 0 if there are none.
double MedianOfSeen(const LargeVector<float>& values) {
  std::vector<float> seen;
  std::copy_if(values.begin(), values.end(), std::back_inserter(seen),
               [](float value) { return value > 0; });
  return seen.empty() ? 0 : Median(std::move(seen));
}

}  // namespace

PlateNotes MakePlateNotes(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                          std::span<const FrameLens> lenses, const RadianceEncoding& encoding) {
  PlateNotes notes;
  notes.frame = frame;
  notes.camera = camera;
  notes.rays = rays;
  notes.develop = DevelopOptionsOf(encoding);
  if (const std::optional<FrameLens::Facts> facts = FactsOf(lenses))
    notes.weighed =
        PlateNotes::Weighed{facts->hat_share, facts->coverage, EffectiveCountsOf(lenses)};
  return notes;
}

RenderedFrame DevelopFrame(const PlateNotes& notes, const SensorPlate& plate,
                           const Completion* completion, bool with_effective, ThreadPool& pool,
                           const std::function<bool()>& is_interrupted) {
  const auto start = std::chrono::steady_clock::now();
  DevelopOptions develop = notes.develop;
  develop.is_interrupted = is_interrupted;
  develop.completion = completion;
  // Notes that were read from a file lack these two.
  develop.transparent = LfPixels::kTransparent;
  develop.opaque = LfPixels::kOpaque;
  Image<float> effective;
  if (notes.weighed && (with_effective || plate.is_guarded()))
    effective = SpreadOverPlate(notes.weighed->effective_counts, notes.camera.pinhole.intrinsics);
  if (plate.is_guarded() && !effective.empty()) develop.effective_count = &effective;
  RenderedFrame frame;
  frame.picture = Develop(plate, develop, pool);
  if (is_interrupted && is_interrupted()) return frame;
  frame.report = MakeFrameReport(notes.frame, notes.rays, frame.picture);
  frame.report.camera = InputsOfCamera(notes.frame, notes.camera, notes.shutter);
  frame.report.ranks_done = notes.ranks_done;
  if (notes.weighed) {
    const Image<float>& counts = notes.weighed->effective_counts;
    frame.report.weighed = {MedianOfSeen(counts.pixels()), notes.weighed->hat_share,
                            notes.weighed->coverage};
    if (with_effective) frame.picture.effective_count = std::move(effective);
  }
  frame.report.develop_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return frame;
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/forecast_rebinning.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "lf/render/collect/frame_lens.h"
#include "lf/render/hybrid/film_slabs.h"
#include "lf/render/hybrid/lens_gaps.h"
#include "lf/render/hybrid/rebinned_rays.h"

namespace lf {

Result<RebinCost> ForecastRebinning(const ImageIndex& index, const LfImageStore& store,
                                    const CameraPath& path,
                                    std::span<const FrameSurroundings> surroundings,
                                    std::span<const FrameId> frames, const NeedsOptions& needs,
                                    const RayReading& reading, size_t max_cells, ThreadPool& pool) {
  constexpr size_t kRebinnedImages = 16;
  const double start_s = ProcessCpuSeconds();
  std::vector<SampledFrame> sampled;
  for (size_t i = 0; i < path.frame_count(); ++i)
    sampled.push_back({path.cameras[i], SamplingOf(surroundings[i])});
  RebinSettings options = needs.rebin;
  options.max_cells = max_cells;
  const FilmSlabs slabs(sampled, path.first_frame, options.query, options.slab);
  double lens_s = 0;  // part of RenderRate::finish_s
  std::vector<RebinnedFrame> rebinned;
  for (const FrameId frame : frames) {
    const RenderCamera& camera = path.Camera(frame);
    const double distance_w = sampled[path.frames().IndexOf(frame)].sampling.lf.camera_distance_w;
    const double lens_start_s = ProcessCpuSeconds();
    const FrameLens lens(index, camera, needs.lens_weights, needs.select, pool, distance_w);
    lens_s += ProcessCpuSeconds() - lens_start_s;
    CollectedWeights collected;
    if (Collects(needs.mode)) collected = [&lens](LfImageId id) { return lens.WeightsOf(id); };
    rebinned.push_back(
        {frame, LensGaps(index, camera, collected, !Collects(needs.mode) || lens.tests_opening(),
                         {}, needs.select, options.query, pool, distance_w)});
  }
  return MeasureRebinning(index, store, slabs, std::move(rebinned), Collects(needs.mode),
                          needs.select, options, reading, ProcessCpuSeconds() - start_s - lens_s,
                          kRebinnedImages, pool);
}

}  // namespace lf

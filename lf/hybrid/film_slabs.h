// The slabs of a film (rebinning/slab_plan.h), planned for all of its frames: a frame has the same
// slab, and so the same cells, whichever frames are rendered with it, in passes or from packages.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/hybrid/frame_sampling.h"
#include "lf/rebinning/slab_plan.h"

namespace lf {

class FilmSlabs {
 public:
  //   frames    all of the film, frame 1 first
  //   sampling  of each: SamplingOf() in the whole light field
  FilmSlabs(std::span<const RenderCamera> frames, std::span<const FrameSampling> sampling,
            const QueryOptions& options, const SlabChoices& choices);

  // Returns the number of the frame's slab; none if no LF camera is around its lens.
  std::optional<size_t> SlabOf(FrameId frame) const { return slab_of_[frame.value - 1]; }
  // begin, end and bounds are those of all of its frames.
  const SlabSection& section(size_t slab) const { return sections_[slab]; }

 private:
  std::vector<SlabSection> sections_;
  std::vector<std::optional<size_t>> slab_of_;  // [frame - 1]
};

}  // namespace lf

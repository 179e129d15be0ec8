// SPDX-License-Identifier: Apache-2.0
// The slabs of a film: the pairs of planes on which its rebinned rays are described
// (rebinning/slab_plan.h). They are planned for all frames of the film together, so that the slab
// of a frame, and therefore its cells, do not depend on which frames are rendered in the same pass
// or package.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/rebinning/slab_plan.h"
#include "lf/render/hybrid/frame_sampling.h"

namespace lf {

struct SampledFrame {
  RenderCamera camera;
  FrameSampling sampling;  // result of SamplingOf() in the whole light field
};

class FilmSlabs {
 public:
  //   frames       all frames of the film, in their order
  //   first_frame  number of the first one
  FilmSlabs(std::span<const SampledFrame> frames, uint32_t first_frame, const QueryOptions& options,
            const SlabChoices& choices);

  // Returns the index of the frame's slab; nullopt if there are no LF cameras around its lens.
  std::optional<size_t> SlabOf(FrameId frame) const {
    return slab_of_[FrameNumbers{first_frame_, slab_of_.size()}.IndexOf(frame)];
  }
  // Returns the section of the film that has the slab with this index. SlabSection::bounds contain
  // the rays of all frames of the film that use the slab. SlabSection::begin and end count only
  // frames that have LF cameras around their lenses.
  const SlabSection& section(size_t slab) const { return sections_[slab]; }

 private:
  std::vector<SlabSection> sections_;
  std::vector<std::optional<size_t>> slab_of_;  // [index of the frame]: index in sections_
  uint32_t first_frame_;
};

}  // namespace lf

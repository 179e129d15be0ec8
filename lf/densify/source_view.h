// SPDX-License-Identifier: Apache-2.0
// A recorded LF image, seen from a virtual LF camera. Internal to this folder.
#pragma once

#include <span>

#include "lf/camera/pinhole.h"
#include "lf/core/image.h"
#include "lf/densify/inverse_depths.h"
#include "lf/densify/pair_map.h"
#include "lf/densify/synthesis.h"
#include "lf/densify/synthesis_row.h"
#include "lf/densify/watched_loop.h"

namespace lf {

inline constexpr float kNoDepth = -1e30f;  // of pixels that a source does not show

class SourceView {
 public:
  //   camera  the virtual LF camera
  SourceView(const PinholeCamera& camera, const Source& source, const InverseDepths& range);

  float weight() const { return source_.weight; }

  // Writes the nearest depth that the source shows at each pixel of the virtual image, or kNoDepth.
  void Project(Image<float>* candidates, InterruptFlag interrupted) const;

  // Finds the points of at most kChunk pixels of a row in the source, and adds the votes of the
  // source for them (AddVotes()).
  //   depths  inverse depths of the points, for the virtual LF camera
  void See(int x_begin, int y, int count, const float* depths, float per_tolerance,
           SeenPoints* seen, float* errors, float* votes) const;

  // Interpolates the colours of some points of a chunk (SampleRow()).
  void Sample(const SeenPoints& seen, std::span<const int> pixels, PointColours* colours) const {
    SampleRow(source_.image->light, !source_.image->without_depth.empty(), seen, pixels, colours);
  }

  // Returns true if the source shows that nothing is at the point of the centre of a pixel.
  bool SeesNothingAt(int x, int y, float depth) const {
    return HasEmpty() &&
           IsMarkedAt(source_.image->empty, to_source_.At(static_cast<float>(x) + 0.5f,
                                                          static_cast<float>(y) + 0.5f, depth));
  }
  bool HasEmpty() const { return !source_.image->empty.empty(); }

 private:
  bool ShowsNothing(int x, int y) const { return IsTransparent(&source_.image->tones.at(x, y)); }
  float DepthOf(uint16_t number) const { return first_ + static_cast<float>(number) * step_; }
  // Returns the depth of the nearest pixel. A transparent pixel has none: it stands for the outline
  // among the four pixels around the place. Returns -infinity if there is no outline.
  float DepthSeenAt(float u_px, float v_px) const;

  const Source source_;
  const PairMap from_source_, to_source_;
  const float step_, first_;  // `first_` is the inverse depth of the number 0
};

}  // namespace lf

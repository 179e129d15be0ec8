// The LF images that an exported page renders live pictures of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/visualizer/page_scene.h"

#include "lf/core/ids.h"
#include "lf/core/result.h"

namespace lf {

// The choice of LF images that an export has for live pictures.
struct LivePlan {
  std::string refused;         // why there are no live pictures; "" if there are some
  int divisor = 1;             // LF images are shrunken by it
  std::vector<LfImageId> ids;  // in the order in which they are loaded, spread over the lens
};

struct EncodedLfImage {
  std::string bytes;
  std::string ending;  // ".jpg", or ".png" if pixels are masked, which then are transparent
};

// Chooses size and number of the LF images so that they take about `most_bytes`: those that the
// film uses, or a part of them, and others around them if there is room.
//   used  ids of the LF images that the film uses
LivePlan PlanLiveExport(PageScene& scene, std::span<const uint32_t> used, size_t most_bytes);

// Returns an LF image, shrunken, in sRGB.
Result<EncodedLfImage> EncodeForLive(const PageScene& scene, LfImageId id, int divisor);

// Returns live.json (doc/formats/page_data.md).
//   names  of the files of plan.ids; "" for those that are missing
std::string LiveJson(const PageScene& scene, const LivePlan& plan,
                     std::span<const std::string> names);

}  // namespace lf

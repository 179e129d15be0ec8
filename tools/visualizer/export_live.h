// SPDX-License-Identifier: Apache-2.0
// The LF images in an exported page, from which it renders live pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/visualizer/page_scene.h"

#include "lf/camera/pinhole.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"

namespace lf {

// The LF images that are exported for live pictures.
struct LivePlan {
  std::string refused;  // why there are no live pictures; "" if there are some
  int divisor = 1;      // factor by which LF images are shrunken
  // Intrinsics of the exported LF images if those of the light field are distorted; unset: exported
  // LF images are only shrunken.
  std::optional<Intrinsics> pinhole;
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

// Returns an LF image, shrunken and without distortion, as the bytes of a picture in sRGB. Errors
// are those of LoadReducedWithoutThrowing() and of the encoders.
Result<EncodedLfImage> EncodeForLive(const PageScene& scene, const LivePlan& plan, LfImageId id);

// Returns live.json (doc/formats/page_data.md).
//   names  names of the data of plan.ids; "" for LF images that could not be read
std::string LiveJson(const PageScene& scene, const LivePlan& plan,
                     std::span<const std::string> names);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// The ideal pixels (camera/ideal_pixels.h) of LF cameras with distortion, made once for all LF
// images that share them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>

#include "lf/camera/ideal_pixels.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct BatchImage;

class SharedIdealPixels {
 public:
  // A function that calls its second argument for every i in [0, count), in parallel, such as
  // ThreadPool::ForEach().
  using ForEach = std::function<void(size_t count, const std::function<void(size_t)>&)>;

  // Makes the ideal pixels that the LF images of the batch need and that are not kept yet. Drops
  // the kept ideal pixels that this batch does not need.
  void Keep(const LightField& light_field, std::span<const BatchImage> batch,
            const ForEach& for_each);

  // Returns the ideal pixels that are kept for these intrinsics; null if none are kept. None are
  // ever kept for intrinsics without lens distortion. Any number of threads may call it at the same
  // time.
  std::shared_ptr<const IdealPixels> Of(uint32_t intrinsics_index) const;

 private:
  std::map<uint32_t, std::shared_ptr<const IdealPixels>> kept_;  // by index of intrinsics
};

}  // namespace lf

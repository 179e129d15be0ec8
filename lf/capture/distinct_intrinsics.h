// The list LightField::intrinsics while it grows. For the readers of calibrations.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "lf/camera/pinhole.h"

namespace lf {

class DistinctIntrinsics {
 public:
  // The index of these intrinsics in the list, where they are put if new.
  uint32_t IndexOf(const Intrinsics& k) {
    Key key = {k.fx_px,
               k.fy_px,
               k.cx_px,
               k.cy_px,
               k.skew_px,
               static_cast<double>(k.width_px),
               static_cast<double>(k.height_px),
               static_cast<double>(k.distortion.model)};
    std::copy(k.distortion.parameters.begin(), k.distortion.parameters.end(), key.begin() + 8);
    const auto [entry, is_new] = index_.try_emplace(key, static_cast<uint32_t>(list_.size()));
    if (is_new) list_.push_back(k);
    return entry->second;
  }
  std::vector<Intrinsics> Take() { return std::move(list_); }

 private:
  using Key = std::array<double, 16>;
  std::map<Key, uint32_t> index_;
  std::vector<Intrinsics> list_;
};

}  // namespace lf

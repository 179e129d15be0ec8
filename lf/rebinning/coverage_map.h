// SPDX-License-Identifier: Apache-2.0
// A map of the rays that some frames query, so that no other rays are kept (thesis 4.3.2, "coverage
// map").
//
// The bounds of the slab are cut into cells of one bit each, far wider than the cells that rays are
// sorted into (slab.h). Rays are spawned on the lenses of all frames, less than one such cell
// apart, and mark the cells that they pass through; then the neighbours of each marked cell are
// marked. The map covers every ray that is within reach of a query, and some others.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/core/large_vector.h"
#include "lf/core/parallel.h"
#include "lf/rebinning/frame_queries.h"
#include "lf/rebinning/rebin_options.h"
#include "lf/rebinning/slab_plan.h"

namespace lf {

class CoverageMap {
 public:
  CoverageMap() = default;  // covers nothing

  //   frames  all frames of the section; some may query no rays
  CoverageMap(const SlabSection& section, std::span<const FrameQueries> frames,
              const CoverageOptions& options, ThreadPool& pool);

  bool is_empty() const { return bits_.empty(); }
  bool Covers(const SlabPoint& point) const {
    if (bits_.empty()) return false;
    size_t index = 0;
    for (int k = 0; k < kCellAxes; ++k) {
      const double place = (point[k] - low_[k]) * per_width_[k];
      if (!(place >= 0 && place < static_cast<double>(count_[k]))) return false;
      index = index * count_[k] + static_cast<size_t>(place);
    }
    return (bits_[index / kBits] >> (index % kBits) & 1) != 0;
  }

  size_t size_bytes() const { return bits_.size() * sizeof(uint64_t); }
  double share() const;  // share of all cells that are marked, 0 to 1

 private:
  static constexpr size_t kBits = 64;
  void SetGrid(const SlabSection& section, std::span<const FrameQueries> frames,
               const CoverageOptions& options);
  void Spawn(const Slab& slab, const FrameQueries& frame);
  void Mark(const SlabPoint& point);
  void WidenAlong(int axis, ThreadPool& pool);

  SlabPoint low_ = SlabPoint::Zero();
  std::array<double, kCellAxes> per_width_ = {};
  // Number of cells along each axis; along the last axis, a multiple of kBits.
  std::array<size_t, kCellAxes> count_ = {};
  std::array<double, 2> width_w_ = {};  // width of a cell on the st and on the uv plane
  LargeVector<uint64_t> bits_;
};

}  // namespace lf

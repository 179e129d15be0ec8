// SPDX-License-Identifier: Apache-2.0
// Chooses the position of the slab and the width of its cells, so that the cells distinguish the
// rays that some frames query (thesis 4.3.2, "primary slab").
//
// The st plane passes through the mean position of the frames' cameras and faces in their mean
// direction. The uv plane is parallel to it, at the focus of the frames: half-way in disparity
// between the nearest and the farthest focus distance.
//
// On the uv plane, a cell is as wide as a quarter of an LF pixel there or an eighth of an element,
// whichever is more. On the st plane, a cell is at most as wide as a quarter of the distance
// between LF cameras. If a frame focuses beside the uv plane, cells of the st plane are narrower:
// while a ray through a point in focus moves across one of them, it must not move across more than
// one cell of the uv plane. Cells of the st plane are never narrower than 1/256 of the distance
// between LF cameras.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/rebinning/frame_queries.h"
#include "lf/rebinning/rebin_options.h"
#include "lf/rebinning/slab.h"

namespace lf {

// Bounds of points of a slab, in world units along its axes.
struct SlabBounds {
  SlabPoint low = SlabPoint::Zero();
  SlabPoint high = SlabPoint::Zero();
};

// The slab of the frames [begin, end).
struct SlabSection {
  size_t begin = 0;
  size_t end = 0;
  Slab slab;
  SlabBounds bounds;      // bounds of the rays within reach of the frames' queries
  double pixel_uv_w = 0;  // width of an LF pixel on the uv plane; the smallest of all frames
};

// Returns one section if all frames look in about the same direction, all their rays cut both
// planes, and cells are fine enough: keys have 16 bits for each number (slab.h), which limits the
// number of cells. Otherwise halves the frames until this is true of each section, or the section
// has one frame.
std::vector<SlabSection> PlanSlabs(std::span<const FrameQueries> frames,
                                   const SlabChoices& choices);

// Returns the bounds, on the slab, of all rays within reach of the frames' queries; none if no ray
// cuts both planes.
//   all_cut  becomes false if a ray does not cut both planes; may be null
std::optional<SlabBounds> BoundsOf(const Slab& slab, std::span<const FrameQueries> frames,
                                   bool* all_cut = nullptr);

}  // namespace lf

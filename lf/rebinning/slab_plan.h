// Where the slab is, and how fine its cells are, so that the rays of some frames are told apart
// well (thesis 4.3.2, "primary slab").
//
// The st plane is among the positions of the frames and faces as they do; the uv plane is parallel
// to it, at their focus: half-way, in disparities, between the nearest and the farthest. Cells are
// a quarter as wide on the uv plane as an LF pixel there, or an eighth of an element, whichever is
// more. On the st plane they are a quarter as wide as LF cameras are apart, and so
// narrow that what is in focus moves by no more than a cell of the uv plane where the focus is
// pulled to.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/rebinning/frame_queries.h"
#include "lf/rebinning/slab.h"

namespace lf {

// How densely the light field was recorded around the frames.
struct LfSampling {
  double camera_distance_w = 0;      // between neighbours
  double pixel_rad = 0;              // what one LF pixel sees
  Vec3 middle_world = Vec3::Zero();  // of the LF cameras
};

// Each overrides what would be chosen.
struct SlabChoices {
  std::optional<Vec3> position_world;    // of the st plane
  std::optional<Vec3> forward_world;     // that it faces
  std::optional<double> uv_distance_w;   // of the uv plane from the st plane; above 0
  std::optional<double> r_st_w, r_uv_w;  // above 0
};

// World units along the slab's axes.
struct SlabBounds {
  SlabPoint low = SlabPoint::Zero();
  SlabPoint high = SlabPoint::Zero();
};

// Of the frames [begin, end).
struct SlabSection {
  size_t begin = 0;
  size_t end = 0;
  Slab slab;
  SlabBounds bounds;      // of the rays that are asked for, reach and all
  double pixel_uv_w = 0;  // an LF pixel on the uv plane
};

// One section, or where frames look in different directions, or where its cells would be too coarse
// since keys have 16 bits for each number (slab.h), several: halved until it fits.
std::vector<SlabSection> PlanSlabs(std::span<const FrameQueries> frames,
                                   std::span<const LfSampling> sampling,
                                   const SlabChoices& choices);

// Returns the bounds on the slab of all rays that the frames ask for, reach and all; none if no ray
// cuts both planes.
//   all_cut  becomes false if some ray does not; may be null
std::optional<SlabBounds> BoundsOf(const Slab& slab, std::span<const FrameQueries> frames,
                                   bool* all_cut = nullptr);

}  // namespace lf

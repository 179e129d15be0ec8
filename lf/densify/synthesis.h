// SPDX-License-Identifier: Apache-2.0
// Computes the image of an LF camera that recorded none, from LF images around it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/image.h"
#include "lf/densify/depth_plane.h"
#include "lf/densify/inverse_depths.h"
#include "lf/densify/watched_loop.h"
#include "lf/densify/working_image.h"

namespace lf {

// A recorded LF image that a virtual one is made of.
struct Source {
  const WorkingImage* image = nullptr;
  const DepthPlane* plane = nullptr;
  float weight = 0;  // above 0; the weights of all sources add up to 1
};

struct VirtualImage {
  Image<uint16_t> light;  // WorkingImage::light; masked where no source shows the pixel
  // [height][width]: trust in the pixel (TrustOf()), LfPixels::kTrusted for what is transparent; 0
  // if no source shows it.
  Image<uint8_t> trust;
  // Share of the pixels on whose depth sources with less than 2/5 of the weight agree, without
  // transparent pixels.
  double weak_share = 0;
};

// Memory of Synthesize(), which is expensive to allocate for each image. Its content has no meaning
// for others.
struct SynthesisMemory {
  std::vector<Image<float>> candidates;
  Image<float> holes;
  VirtualImage image;
};

// Computes the image of `camera`, in three steps:
//   1. The pixels of each source are projected to the camera. The nearest depth at each of its
//      pixels is that source's candidate.
//   2. All sources vote on each candidate: a source whose plane has about the same depth at its
//      place votes for it with its weight. A source that sees through the place, because it shows a
//      larger depth there, votes against it.
//   3. The colour is the mean of the sources' colours at the elected depth, interpolated in linear
//      light, each with its weight and its agreement. Close elections mix the colours of several
//      candidates, because a pixel at an outline shows two depths (Penner and Zhang, "Soft 3D
//      reconstruction for view synthesis", 2017).
// A pixel without candidate takes the largest depth that a candidate around it has.
//
// Opacity is a channel like the colours, which are premultiplied. Transparent pixels project no
// candidate. A candidate at whose place a source is empty (WorkingImage::empty) is removed: nothing
// can be there. So is the depth of a pixel without candidate, and the pixel is then transparent. A
// source that is partly transparent at a place shows that nothing is there with the rest of its
// weight, whatever its depth.
//   camera       without distortion
//   sources      1 to kMostSources
//   tolerance    of inverse depths that count as equal
//   interrupted  once it is set, the result must not be used
//   memory       keeps the result until the next call with it
inline constexpr size_t kMostSources = 8;
const VirtualImage& Synthesize(const PinholeCamera& camera, std::span<const Source> sources,
                               const InverseDepths& range, double tolerance,
                               InterruptFlag interrupted, SynthesisMemory* memory);
// Makes such an image in memory of its own.
VirtualImage Synthesize(const PinholeCamera& camera, std::span<const Source> sources,
                        const InverseDepths& range, double tolerance,
                        InterruptFlag interrupted = nullptr);

}  // namespace lf

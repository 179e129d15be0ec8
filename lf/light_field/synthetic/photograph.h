// SPDX-License-Identifier: Apache-2.0
// Takes pictures of a scene: through a pinhole (an LF image), and through a thin lens (the ground
// truth with which a render of the light field is compared).
#pragma once

#include <cstdint>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/light_field/synthetic/scene.h"

namespace lf {

// The background that is seen where there is no surface.
enum class Surroundings : uint8_t {
  kShown,        // room and glows; pictures are R, G, B
  kTransparent,  // nothing, not even glows; a ray that hits a surface, of glass or not, is opaque.
                 // Pictures are R, G, B, A: the light of surfaces, premultiplied by A, the share of
                 // rays that hit a surface
};

// Returns the picture that a pinhole camera records: linear radiance, averaged over the square of
// each pixel; black where the camera's lens lets no ray through.
//   samples  rays per pixel at edges in the picture, spread over the pixel's square; rounded up to
//            a square number. A pixel is at an edge if a neighbour shows another surface or another
//            brightness. Other pixels are sampled by one ray through their centre
// Shape [height][width][3], or [4] with kTransparent.
Image<float> Photograph(const Scene& scene, const PinholeCamera& camera, int samples,
                        Surroundings surroundings = Surroundings::kShown);

struct LensSampling {
  // Number of rays per element, each through its own point of the lens and of the element; rounded
  // up to a square number. Glows and textures are averaged over the part of lens and element that
  // each ray represents.
  int samples = 529;
  uint64_t seed = 0;  // determines the lens points
};

// Returns the frame that the thin-lens camera records: the radiance along all rays that meet in the
// element's point of the focus plane, averaged over lens and element (thesis 2.3.2). Elements that
// look past the horizon of a tilted focus plane are black. The lens of a pinhole is one point.
// Linear radiance; shape [height][width][3], or [4] with kTransparent. The bits do not depend on
// the number of threads.
Image<float> ThinLensPhotograph(const Scene& scene, const RenderCamera& camera,
                                const LensSampling& sampling, ThreadPool& pool,
                                Surroundings surroundings = Surroundings::kShown);

// Returns the depths, along the optical axis, of the surfaces that a camera sees through the
// middles of its elements, glass and mirrors included; infinity where there is no surface. Glows
// are no surfaces. Shape [height][width].
//   camera  without distortion
Image<float> DepthsSeen(const Scene& scene, const PinholeCamera& camera, ThreadPool& pool);

}  // namespace lf

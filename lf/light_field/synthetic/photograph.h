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

// The background of pictures where there is no surface.
enum class Surroundings : uint8_t {
  kShown,        // room and lamps; pictures are R, G, B
  kTransparent,  // nothing, not even lamps; a ray that hits a surface, of glass or not, is opaque.
                 // Pictures are R, G, B, A: the light of surfaces, premultiplied by A, the share of
                 // rays that hit a surface
};

// Returns the picture that the camera records: linear radiance, the mean over each pixel's square;
// black where its lens lets no ray through.
//   samples  rays per pixel at edges of the picture (a neighbour shows another surface or another
//            brightness), spread over the square; other pixels take one ray through their centre
// Shape [height][width][3], or [4] with kTransparent.
Image<float> Photograph(const Scene& scene, const PinholeCamera& camera, int samples,
                        Surroundings surroundings = Surroundings::kShown);

struct LensSampling {
  // Rays per element, each through its own point of lens and element; rounded up to a square
  // number. Each ray averages lamps and textures over its part of lens and element.
  int samples = 529;
  uint64_t seed = 0;  // for the lens points
};

// Returns the frame that the thin-lens camera records: the mean over lens and element of the
// radiance along the rays that meet in the element's point of the focus plane (thesis 2.3.2).
// Elements that look past the horizon of a tilted focus plane stay black. A pinhole is a lens of
// one point. Linear; shape [height][width][3], or [4] with kTransparent. The bits do not depend on
// the number of threads.
Image<float> ThinLensPhotograph(const Scene& scene, const RenderCamera& camera,
                                const LensSampling& sampling, ThreadPool& pool,
                                Surroundings surroundings = Surroundings::kShown);

}  // namespace lf

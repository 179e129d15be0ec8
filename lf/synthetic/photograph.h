// Pictures of a scene: through a pinhole (an LF image) and through a thin lens (the truth that a
// render of the light field is measured against).
#pragma once

#include <cstdint>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/synthetic/scene.h"

namespace lf {

// The background that pictures show where no surface is.
enum class Surroundings : uint8_t {
  kShown,        // room and lamps. Pictures are R, G, B
  kTransparent,  // nothing, not even lamps; a ray that meets a surface is opaque, glass included.
                 // Pictures are R, G, B, A: the light of surfaces, and the share of rays that met
                 // one, with which it is multiplied
};

// What the camera records: linear radiance, the mean over each pixel's square; black where its lens
// lets no ray through.
//   samples  rays per pixel where the picture has edges (a neighbour shows another surface or
//            another brightness), spread over the square; elsewhere one ray through its centre
// Returns [height][width][3], or [4] with kTransparent.
Image<float> Photograph(const Scene& scene, const PinholeCamera& camera, int samples,
                        Surroundings surroundings = Surroundings::kShown);

struct LensSampling {
  // Rays per element, each through its own point of lens and element; rounded up to a square
  // number. Lamps and textures are averaged over each ray's part of lens and element.
  int samples = 529;
  uint64_t seed = 0;  // of the lens points
};

// The frame that the thin-lens camera films: the mean over lens and element of the radiance along
// the rays that meet in the element's point of the focus plane (thesis 2.3.2). Elements that look
// past the horizon of a tilted focus plane stay black. A pinhole is a lens of one point.
// Returns [height][width][3], or [4] with kTransparent, linear; the same bits for any thread count.
Image<float> ThinLensPhotograph(const Scene& scene, const RenderCamera& camera,
                                const LensSampling& sampling, ThreadPool& pool,
                                Surroundings surroundings = Surroundings::kShown);

}  // namespace lf

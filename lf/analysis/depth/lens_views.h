// SPDX-License-Identifier: Apache-2.0
// The LF images behind a lens, prepared for sampling at any position: without distortion, about as
// fine as the elements of the frame, and cropped to what a part of the plate may see. Internal to
// this folder.
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/collect.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Light is stored as 65535 sqrt(v / 65535) of the 16-bit radiance v, because noise of the square
// root is about equal in shadows and highlights.
uint16_t RootOfLight(uint16_t v);
uint16_t LightOfRoot(uint16_t root);

// An LF camera that the lens sees, before its image is loaded.
struct LensCamera {
  LfImageId id;
  // Intersection of its ray through the middle of the scene with the lens plane, lens coordinates.
  Vec2 lens_point = Vec2::Zero();
  bool is_swept = true;  // false: it is beside the lens, and only serves the sharp picture
};

// One LF image in memory.
struct LensView {
  LensCamera of;
  PinholeCamera camera;   // without distortion
  PixelRect rect;         // part of the image of `camera` that `light` has
  Image<uint16_t> light;  // [height][width][4]: roots of R, G, B, and 1; all 0 where masked
  bool any_masked = false;
  // Index 0 to 3 of its quarter of the lens: 1 is added on the right, 2 in the upper half.
  int Quarter() const {
    return (of.lens_point.x() >= 0 ? 1 : 0) + (of.lens_point.y() >= 0 ? 2 : 0);
  }
};

// Loads the views of one plate, part by part.
class LensViews {
 public:
  // All references must outlive the object.
  //   frame    its plate is cut into parts; its focus distance is not used
  //   cameras  the LF cameras to load
  //   depths   distances along the optical axis between which the views are sampled
  //   margin   number of elements around a part that are sampled, too
  //   strict   true: a broken LF image is an error; false: it is left out (skipped())
  LensViews(const LightField& light_field, const LfImageStore& store, const RenderCamera& frame,
            std::vector<LensCamera> cameras, const DepthRange& depths, int margin, bool strict);

  // Returns the parts of the plate, bands of whole rows from above, of at least 16 rows each, whose
  // views take at most memory_bytes. kOutput: the views of 16 rows take more.
  Result<std::vector<PixelRect>> CutPlate(size_t memory_bytes) const;

  // Loads the views that the elements of `part` see; views() returns them. Does nothing if they are
  // loaded already. kInput, kOutput: as LfImageStore::Load(). kInterrupted: *stop
  // became true.
  Result<void> Load(const PixelRect& part, ThreadPool& pool, const std::atomic<bool>* stop);
  std::span<const LensView> views() const { return views_; }

  // Broken LF images, by ascending ids.
  const std::vector<SkippedImage>& skipped() const { return skipped_; }

 private:
  struct Source {
    LensCamera of;
    PinholeCamera camera;  // of the reduced image without distortion
    bool is_broken = false;
  };
  PixelRect SeenFrom(const PinholeCamera& camera, const PixelRect& part) const;
  Result<void> LoadView(const Source& source, const PixelRect& rect, LensView* view) const;

  const LightField& light_field_;
  const LfImageStore& store_;
  const RenderCamera& frame_;
  const DepthRange depths_;
  const int margin_;
  const bool strict_;
  int divisor_ = 1;
  std::vector<Source> sources_;
  PixelRect loaded_part_;
  std::vector<LensView> views_;
  std::vector<SkippedImage> skipped_;
};

// The positions of the elements of a plate in a view, if all of them lie at one distance along the
// optical axis of the frame. At(x, y) is linear in the element position; the position in the image
// of view.camera is At.x / At.z, At.y / At.z, whatever part of it is loaded.
struct PlanePositions {
  PlanePositions(const LensView& view, const RenderCamera& frame, double distance_w);
  Vec3 At(double x, double y) const { return by_x * x + by_y * y + start; }
  Vec3 by_x, by_y, start;
};

// Returns the point that element position (x, y) sees at a distance along the optical axis.
Vec3 PointAt(const RenderCamera& frame, double x, double y, double distance_w);

}  // namespace lf

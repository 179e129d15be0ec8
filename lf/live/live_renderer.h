// SPDX-License-Identifier: Apache-2.0
// Pictures through the lens at the speed of the hand: frames of a light field that is kept shrunken
// in memory (resident_images.h).
//
//   LiveRenderer live(index, store, {.memory_bytes = size_t{512} << 20}, pool);
//   LF_ASSIGN_OR_RETURN(const LivePicture picture, live.Render(frame, {.budget_s = 0.04}));
//
// A picture has the same bits as a frame that FilmRenderer renders of the shrunken LF images which
// it takes (ShrunkField()), with the estimator bilinear, the filter bilinear and the same lens
// weights.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/develop/develop.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/live/picture_lens.h"
#include "lf/live/resident_images.h"
#include "lf/selection/image_index.h"
#include "lf/selection/lens_weights/frame_weights.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

struct LiveOptions {
  size_t memory_bytes = size_t{512} << 20;  // for shrunken LF images (ResidentImages)
  LensWeights lens_weights = LensWeights::kAuto;
};

struct LiveWish {
  // Time for the picture. As many LF images are taken as were collected in this time before, at
  // least kFewestImages. Unset: all that are in memory.
  std::optional<double> budget_s;
  bool recorded_only = false;  // true: virtual LF images are left out
  // Once it is true, Render() returns kInterrupted soon. Null: nothing interrupts.
  const std::atomic<bool>* interrupted = nullptr;
};

struct LivePicture {
  SensorPlate plate{0, 0};
  DevelopedFrame picture;
  std::vector<LfImageId> images;  // LF images that were taken, ascending; some may have no weight
  // LF images in memory that the frame could take: images.size() is smaller if time is short
  size_t takeable_count = 0;
  // UsedCount(): those of `images` that a frame would use. In memory are also LF images beside the
  // lens, and those of lenses before it.
  size_t used_count = 0;
  // Share of the opening of the lens that no LF image covers (LensCoverage::uncovered_share), and
  // the distance between the LF images of the picture in the lens plane, in world units. Of all
  // that it takes; 1 and 0 without LF images.
  double uncovered_share = 1;
  double camera_distance_w = 0;
  double render_s = 0;  // time that it took
};

class LiveRenderer {
 public:
  static constexpr size_t kFewestImages = 16;

  //   index, store, pool  must outlive this object; index and store as for ResidentImages. Loading
  //                       has threads of its own, as many as the pool
  //   changed             called by any thread when LF images have been loaded; may be empty
  LiveRenderer(const ImageIndex& index, const LfImageStore& store, const LiveOptions& options,
               ThreadPool& pool, std::function<void()> changed = {});

  // Renders a frame of the LF images that are in memory, and loads those that it lacks from now on.
  // The picture is black as long as there are none. Several threads may call it; they wait for each
  // other, but not for LF images that are being loaded.
  Result<LivePicture> Render(const RenderCamera& frame, const LiveWish& wish);

  // The facts from which a renderer elsewhere, such as the page in a browser, makes a picture.
  struct LensPlan {
    LightField field;            // the shrunken LF images that are taken
    std::vector<LfImageId> ids;  // their ids in the whole light field
    PictureLens lens;
    size_t takeable_count = 0;  // as in LivePicture
  };
  // Returns the plan of the picture of Render(), with at most `most` LF images. It lacks only their
  // pixels. Loads missing LF images like Render(). Several threads may
  // call it at the same time.
  //   recorded_only  as in LiveWish
  LensPlan PlanLens(const RenderCamera& frame, size_t most, bool recorded_only);

  ResidentImages& images() { return images_; }
  const ResidentImages& images() const { return images_; }

 private:
  LivePicture RenderOf(const RenderCamera& frame, const LiveWish& wish,
                       std::shared_ptr<const ResidentImages::Snapshot> snapshot);
  size_t CountFor(const RenderCamera& frame, const LiveWish& wish) const;

  const LiveOptions options_;
  ThreadPool& pool_;
  std::mutex mutex_;  // held while a picture is rendered
  // Mean times of earlier pictures: of one element of one LF image, and of the rest of a picture.
  double ray_s_ = 2e-9;
  double rest_s_ = 0.01;
  ResidentImages images_;
};

}  // namespace lf

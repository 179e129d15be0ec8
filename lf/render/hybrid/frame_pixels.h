// SPDX-License-Identifier: Apache-2.0
// The kept pixels of the frames of one pass (rebinning/kept_pixels.h): receives the LF images of
// the pass once, keeps the pixels that the frames ask for, and is the store that the frames are
// collected from afterwards (thesis 4.3.2, 4.3.3).
//
// All pixels that frames ask for are kept if there is room, otherwise only those at edges in the LF
// images (Eq. 4.4). Whether all are kept follows from the calibrations and the number of pixels
// that may be kept, before an LF image is read. Which pixels are kept never depends on time or
// threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/radiance.h"
#include "lf/rebinning/kept_pixels.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/collect/image_consumer.h"
#include "lf/render/collect/memory_plan.h"
#include "lf/render/hybrid/gap_lens.h"
#include "lf/render/hybrid/kept_store.h"
#include "lf/render/settings/rebin_settings.h"
#include "lf/selection/select.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// A frame that asks for kept pixels. All lenses must outlive the object that uses it.
struct KeptFrame {
  RankRange ranks = {};  // the frame takes only the LF images at these ranks
  // The lenses whose rays the frame takes from kept pixels: of its instants and, if its plate is
  // guarded, the lens of all LF images. Empty: the frame collects its rays, and only completes
  // them.
  std::vector<const FrameLens*> lenses = {};
  std::vector<const GapLens*> gaps = {};  // that complete the frame
};

// Returns the rectangles of an LF image whose pixels the frame asks for, one for each lens or gap
// that takes it.
//   overlap, rank  the ImageOverlap of this LF image, and its rank in the order
std::vector<PixelRect> AskedRects(const KeptFrame& frame, LfImageId id, const ImageOverlap& overlap,
                                  uint32_t rank);

class FramePixels : public ImageConsumer {
 public:
  // The light field of `index`, the lenses of the frames, and `pool` must outlive the object.
  //   frames   the frames of the pass
  //   images   the LF images that the frames ask for, by ascending ranks
  //   options  max_cells is the largest number of kept pixels
  FramePixels(const ImageIndex& index, std::vector<KeptFrame> frames,
              std::vector<SelectedImage> images, const SelectOptions& select,
              const RebinSettings& options, ThreadPool& pool);

  uint32_t ranks_done() const override { return ranks_done_; }
  PixelRect RectOf(LfImageId id, uint32_t rank) const override;
  void Take(std::span<const BatchImage> images, uint32_t rank_end) override;

  // The LF images that the frames ask for, by ascending ranks; `rect` is empty.
  const std::vector<SelectedImage>& images() const { return images_; }
  // A store that loads kept pixels. It loads only LF images of kept().images().
  const LfImageStore& store() const { return store_; }

  const KeptPixels& kept() const { return *kept_; }
  size_t max_pixels() const { return kept_->max_pixels(); }
  // Replaces the kept pixels by those that an earlier run saved.
  //   kept  has the pixels of all LF images at ranks before ranks_done
  void Restore(KeptPixels kept, uint32_t ranks_done);

  // The memory of kept pixels is at most BytesOf(max_pixels, BytesPerPixel()) + FixedBytes(), in
  // addition to a MemoryPlan for the same render. KeptPixels counts masks and depths as pixels.
  // Each pixel takes its place and its values, and a sixteenth more, because as many pixels are
  // copied together when pixels are dropped (KeptPixels::kFewTogether).
  static size_t BytesOf(size_t max_pixels, size_t bytes_per_pixel) {
    return max_pixels * bytes_per_pixel / 16 * 17;
  }
  static size_t BytesPerPixel(const RadianceEncoding& encoding, Estimator estimator,
                              bool is_guarded);
  //   element_count  number of elements of a plate
  //   collects       true if the frames also collect rays (RenderMode::kHybrid)
  //   plan           the plan of this render, for any memory
  static size_t FixedBytes(const LightField& light_field, size_t bytes_per_pixel, int thread_count,
                           size_t element_count, bool collects, const MemoryPlan& plan);
  // Returns the memory of what completes a frame (film/develop/develop.h): three colours, their
  // share, and an opacity, as floats.
  static size_t CompletionBytes(size_t element_count) { return element_count * 5 * sizeof(float); }

  struct Facts {
    size_t pixel_count = 0;
    uint64_t looked_at = 0;  // number of LF pixels that frames ask for, of the LF images so far
    double asked = 0;        // estimated number of LF pixels that frames ask for, of all LF images
    double cpu_s = 0;        // CPU time to choose and keep pixels, sum of all threads
    bool keeps_all = false;  // true: all pixels that frames ask for are kept; false: at edges only
    bool is_full = false;    // true: pixels were dropped because there were too many
    // Share of the pixels that frames ask for, of the LF images so far, that are kept. 1 if all
    // unmasked ones are.
    double kept_share = 1;
  };
  Facts facts() const;
  // Returns a line of text for the log.
  std::string Describe() const;

 private:
  std::vector<PixelRect> RectsOf(LfImageId id, uint32_t rank) const;
  double CountAsked(std::span<const SelectedImage> images) const;
  void AddImages(std::span<const BatchImage> images);

  const LightField& light_field_;
  const std::vector<KeptFrame> frames_;
  const std::vector<SelectedImage> images_;
  const SelectOptions select_;
  const RebinSettings options_;
  ThreadPool& pool_;
  const std::vector<uint16_t> stored_values_;
  std::unique_ptr<KeptPixels> kept_;
  KeptStore store_;
  double asked_ = 0;
  bool keeps_all_ = false;
  RebinOptions rebin_;  // options_.rebin, with the probability that fills the room
  uint32_t ranks_done_ = 0;
  uint64_t looked_at_ = 0;
  double looked_at_earlier_ = 0;  // estimated number of LF pixels that an earlier run looked at
  std::atomic<int64_t> cpu_ns_ = 0;
};

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Runs our kernels on one thread, as the renderer calls them (lf/render/collect/collect_batch.cc).
#include <hwy/targets.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "bench/contender.h"

#include "lf/camera/ray_weight.h"
#include "lf/collection/gather.h"
#include "lf/collection/scatter.h"
#include "lf/core/random.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/film/plate/tile_sums.h"

namespace lf::bench {
namespace {

Picture PictureOf(const SensorPlate& plate) {
  Picture picture;
  picture.width = plate.width();
  picture.height = plate.height();
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x)
      for (int channel = 0; channel < 3; ++channel) {
        const ElementSum element = plate.At(x, y, channel);
        picture.sums.push_back(static_cast<float>(element.sum));
        picture.counts.push_back(static_cast<float>(element.count));
      }
  return picture;
}

// Returns different weights for each block of each LF image, large and small ones equally often.
RayWeights SomeWeights(uint64_t image) {
  const WeightBlocks blocks{static_cast<int>(image % kWeightBlock), 0};
  return RayWeights(blocks, [image](int end_x, int end_y, int count, uint8_t* weights) {
    for (int i = 0; i < count; ++i)
      weights[i] = static_cast<uint8_t>(
          1 + RandomBits(image, static_cast<uint64_t>(end_x) + static_cast<uint64_t>(i),
                         static_cast<uint64_t>(end_y)) %
                  kMaxWeight);
  });
}

class FastKernel final : public OurKernel {
 public:
  FastKernel(const KernelCase& kernel_case, bool is_weighed)
      : case_(kernel_case),
        weights_(static_cast<size_t>(kernel_case.spec.image_count)),
        plate_(kernel_case.spec.plate_width, kernel_case.spec.plate_height),
        grid_(TileSums::GridOf(plate_.width(), plate_.height())),
        tiles_(CutIntoTiles(&plate_, grid_)) {
    for (size_t i = 0; is_weighed && i < weights_.size(); ++i) weights_[i] = SomeWeights(i);
    if (case_.spec.filter == PixelFilter::kPrefiltered || case_.spec.filter == PixelFilter::kMosaic)
      FilterImages();
  }

  void Collect(int image_count) override {
    const auto count = static_cast<size_t>(image_count);
    accepted_count_ = 0;
    if (case_.spec.estimator == Estimator::kBilinear) {
      gather_plans_.resize(std::max(gather_plans_.size(), count));
      for (size_t i = 0; i < count; ++i) {
        GatherPlan& plan = gather_plans_[i];
        plan = PlanGather(case_.cameras[i], case_.frame, std::move(plan), case_.spec.filter);
      }
      CollectTiles(count, [&](size_t i, size_t /*tile*/) {
        return GatherTile(gather_plans_[i], filtered_.empty() ? case_.images[i] : filtered_[i],
                          &sums_, weights_[i]);
      });
      return;
    }
    const IdealPixels* ideal = case_.ideal_pixels ? &*case_.ideal_pixels : nullptr;
    scatter_plans_.resize(std::max(scatter_plans_.size(), count));
    for (size_t i = 0; i < count; ++i) {
      ScatterPlan& plan = scatter_plans_[i];
      plan =
          PlanScatter(case_.cameras[i], case_.frame, case_.rects[i], grid_, ideal, std::move(plan));
    }
    CollectTiles(count, [&](size_t i, size_t tile) {
      return ScatterTile(scatter_plans_[i], tile, case_.images[i], &sums_, weights_[i]);
    });
  }

  Picture Develop() const override { return PictureOf(plate_); }
  uint64_t accepted_count() const override { return accepted_count_; }

 private:
  // Films filter an LF image once for all frames that read it, so this is not part of Collect().
  void FilterImages() {
    filtered_.resize(case_.images.size());
    for (size_t i = 0; i < filtered_.size(); ++i)
      FilterPixels(SamplingOf(case_.cameras[i], case_.frame, case_.spec.filter).prefilter,
                   case_.images[i], &filtered_[i]);
  }

  template <class CollectImage>
  void CollectTiles(size_t image_count, const CollectImage& collect_image) {
    for (size_t tile = 0; tile < tiles_.size(); ++tile) {
      sums_.Begin(&tiles_[tile]);
      for (size_t i = 0; i < image_count; ++i) accepted_count_ += collect_image(i, tile);
      sums_.Flush();
    }
  }

  const KernelCase& case_;
  std::vector<RayWeights> weights_;  // one per LF image
  std::vector<LfPixels> filtered_;   // the LF images, if they are prefiltered
  SensorPlate plate_;
  TileGrid grid_;
  std::vector<PlateTile> tiles_;
  std::vector<ScatterPlan> scatter_plans_;
  std::vector<GatherPlan> gather_plans_;
  TileSums sums_;
  uint64_t accepted_count_ = 0;
};

class Reference final : public Contender {
 public:
  explicit Reference(const KernelCase& kernel_case)
      : case_(kernel_case), plate_(kernel_case.spec.plate_width, kernel_case.spec.plate_height) {}

  void Collect(int image_count) override {
    for (size_t i = 0; i < static_cast<size_t>(image_count); ++i) {
      if (case_.spec.estimator == Estimator::kBilinear)
        GatherReference(case_.cameras[i], case_.images[i], case_.frame, &plate_, 1,
                        case_.spec.filter);
      else
        ScatterReference(case_.cameras[i], case_.images[i], case_.frame, case_.rects[i], &plate_);
    }
  }

  Picture Develop() const override { return PictureOf(plate_); }

 private:
  const KernelCase& case_;
  SensorPlate plate_;
};

}  // namespace

std::unique_ptr<OurKernel> MakeOurKernel(const KernelCase& kernel_case, bool is_weighed) {
  return std::make_unique<FastKernel>(kernel_case, is_weighed);
}

std::unique_ptr<Contender> MakeReference(const KernelCase& kernel_case) {
  return std::make_unique<Reference>(kernel_case);
}

}  // namespace lf::bench

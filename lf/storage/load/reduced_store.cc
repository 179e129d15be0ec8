// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/reduced_store.h"

#include <algorithm>
#include <utility>

#include "lf/core/check.h"
#include "lf/light_field/model/reduction.h"
#include "lf/storage/load/folder_store.h"
#include "lf/storage/load/packed_store.h"

namespace lf {
namespace {

constexpr int kLanes = LfPixels::kRgbLanes;

// Sets a pixel to the mean of the pixels of a square that are not masked.
void SetToMean(const LfPixels& pixels, const PixelRect& square, int x, int y, LfPixels* means) {
  uint64_t sums[kLanes] = {}, opacities[kLanes] = {}, count = 0;
  for (int v = square.y_begin; v < square.y_end; ++v)
    for (int u = square.x_begin; u < square.x_end; ++u) {
      if (pixels.IsMasked(u, v)) continue;
      ++count;
      for (int lane = 0; lane < kLanes; ++lane) {
        sums[lane] += pixels.radiance.at(u, v, lane);
        if (!pixels.opacity.empty()) opacities[lane] += pixels.opacity.at(u, v, lane);
      }
    }
  const auto area = static_cast<uint64_t>(square.width()) * static_cast<uint64_t>(square.height());
  if (2 * count < area) return means->Mask(x, y);
  const auto mean = [count](uint64_t sum) {
    return static_cast<uint16_t>((sum + count / 2) / count);
  };
  for (int lane = 0; lane < kLanes; ++lane) {
    means->radiance.at(x, y, lane) = mean(sums[lane]);
    if (!pixels.opacity.empty()) means->opacity.at(x, y, lane) = mean(opacities[lane]);
  }
}

}  // namespace

LfPixels MeansOfSquares(const LfPixels& pixels, int divisor) {
  LF_CHECK(pixels.bayer == BayerPattern::kNone && !pixels.rect.empty());
  const PixelRect whole = {0, 0, pixels.rect.width(), pixels.rect.height()};
  LfPixels means;
  means.Reset({0, 0, std::max(1, whole.width() / divisor), std::max(1, whole.height() / divisor)},
              BayerPattern::kNone);
  if (!pixels.opacity.empty())
    means.opacity.Resize(means.rect.width(), means.rect.height(), kLanes);
  for (int y = 0; y < means.rect.height(); ++y)
    for (int x = 0; x < means.rect.width(); ++x) {
      const PixelRect square = {x * divisor, y * divisor, (x + 1) * divisor, (y + 1) * divisor};
      SetToMean(pixels, Intersection(square, whole), x, y, &means);
    }
  return means;
}

ReducedStore::ReducedStore(const LightField& light_field)
    : divisor_(light_field.reduction->divisor), recorded_(RecordedLightField(light_field)) {}

Result<std::unique_ptr<LfImageStore>> ReducedStore::Open(const LightField& light_field) {
  LF_CHECK(light_field.reduction.has_value());
  std::unique_ptr<ReducedStore> store(new ReducedStore(light_field));
  const LightField& recorded = store->recorded_;
  if (HoldsPackedStore(recorded)) {
    LF_ASSIGN_OR_RETURN(
        store->recorded_store_,
        PackedStore::Open(recorded, Mosaics::kToRgb, StoreContent::kPixels, store->divisor_));
  } else {
    store->recorded_store_ = std::make_unique<FolderStore>(recorded, Mosaics::kToRgb);
  }
  return std::unique_ptr<LfImageStore>(std::move(store));
}

Result<int> ReducedStore::LoadReduced(LfImageId id, int divisor, const Intrinsics& /*k*/,
                                      LfPixels* pixels) const {
  const Intrinsics& k = recorded_.intrinsics[recorded_.cameras[id.value].intrinsics_index];
  LF_ASSIGN_OR_RETURN(const int reduction,
                      recorded_store_->LoadReduced(id, divisor_ * divisor, k, pixels));
  // Both are powers of two, unless the caller wants another divisor and `reduction` is a multiple.
  if (reduction % divisor_ == 0) return reduction / divisor_;
  if (divisor_ % reduction == 0) {
    *pixels = MeansOfSquares(*pixels, divisor_ / reduction);
    return 1;
  }
  LF_RETURN_IF_ERROR(Load(id, {0, 0, k.width_px, k.height_px}, pixels));
  return 1;
}

Result<void> ReducedStore::Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const {
  LF_CHECK(id.value < recorded_.size());
  if (rect.empty()) return recorded_store_->Load(id, {}, pixels);
  LF_RETURN_IF_ERROR(LoadReduced(id, 1, {}, pixels));
  return {};
}

bool ReducedStore::Keeps(LfImageId id, const PixelRect& rect) const {
  if (rect.empty()) return recorded_store_->Keeps(id, rect);
  const Intrinsics& k = recorded_.intrinsics[recorded_.cameras[id.value].intrinsics_index];
  return recorded_store_->Keeps(id, {0, 0, k.width_px, k.height_px});
}

}  // namespace lf

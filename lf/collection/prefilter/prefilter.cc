// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/prefilter/prefilter.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "lf/collection/prefilter/mosaic_correction.h"
#include "lf/collection/prefilter/prefilter_rows.h"
#include "lf/core/check.h"

namespace lf {
namespace {

constexpr size_t kLanes = LfPixels::kRgbLanes;

}  // namespace

// Writes the knots of pixels to `knots`, row by row. `knots` may be the first value of `pixels`: a
// row of knots is written after all rows of pixels up to it were read.
class RowFilter {
 public:
  //   to  rectangle of the knots
  RowFilter(const Prefilter& filter, const LfPixels& pixels, const PixelRect& to, uint16_t* knots)
      : filter_(filter),
        pixels_(pixels),
        to_(to),
        knots_(knots),
        before_(filter.count - 1),
        after_(filter.is_even ? filter.count : before_),
        ring_(static_cast<size_t>(before_ + kKnotRowsAtOnce + after_)),
        row_values_(static_cast<size_t>(pixels.radiance.width()) * kLanes),
        filtered_(std::move(Spare())),
        rows_(ring_) {
    filtered_.resize((ring_ + 1) * row_values_);
    std::fill(filtered_.end() - static_cast<ptrdiff_t>(row_values_), filtered_.end(), 0);
    if (filter.correction > 0 && pixels.recorded != BayerPattern::kNone)
      corrector_.emplace(filter.correction, pixels);
  }
  ~RowFilter() { Spare() = std::move(filtered_); }
  RowFilter(const RowFilter&) = delete;
  RowFilter& operator=(const RowFilter&) = delete;

  // Writes the knots that need only the first `complete_rows` rows of pixels.
  void Advance(int complete_rows) {
    const int height = pixels_.radiance.height();
    // The correction of a row needs rows behind it.
    if (corrector_ && complete_rows < height) complete_rows -= MosaicCorrection::kReach_px;
    while (y_ < to_.height()) {
      const int row_count = std::min(kKnotRowsAtOnce, to_.height() - y_);
      const int end = y_ + row_count + after_;
      for (; next_ < std::min(complete_rows, end); ++next_)
        FilterAlongRow(filter_, corrector_ ? corrector_->Row(next_) : pixels_.radiance.row(next_),
                       pixels_.radiance.width(), pixels_.any_masked, to_.width(), Row(next_));
      if (complete_rows < std::min(height, end)) return;
      for (int k = y_ - before_; k < end; ++k)
        rows_[static_cast<size_t>(k - y_ + before_)] = Row(k);
      const bool any_missing = pixels_.any_masked || y_ < before_ || end > height;
      FilterAlongColumns(filter_, rows_.data() + before_, any_missing, row_count, to_.width(),
                         knots_ + static_cast<size_t>(y_) * to_.width() * kLanes);
      y_ += row_count;
    }
  }

 private:
  // Memory of this thread that no RowFilter uses now.
  static std::vector<int32_t>& Spare() {
    thread_local std::vector<int32_t> spare;
    return spare;
  }
  // Returns row y of pixels, filtered along the row; zeros if there is no such row.
  int32_t* Row(int y) {
    const bool exists = y >= 0 && y < pixels_.radiance.height();
    return filtered_.data() + (exists ? static_cast<size_t>(y) % ring_ : ring_) * row_values_;
  }

  const Prefilter filter_;
  const LfPixels& pixels_;
  const PixelRect to_;
  uint16_t* const knots_;
  // The pixels from -before_ to +after_ of a row or a column make the value of knot 0.
  const int before_, after_;
  const size_t ring_;  // number of filtered rows that are kept
  const size_t row_values_;
  // A ring of the filtered rows that are still needed, and a row of zeros.
  std::vector<int32_t> filtered_;
  std::vector<const int32_t*> rows_;
  std::optional<MosaicCorrector> corrector_;
  int next_ = 0;  // the next row of pixels to be filtered along the row
  int y_ = 0;     // the next row of knots
};

void FilterPixels(const Prefilter& filter, const LfPixels& pixels, LfPixels* out) {
  LF_CHECK(pixels.bayer == BayerPattern::kNone && out != &pixels);
  out->Reset(KnotsOf(filter, pixels.rect), BayerPattern::kNone);
  out->recorded = pixels.recorded;
  out->any_masked = pixels.any_masked;
  if (out->rect.empty()) return;
  RowFilter(filter, pixels, out->rect, out->radiance.row(0)).Advance(pixels.radiance.height());
}

InPlaceFilter::InPlaceFilter(const Prefilter& filter, LfPixels* pixels)
    : pixels_(*pixels), knots_(KnotsOf(filter, pixels->rect)) {
  LF_CHECK(pixels->bayer == BayerPattern::kNone);
  if (!knots_.empty())
    rows_ = std::make_unique<RowFilter>(filter, *pixels, knots_, pixels->radiance.row(0));
}
InPlaceFilter::~InPlaceFilter() = default;

void InPlaceFilter::Advance(int row_count) {
  if (rows_) rows_->Advance(row_count);
  if (row_count < pixels_.radiance.height()) return;
  pixels_.radiance.Resize(knots_.width(), knots_.height(), LfPixels::kRgbLanes);
  pixels_.rect = knots_;
}

}  // namespace lf

#include "lf/collection/prefilter/prefilter.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "lf/collection/prefilter/prefilter_rows.h"
#include "lf/core/check.h"

namespace lf {

void FilterPixels(const Prefilter& filter, const LfPixels& pixels, LfPixels* out) {
  LF_CHECK(pixels.bayer == BayerPattern::kNone && out != &pixels);
  constexpr int kLanes = LfPixels::kRgbLanes;
  out->Reset(KnotsOf(filter, pixels.rect), BayerPattern::kNone);
  out->recorded = pixels.recorded;
  out->any_masked = pixels.any_masked;
  if (out->rect.empty()) return;
  const int width = pixels.rect.width(), height = pixels.rect.height();
  // The pixels from -before to +after of a row or a column make the value of knot 0.
  const int before = filter.count - 1, after = filter.is_even ? filter.count : before;
  const auto row_values = static_cast<size_t>(width) * kLanes;
  const auto margin = static_cast<size_t>(after) * kLanes;
  thread_local std::vector<uint16_t> padded;
  thread_local std::vector<int32_t> filtered;
  padded.assign(row_values + 2 * margin, 0);
  // A ring of the filtered rows that are still needed, and a row of zeros for missing rows.
  const auto ring = static_cast<size_t>(before + 1 + after);
  filtered.assign((ring + 1) * row_values, 0);
  const auto at = [&](int y) {
    const size_t row = y < 0 || y >= height ? ring : static_cast<size_t>(y) % ring;
    return filtered.data() + row * row_values;
  };
  std::vector<const int32_t*> rows(ring);
  int next = 0;
  for (int y = 0; y < out->rect.height(); ++y) {
    for (; next < std::min(height, y + after + 1); ++next) {
      std::memcpy(padded.data() + margin, pixels.radiance.row(next), row_values * sizeof(uint16_t));
      FilterAlongRow(filter, padded.data() + margin, pixels.any_masked, out->rect.width(),
                     at(next));
    }
    for (int k = -before; k <= after; ++k) rows[static_cast<size_t>(k + before)] = at(y + k);
    const bool any_missing = pixels.any_masked || y < before || y + after >= height;
    FilterAlongColumns(filter, rows.data() + before, any_missing, out->rect.width(),
                       out->radiance.row(y));
  }
}

}  // namespace lf

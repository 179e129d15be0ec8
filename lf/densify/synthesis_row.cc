// SPDX-License-Identifier: Apache-2.0
// Highway compiles these loops for several instruction sets, and the program chooses one of these
// versions at run time. All compute the same bits.
#include "lf/densify/synthesis_row.h"

#include <cstring>

#include "lf/core/catmull_rom.h"
#include "lf/densify/bicubic.h"
#include "lf/densify/pixel_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/densify/synthesis_row.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {

HWY_ATTR void ProjectRow(const PairMap& map, const uint16_t* HWY_RESTRICT numbers, int x_begin,
                         int y, int count, float first, float step, float* HWY_RESTRICT u_px,
                         float* HWY_RESTRICT v_px, float* HWY_RESTRICT depths) {
  constexpr float kBehind = -1e6f;
  const PairMap m = map;
  const float row = static_cast<float>(y) + 0.5f, begin = static_cast<float>(x_begin) + 0.5f;
  for (int i = 0; i < count; ++i) {
    const float z = first + static_cast<float>(numbers[i]) * step;
    const PairMap::Place place = m.At(begin + static_cast<float>(i), row, z);
    const bool is_before = place.w > 0;
    u_px[i] = is_before ? place.u_px - 0.5f : kBehind;
    v_px[i] = is_before ? place.v_px - 0.5f : kBehind;
    depths[i] = z / place.w;
  }
}

HWY_ATTR void SeeRow(const PairMap& map, int x_begin, int y, int count,
                     const float* HWY_RESTRICT depths, int width, int height, SeenPoints* seen) {
  const PairMap m = map;
  const float row = static_cast<float>(y) + 0.5f, begin = static_cast<float>(x_begin) + 0.5f;
  const auto right = static_cast<float>(width), bottom = static_cast<float>(height);
  for (int i = 0; i < count; ++i) {
    const float z = depths[i];
    const PairMap::Place place = m.At(begin + static_cast<float>(i), row, z);
    const bool is_inside = (place.w > 0) & (place.u_px >= 0) & (place.v_px >= 0) &
                           (place.u_px < right) & (place.v_px < bottom);
    const float u = is_inside ? place.u_px : 0, v = is_inside ? place.v_px : 0;
    seen->u_px[i] = u;
    seen->v_px[i] = v;
    seen->depth[i] = z / place.w;
    seen->pixel[i] =
        is_inside ? static_cast<int32_t>(v) * width + static_cast<int32_t>(u) : kOutside;
  }
}

HWY_ATTR void AddVotes(const SeenPoints& seen, const float* HWY_RESTRICT there, int count,
                       float per_tolerance, float weight, float* HWY_RESTRICT errors,
                       float* HWY_RESTRICT votes) {
  // A vote against a depth counts less, because planes are wrong near outlines.
  constexpr float kThrough = -1.5f, kAgainst = 0.7f;
  const float against = kAgainst * weight;
  for (int i = 0; i < count; ++i) {
    const float error = (there[i] - seen.depth[i]) * per_tolerance;
    const float agreed = votes[i] + weight * AgreementOf(error);
    const float sum = error < kThrough ? agreed - against : agreed;
    errors[i] = error;
    votes[i] = seen.pixel[i] == kOutside ? votes[i] : sum;
  }
}

// Interpolates between 4 x 4 pixels. Returns false if one of them is masked.
//   across  weights of the columns, each as often as a pixel has lanes
HWY_ATTR HWY_INLINE bool SampleSixteen(const uint16_t* const rows[4],
                                       const float* HWY_RESTRICT across, const float* down,
                                       bool has_masked, float* HWY_RESTRICT colour) {
  constexpr int kLanes = LfPixels::kRgbLanes, kAll = 4 * kLanes;
  const uint16_t *row0 = rows[0], *row1 = rows[1], *row2 = rows[2], *row3 = rows[3];
  const float down0 = down[0], down1 = down[1], down2 = down[2], down3 = down[3];
  float columns[kAll];
  for (int i = 0; i < kAll; ++i)
    columns[i] =
        across[i] * (down0 * static_cast<float>(row0[i]) + down1 * static_cast<float>(row1[i]) +
                     down2 * static_cast<float>(row2[i]) + down3 * static_cast<float>(row3[i]));
  PixelLanes pixels[4];
  std::memcpy(pixels, columns, sizeof(pixels));
  const PixelLanes sum = (pixels[0] + pixels[2]) + (pixels[1] + pixels[3]);
  std::memcpy(colour, &sum, sizeof(sum));
  if (!has_masked) return true;
  bool is_shown = true;
  for (int i = LfPixels::kRayLane; i < kAll; i += kLanes)
    is_shown &= (row0[i] != 0) & (row1[i] != 0) & (row2[i] != 0) & (row3[i] != 0);
  return is_shown;
}

HWY_ATTR void SampleRow(const Image<uint16_t>& light, bool has_masked, const SeenPoints& seen,
                        std::span<const int> pixels, PointColours* colours) {
  constexpr int kLanes = LfPixels::kRgbLanes;
  alignas(64) float across[4][kChunk], down[4][kChunk];
  int32_t columns[kChunk], tops[kChunk];
  for (int i = 0; i < kChunk; ++i) {
    const float x = seen.u_px[i] - 0.5f, y = seen.v_px[i] - 0.5f;
    // Truncation is rounding down, because the sums are not negative.
    columns[i] = static_cast<int32_t>(x + 1) - 1;
    tops[i] = static_cast<int32_t>(y + 1) - 1;
    const auto of_columns = CatmullRomWeights(x - static_cast<float>(columns[i]));
    const auto of_rows = CatmullRomWeights(y - static_cast<float>(tops[i]));
    for (size_t k = 0; k < 4; ++k) {
      across[k][i] = of_columns[k];
      down[k][i] = of_rows[k];
    }
  }
  for (const int i : pixels) {
    colours->is_shown[i] = false;
    if (seen.pixel[i] == kOutside) continue;
    const int column = columns[i], top = tops[i];
    if (column >= 1 && column + 2 < light.width() && top >= 1 && top + 2 < light.height()) {
      const uint16_t* const first = light.row(top - 1) + (column - 1) * kLanes;
      const size_t stride = static_cast<size_t>(light.width()) * kLanes;
      const uint16_t* const rows[4] = {first, first + stride, first + 2 * stride,
                                       first + 3 * stride};
      float weights[4 * kLanes];
      for (int k = 0; k < 4 * kLanes; ++k) weights[k] = across[k / kLanes][i];
      const float of_rows[4] = {down[0][i], down[1][i], down[2][i], down[3][i]};
      colours->is_shown[i] = SampleSixteen(rows, weights, of_rows, has_masked, colours->lanes[i]);
    }
    if (!colours->is_shown[i])
      colours->is_shown[i] = SampleBicubic(light, seen.u_px[i], seen.v_px[i], colours->lanes[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(ProjectRow);
HWY_EXPORT(SeeRow);
HWY_EXPORT(AddVotes);
HWY_EXPORT(SampleRow);

void ProjectRow(const PairMap& map, const uint16_t* numbers, int x_begin, int y, int count,
                float first, float step, float* u_px, float* v_px, float* depths) {
  HWY_DYNAMIC_DISPATCH(ProjectRow)
  (map, numbers, x_begin, y, count, first, step, u_px, v_px, depths);
}

void SeeRow(const PairMap& map, int x_begin, int y, int count, const float* depths, int width,
            int height, SeenPoints* seen) {
  HWY_DYNAMIC_DISPATCH(SeeRow)(map, x_begin, y, count, depths, width, height, seen);
}

void AddVotes(const SeenPoints& seen, const float* there, int count, float per_tolerance,
              float weight, float* errors, float* votes) {
  HWY_DYNAMIC_DISPATCH(AddVotes)(seen, there, count, per_tolerance, weight, errors, votes);
}

void SampleRow(const Image<uint16_t>& light, bool has_masked, const SeenPoints& seen,
               std::span<const int> pixels, PointColours* colours) {
  HWY_DYNAMIC_DISPATCH(SampleRow)(light, has_masked, seen, pixels, colours);
}

}  // namespace lf
#endif  // HWY_ONCE

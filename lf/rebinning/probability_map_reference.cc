// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/probability_steps.h"

namespace lf {
namespace {

class SmoothedGrey {
 public:
  SmoothedGrey(const SmoothingTaps& taps, ImageView<const uint16_t> grey)
      : taps_(taps), grey_(grey) {}

  uint32_t Smooth(int x, int y) const {
    uint32_t sum = 2048;
    for (int k = -taps_.radius(); k <= taps_.radius(); ++k)
      sum += taps_.values[std::abs(k)] * Across(x, y + k);
    return sum >> 12;
  }

  int32_t Laplacian(int x, int y) const {
    const auto at = [&](int i, int k) {
      return static_cast<int32_t>(
          Smooth(std::clamp(i, 0, grey_.width - 1), std::clamp(k, 0, grey_.height - 1)));
    };
    return at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1) - 4 * at(x, y);
  }

 private:
  uint32_t Across(int x, int y) const {
    const uint16_t* const row = grey_.row(std::clamp(y, 0, grey_.height - 1));
    uint32_t sum = 128;
    for (int k = -taps_.radius(); k <= taps_.radius(); ++k)
      sum += taps_.values[std::abs(k)] * row[std::clamp(x + k, 0, grey_.width - 1)];
    return sum >> 8;
  }

  const SmoothingTaps& taps_;
  ImageView<const uint16_t> grey_;
};

}  // namespace

void ProbabilityMapReference(const LfPixels& pixels, const PixelRect& rect,
                             const std::vector<uint16_t>& stored_values,
                             const ProbabilityOptions& options, Image<uint16_t>* p) {
  p->Resize(0, 0, 1);
  if (rect.empty()) return;
  const ProbabilityParameters parameters =
      MakeParameters(options, pixels.bayer != BayerPattern::kNone);
  const GreyRows rows(pixels, pixels.rect, stored_values);
  Image<uint16_t> grey(rows.width(), rows.height());
  for (int y = 0; y < grey.height(); ++y) rows.Read(y, grey.row(y));
  const SmoothedGrey plane(parameters.taps, grey.view());
  Image<uint16_t> of_plane(grey.width(), grey.height());
  for (int y = 0; y < grey.height(); ++y)
    for (int x = 0; x < grey.width(); ++x)
      of_plane.at(x, y) = ProbabilityOf(parameters, plane.Laplacian(x, y));
  if (parameters.second_taps.radius() > 0) {
    const Image<uint16_t> once = of_plane;
    const SmoothedGrey again(parameters.second_taps, once.view());
    for (int y = 0; y < grey.height(); ++y)
      for (int x = 0; x < grey.width(); ++x)
        of_plane.at(x, y) = static_cast<uint16_t>((again.Smooth(x, y) + 8) >> 4);
  }
  SpreadOverPixels(pixels, rect, rows.plane(), of_plane, p);
}

}  // namespace lf

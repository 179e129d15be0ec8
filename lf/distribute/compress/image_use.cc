// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/image_use.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "lf/core/hash.h"
#include "lf/render/needs/image_shares.h"
#include "lf/render/settings/render_mode.h"
#include "lf/render/state/run_inputs.h"
#include "lf/selection/image_index.h"

namespace lf {
namespace {

Result<LensWeights> WeightsOf(std::span<const Package> packages) {
  const bool has_neighbours = packages.front().choices.has_neighbours;
  for (const Package& package : packages) {
    if (package.choices.mode != RenderMode::kCollect)
      return UsageError(fmt::format(
          "{{quality_by_use}}: package {} is made for {{mode {}}}, in which LF images have no "
          "weights: leave {{quality_by_use}} out, or make the packages for {{mode collect}}",
          package.name, NameOf(package.choices.mode)));
    if (package.choices.has_neighbours != has_neighbours)
      return UsageError(fmt::format(
          "{{quality_by_use}}: packages {} and {} are made with and without {{lens_weights none}}: "
          "give packages that are made in the same way",
          packages.front().name, package.name));
  }
  return has_neighbours ? LensWeights::kAuto : LensWeights::kNone;
}

}  // namespace

Result<ImageUse> UseBy(std::span<const Package> packages, ThreadPool& pool,
                       const std::atomic<bool>* interrupted) {
  LF_ASSIGN_OR_RETURN(const LensWeights kind, WeightsOf(packages));
  ImageUse use;
  use.films.lens_weights = NameOf(kind);
  for (const Package& package : packages) {
    if (const std::string lenses = HashOfLenses(package.path);
        std::find(use.films.lenses.begin(), use.films.lenses.end(), lenses) ==
        use.films.lenses.end())
      use.films.lenses.push_back(lenses);
    const ImageIndex index(package.light_field, package.ranks);
    for (const FrameId frame : package.FrameIds()) {
      if (interrupted != nullptr && *interrupted)
        return Error{ErrorKind::kInterrupted, "interrupted before the first LF image was encoded"};
      use.frames.push_back({frame, {}});
      for (const ImageShare& image : SharesOf(index, package, frame, kind, pool)) {
        const PackageImage& of_package = package.images[image.id.value];
        if (of_package.ray_count == 0) continue;  // the store leaves it out
        use.frames.back().shares.push_back(
            {of_package.id, static_cast<float>(image.share), static_cast<float>(image.squared)});
      }
    }
  }
  use.films.frame_count = use.frames.size();
  return use;
}

ThresholdFactors::ThresholdFactors(const ImageUse& use, std::span<const PixelRect> rects)
    : steps_(rects.size(), 0) {
  std::vector<double> weights(rects.size());
  for (const ImageUse::Frame& frame : use.frames)
    for (const ImageUse::Share& image : frame.shares) weights[image.id] += image.squared;
  double weight_sum = 0, pixel_sum = 0;
  for (size_t i = 0; i < rects.size(); ++i) {
    if (rects[i].empty()) continue;
    weight_sum += weights[i];
    pixel_sum += static_cast<double>(rects[i].pixel_count());
  }
  for (size_t i = 0; i < rects.size(); ++i) {
    if (rects[i].empty()) continue;
    const double of_mean =
        weights[i] / static_cast<double>(rects[i].pixel_count()) * (pixel_sum / weight_sum);
    const double step = of_mean > 0 ? -0.5 * kStepsOfTwo * std::log2(of_mean) : kStepsOfTwo;
    steps_[i] =
        static_cast<int8_t>(std::lround(std::clamp<double>(step, -kStepsOfTwo, kStepsOfTwo)));
  }
}

double ThresholdFactors::Of(uint32_t id) const {
  return steps_.empty() ? 1 : std::exp2(static_cast<double>(steps_[id]) / kStepsOfTwo);
}

std::string ThresholdFactors::Words() const {
  if (steps_.empty()) return "";
  const std::string_view bytes(reinterpret_cast<const char*>(steps_.data()), steps_.size());
  return fmt::format(" by use {:016x}", HashBytes(bytes));
}

FrameErrors PredictFrames(const ImageUse& use, std::span<const double> errors) {
  FrameErrors predicted;
  for (const ImageUse::Frame& frame : use.frames) {
    double own = 0, common = 0;
    for (const ImageUse::Share& image : frame.shares) {
      own += image.squared * errors[image.id];
      common += image.share * std::sqrt(errors[image.id]);
    }
    const double error = (1 - kCommonShare) * own + kCommonShare * common * common;
    predicted.mean += error / static_cast<double>(use.frames.size());
    if (error >= predicted.worst) {
      predicted.worst = error;
      predicted.worst_frame = frame.id;
    }
  }
  return predicted;
}

}  // namespace lf

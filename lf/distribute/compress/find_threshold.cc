// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/find_threshold.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lf/distribute/compress/image_coder.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {
namespace {

constexpr size_t kLookedAt = 12;  // largest number of LF images in the sample

// Thresholds that are tried, in grey steps: from 0.05 on, each 5 % above the previous one.
constexpr int kSteps = 160;
double ThresholdOf(int step) { return std::round(0.05 * std::pow(1.05, step) * 1e4) / 1e4; }

// Predicts the error of frames at any threshold, from errors at a few thresholds.
class FrameSample {
 public:
  //   error_at  returns the mean squared error of the sample of LF images at a threshold
  FrameSample(const ImageUse& use, std::span<const PixelRect> rects,
              std::function<double(double)> error_at)
      : use_(use),
        factors_(use, rects),
        image_count_(rects.size()),
        error_at_(std::move(error_at)) {}

  double ErrorAt(double threshold) {
    std::vector<double> errors(image_count_);
    for (uint32_t i = 0; i < errors.size(); ++i)
      errors[i] = Interpolated(threshold * factors_.Of(i));
    return PredictFrames(use_, errors).mean;
  }

 private:
  // Interpolates the logarithm of the error linearly in the logarithm of the threshold.
  double Interpolated(double threshold) {
    const double at = 2 * std::log2(threshold);
    const int below = static_cast<int>(std::floor(at));
    const double low = AtNode(below), high = AtNode(below + 1);
    if (!(low > 0 && high > 0)) return std::max(low, high);
    return low * std::pow(high / low, at - below);
  }

  // Returns the error at the threshold 2^(node / 2).
  double AtNode(int node) {
    const auto known = known_.find(node);
    if (known != known_.end()) return known->second;
    return known_[node] = error_at_(std::exp2(0.5 * node));
  }

  const ImageUse& use_;
  const ThresholdFactors factors_;
  const size_t image_count_;
  const std::function<double(double)> error_at_;
  std::map<int, double> known_;  // AtNode() of a node
};

}  // namespace

Result<double> FindThreshold(const CompressSource& source, const CodecSettings& settings,
                             double psnr_db, const ImageUse* use, ThreadPool& pool,
                             const std::function<bool()>& is_interrupted) {
  const Error interrupted = {ErrorKind::kInterrupted,
                             "interrupted during the search for the threshold of {target_psnr}"};
  if (settings.profile == CodecProfile::kLossless)
    return UsageError(
        "{target_psnr} cannot be used with {profile lossless}, which has no loss: leave one of "
        "them out");
  const LightField& light_field = source.light_field;
  const std::vector<LfImageId> ids = source.CompressedIds();
  std::vector<Result<RecordedImage>> images(std::min(kLookedAt, ids.size()),
                                            Error{ErrorKind::kInput, ""});
  pool.ForEach(images.size(), [&](size_t i) {
    if (is_interrupted()) return;
    const LfImageId id = ids[i * ids.size() / images.size()];
    const PixelRect rect = RectToRecord(light_field, id, source.rects[id.value]);
    images[i] = ReadRecordedImage(light_field, id, rect);
  });
  const auto error_at = [&](double threshold) {
    CodecSettings of_threshold = settings;
    of_threshold.threshold = threshold;
    const ImageCoder coder(light_field.encoding, of_threshold, KeepFiles::kNone, is_interrupted);
    std::vector<CodeError> errors(images.size());
    pool.ForEach(images.size(), [&](size_t i) {
      if (!images[i]) return;
      const Result<CodedImage> coded = coder.Code(*images[i]);
      if (!coded) return;
      if (const Result<CodeError> error = coder.ErrorOf(*images[i], *coded)) errors[i] = *error;
    });
    CodeError together;
    for (const CodeError& error : errors) together += error;
    return together;
  };
  std::optional<FrameSample> frames;
  if (use != nullptr)
    frames.emplace(*use, source.rects,
                   [&](double threshold) { return error_at(threshold).Mean(); });
  const auto psnr_at = [&](double threshold) {
    if (!frames) return error_at(threshold).PsnrDb();
    return CodeError{frames->ErrorAt(threshold), 1}.PsnrDb();
  };
  if (is_interrupted()) return interrupted;
  if (std::none_of(images.begin(), images.end(), [](const auto& image) { return bool(image); }))
    return InputError(fmt::format(
        "{{target_psnr}}: none of the {} LF images that were tried can be read; the first: {}",
        images.size(), images.front().error().message));
  const double best = psnr_at(ThresholdOf(0));
  if (is_interrupted()) return interrupted;
  if (best < psnr_db)
    return UsageError(fmt::format(
        "{{target_psnr {}}}: cannot be reached, because these options give at most {:.1f} "
        "dB: give a lower PSNR, or {{profile lossless}} instead",
        psnr_db, best));
  int good = 0, bad = kSteps;
  while (bad - good > 1) {
    const int middle = (good + bad) / 2;
    (psnr_at(ThresholdOf(middle)) >= psnr_db ? good : bad) = middle;
    if (is_interrupted()) return interrupted;
  }
  return ThresholdOf(good);
}

}  // namespace lf

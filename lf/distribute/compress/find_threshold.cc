// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/find_threshold.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "lf/distribute/compress/image_coder.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {
namespace {

constexpr size_t kLookedAt = 12;  // largest number of LF images in the sample

// Thresholds that are tried, in grey steps: from 0.05 on, each 5 % above the previous one.
constexpr int kSteps = 160;
double ThresholdOf(int step) { return std::round(0.05 * std::pow(1.05, step) * 1e4) / 1e4; }

}  // namespace

Result<double> FindThreshold(const CompressSource& source, const CodecSettings& settings,
                             double psnr_db, ThreadPool& pool,
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
  const auto psnr_at = [&](double threshold) {
    CodecSettings of_threshold = settings;
    of_threshold.threshold = threshold;
    const ImageCoder coder(light_field.encoding, of_threshold);
    std::vector<CodeError> errors(images.size());
    pool.ForEach(images.size(), [&](size_t i) {
      if (images[i] && !is_interrupted())
        errors[i] = coder.ErrorOf(*images[i], coder.Code(*images[i]));
    });
    CodeError together;
    for (const CodeError& error : errors) together += error;
    return together.PsnrDb();
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

// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/find_threshold.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lf/distribute/compress/group_coder.h"
#include "lf/distribute/compress/image_coder.h"
#include "lf/distribute/compress/image_groups.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {
namespace {

constexpr size_t kLookedAt = 12;  // largest number of LF images in the sample

// Thresholds that are tried, in grey steps: from 0.05 on, each 5 % above the previous one.
constexpr int kSteps = 160;
double ThresholdOf(int step) { return std::round(0.05 * std::pow(1.05, step) * 1e4) / 1e4; }

Error Interruption() {
  return {ErrorKind::kInterrupted,
          "interrupted during the search for the threshold of {target_psnr}"};
}

Error NoneCanBeRead(size_t count, const Error& first) {
  return InputError(fmt::format(
      "{{target_psnr}}: none of the {} LF images that were tried can be read; the first: {}", count,
      first.message));
}

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

// A sample of LF images that can be encoded at any threshold.
class Sample {
 public:
  virtual ~Sample() = default;
  // Returns the error of all LF images of the sample that can be read.
  virtual CodeError ErrorAt(double threshold, ThreadPool& pool) const = 0;
};

// LF images that are encoded by themselves.
class SingleImages : public Sample {
 public:
  static Result<std::unique_ptr<Sample>> Read(const CompressSource& source,
                                              const CodecSettings& settings, ThreadPool& pool,
                                              const std::function<bool()>& is_interrupted) {
    const std::vector<LfImageId> ids = source.CompressedIds();
    auto sample = std::make_unique<SingleImages>(source, settings, is_interrupted);
    sample->images_.assign(std::min(kLookedAt, ids.size()), Error{ErrorKind::kInput, ""});
    pool.ForEach(sample->images_.size(), [&](size_t i) {
      if (is_interrupted()) return;
      const LfImageId id = ids[i * ids.size() / sample->images_.size()];
      sample->images_[i] = ReadToCompress(source, id);
    });
    if (is_interrupted()) return Interruption();
    if (std::none_of(sample->images_.begin(), sample->images_.end(),
                     [](const auto& image) { return bool(image); }))
      return NoneCanBeRead(sample->images_.size(), sample->images_.front().error());
    return std::unique_ptr<Sample>(std::move(sample));
  }

  SingleImages(const CompressSource& source, const CodecSettings& settings,
               const std::function<bool()>& is_interrupted)
      : source_(source), settings_(settings), is_interrupted_(is_interrupted) {}

  CodeError ErrorAt(double threshold, ThreadPool& pool) const override {
    CodecSettings of_threshold = settings_;
    of_threshold.threshold = threshold;
    const ImageCoder coder(source_.light_field.encoding, of_threshold, KeepFiles::kNone,
                           is_interrupted_);
    std::vector<CodeError> errors(images_.size());
    pool.ForEach(images_.size(), [&](size_t i) {
      if (!images_[i]) return;
      const Result<CodedImage> coded = coder.Code(*images_[i]);
      if (!coded) return;
      if (const Result<CodeError> error = coder.ErrorOf(*images_[i], *coded)) errors[i] = *error;
    });
    CodeError together;
    for (const CodeError& error : errors) together += error;
    return together;
  }

 private:
  const CompressSource& source_;
  const CodecSettings settings_;
  const std::function<bool()> is_interrupted_;
  std::vector<Result<RecordedImage>> images_;
};

// Groups of LF images that are predicted.
class WholeGroups : public Sample {
 public:
  // kInput: no LF image of the sample can be read.
  static Result<std::unique_ptr<Sample>> Open(const CompressSource& source,
                                              const CodecSettings& settings,
                                              const std::function<bool()>& is_interrupted) {
    auto groups = std::make_unique<WholeGroups>(source, settings, is_interrupted);
    size_t unreadable = 0;
    std::optional<Error> first;
    for (const size_t group : groups->sample_)
      for (const GroupMember& member : groups->groups_.Group(group)) {
        if (is_interrupted()) return Interruption();
        const Result<RecordedImage> image = ReadToCompress(source, member.id);
        if (image) return std::unique_ptr<Sample>(std::move(groups));
        ++unreadable;
        if (!first) first = image.error();
      }
    return NoneCanBeRead(unreadable, *first);
  }

  WholeGroups(const CompressSource& source, const CodecSettings& settings,
              const std::function<bool()>& is_interrupted)
      : source_(source),
        settings_(settings),
        is_interrupted_(is_interrupted),
        groups_(GroupsOf(source)),
        sample_(SampleOf(groups_, kLookedAt)) {}

  CodeError ErrorAt(double threshold, ThreadPool& pool) const override {
    CodecSettings of_threshold = settings_;
    of_threshold.threshold = threshold;
    const ImageCoder coder(source_.light_field.encoding, of_threshold, KeepFiles::kNone,
                           is_interrupted_);
    const ThresholdFactors equal;
    const GroupCoder group_coder(source_, coder, equal, is_interrupted_);
    std::vector<CodeError> errors(sample_.size());
    pool.ForEach(sample_.size(), [&](size_t i) {
      const Result<CodedGroup> coded = group_coder.Encode(groups_.Group(sample_[i]));
      if (!coded) return;
      for (const CodedMember& member : coded->members) errors[i] += member.lost;
    });
    CodeError together;
    for (const CodeError& error : errors) together += error;
    return together;
  }

 private:
  const CompressSource& source_;
  const CodecSettings settings_;
  const std::function<bool()> is_interrupted_;
  const ReferenceGroups groups_;
  const std::vector<size_t> sample_;
};

}  // namespace

Result<double> FindThreshold(const CompressSource& source, const Encoding& encoding, double psnr_db,
                             const ImageUse* use, ThreadPool& pool,
                             const std::function<bool()>& is_interrupted) {
  if (encoding.settings.profile == CodecProfile::kLossless)
    return UsageError(
        "{target_psnr} cannot be used with {profile lossless}, which has no loss: leave one of "
        "them out");
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<Sample> sample,
                      encoding.in_groups
                          ? WholeGroups::Open(source, encoding.settings, is_interrupted)
                          : SingleImages::Read(source, encoding.settings, pool, is_interrupted));
  std::optional<FrameSample> frames;
  if (use != nullptr)
    frames.emplace(*use, source.rects,
                   [&](double threshold) { return sample->ErrorAt(threshold, pool).Mean(); });
  const auto psnr_at = [&](double threshold) {
    if (!frames) return sample->ErrorAt(threshold, pool).PsnrDb();
    return CodeError{frames->ErrorAt(threshold), 1}.PsnrDb();
  };
  const double best = psnr_at(ThresholdOf(0));
  if (is_interrupted()) return Interruption();
  if (best < psnr_db)
    return UsageError(fmt::format(
        "{{target_psnr {}}}: cannot be reached, because these options give at most {:.1f} "
        "dB: give a lower PSNR, or {{profile lossless}} instead",
        psnr_db, best));
  int good = 0, bad = kSteps;
  while (bad - good > 1) {
    const int middle = (good + bad) / 2;
    (psnr_at(ThresholdOf(middle)) >= psnr_db ? good : bad) = middle;
    if (is_interrupted()) return Interruption();
  }
  return ThresholdOf(good);
}

}  // namespace lf

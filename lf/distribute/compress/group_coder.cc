// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/group_coder.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "lf/core/check.h"
#include "lf/distribute/compress/image_groups.h"
#include "lf/pixels/prediction/brightness.h"
#include "lf/pixels/prediction/find_depths.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {
namespace {

// Noise of this many thresholds makes equal thresholds the better ones.
constexpr double kNoiseOfThreshold = 0.2;

// Number of images that are predicted before a group whose predictions save nothing is given up.
constexpr size_t kTried = 6;

// A predicted image with less than this share of the expected bytes of the image by itself is not
// compared with it.
constexpr double kClear = 0.8;

// How the bytes and the error of images that are encoded alone depend on the threshold.
struct Rate {
  double bytes_exponent = 0;  // bytes are proportional to the threshold to the power of this
  double error_exponent = 0;  // as bytes_exponent, for the mean squared error

  // Returns the bytes that images of alone.bytes take if they have the error of `group` instead of
  // their own.
  double FairShare(const CodeError& alone, const CodeError& group) const {
    if (error_exponent <= 0 || !(alone.Mean() > 0) || !(group.Mean() > 0)) return 1;
    return std::pow(group.Mean() / alone.Mean(), bytes_exponent / error_exponent);
  }
};

// Returns the rate of an image that was encoded with two thresholds, of which the second one is
// `factor` times the first.
Rate RateOf(const CodedMember& first, const CodedMember& second, double factor) {
  const double step = std::log(factor);
  if (step == 0 || !(first.lost.Mean() > 0) || !(second.lost.Mean() > 0)) return {};
  const auto size = [](const CodedMember& member) {
    return std::log(static_cast<double>(member.image.code.size()));
  };
  return {(size(second) - size(first)) / step,
          std::log(second.lost.Mean() / first.lost.Mean()) / step};
}

BrightnessRange RangeOfPixels(const CodecPixels& pixels) {
  return std::visit([](const auto& image) { return RangeOf(image.view()); }, pixels);
}

Image<uint8_t> BrightnessOfPixels(const CodecPixels& pixels, PixelLayout layout,
                                  const BrightnessRange& range) {
  return std::visit(
      [&]<class Pixel>(const Image<Pixel>& image) {
        if (layout != PixelLayout::kMosaic) return BrightnessOf(image.view(), range);
        // The mean of each square of 2 x 2 pixels is that of its colours.
        Image<Pixel> means(image.width() / 2, image.height() / 2);
        for (int y = 0; y < means.height(); ++y)
          for (int x = 0; x < means.width(); ++x)
            means.at(x, y) = static_cast<Pixel>(
                (uint32_t{image.at(2 * x, 2 * y)} + image.at(2 * x + 1, 2 * y) +
                 image.at(2 * x, 2 * y + 1) + image.at(2 * x + 1, 2 * y + 1) + 2) /
                4);
        if (means.empty()) means = Image<Pixel>(1, 1);
        return BrightnessOf(std::as_const(means).view(), range);
      },
      pixels);
}

bool CanBePredicted(const RecordedImage& image) {
  const int most =
      image.layout == PixelLayout::kMosaic ? 2 * kMostPredictedSide : kMostPredictedSide;
  return std::max(image.rect.width(), image.rect.height()) <= most;
}

}  // namespace

double NoiseOf(const Image<uint8_t>& brightness) {
  constexpr int kBlock = 8;
  constexpr double kSmoothest = 0.05;      // share of the blocks that tell
  constexpr int kDark = 8, kBright = 247;  // noise is cut off at black and white
  std::vector<double> squares;
  for (int top = 1; top + kBlock < brightness.height(); top += kBlock)
    for (int left = 1; left + kBlock < brightness.width(); left += kBlock) {
      int sum = 0, square = 0;
      for (int y = top; y < top + kBlock; ++y)
        for (int x = left; x < left + kBlock; ++x) {
          // A second difference along both axes is 0 in slopes. Its weights have the sum of squares
          // 36.
          const auto across = [&](int row) {
            return brightness.at(x - 1, row) - 2 * brightness.at(x, row) +
                   brightness.at(x + 1, row);
          };
          const int difference = across(y - 1) - 2 * across(y) + across(y + 1);
          square += difference * difference;
          sum += brightness.at(x, y);
        }
      const int mean = sum / (kBlock * kBlock);
      if (mean >= kDark && mean <= kBright) squares.push_back(square / 36.0 / (kBlock * kBlock));
    }
  if (squares.empty()) return 0;
  const auto at =
      squares.begin() + static_cast<ptrdiff_t>(kSmoothest * static_cast<double>(squares.size()));
  std::nth_element(squares.begin(), at, squares.end());
  return std::sqrt(*at);
}

// State of one call of Encode().
struct GroupCoder::Work {
  // A decoded anchor, by its rank.
  struct Anchor {
    LfImageId id;
    DecodedPart decoded;
    PixelLayout layout = PixelLayout::kGrey;
    StoredValues values = StoredValues::kUint8;
  };
  size_t group_size = 0;
  size_t rank = 0;                             // of the image that is encoded
  std::vector<std::optional<Anchor>> anchors;  // [rank]
  std::optional<GroupSteps> steps;             // set by the first image
  std::optional<InverseDepthRange> depths;     // set by the first image that is predicted
  std::optional<Rate> rate;                    // of the first image
  std::vector<CodedMember> alone;              // all images, each encoded by itself
  CodedGroup group;
  // Sizes of the images that were predicted, and of the same encoded alone with the same threshold.
  size_t predicted_count = 0;
  double predicted_bytes = 0, of_them_alone = 0;
  bool is_given_up = false;  // true: the remaining images are encoded alone
};

GroupCoder::GroupCoder(const CompressSource& source, const ImageCoder& coder,
                       const ThresholdFactors& factors, std::function<bool()> is_interrupted)
    : source_(source),
      coder_(coder),
      factors_(factors),
      is_interrupted_(std::move(is_interrupted)) {}

// Encodes an image from the anchors of its references that have its layout and number type. nullopt
// if there is none.
Result<std::optional<GroupCoder::Candidate>> GroupCoder::Predicted(const RecordedImage& image,
                                                                   const GroupMember& member,
                                                                   double factor,
                                                                   Work* work) const {
  const StoredValues values = coder_.Prepared(image).values;
  std::vector<const Work::Anchor*> anchors;
  for (const uint8_t rank : member.References()) {
    const std::optional<Work::Anchor>& anchor = work->anchors[rank];
    if (anchor && anchor->layout == image.layout && anchor->values == values)
      anchors.push_back(&*anchor);
  }
  if (anchors.empty() || !CanBePredicted(image)) return std::optional<Candidate>();
  const PinholeView view = ViewToPredict(source_, member.id);
  if (!work->depths) {
    const CodecPixels pixels = coder_.Prepared(image).pixels;
    const BrightnessRange range = RangeOfPixels(pixels);
    work->depths =
        FindInverseDepths(BrightnessOfPixels(pixels, image.layout, range), view,
                          BrightnessOfPixels(anchors[0]->decoded.pixels, image.layout, range),
                          ViewToPredict(source_, anchors[0]->id));
  }
  std::vector<Reference> references;
  std::vector<LfImageId> ids;
  std::vector<const DecodedPart*> parts;
  for (const Work::Anchor* anchor : anchors) {
    const std::optional<PlaneWarp> warp =
        MakePlaneWarp(view, ViewToPredict(source_, anchor->id), *work->depths);
    if (!warp) continue;
    references.push_back({&anchor->decoded.pixels, *warp});
    ids.push_back(anchor->id);
    parts.push_back(&anchor->decoded);
  }
  if (references.empty()) return std::optional<Candidate>();
  Candidate candidate;
  LF_ASSIGN_OR_RETURN(candidate.image,
                      coder_.CodeFrom(image, references, PredictionSettings(), factor));
  candidate.image.references = std::move(ids);
  const Result<void> result =
      DecodePredicted(candidate.image.code, parts, {0, 0, image.rect.width(), image.rect.height()},
                      &candidate.decoded);
  LF_CHECK(result.has_value());
  return std::optional(std::move(candidate));
}

// Encodes an image by itself.
Result<GroupCoder::Candidate> GroupCoder::Single(const RecordedImage& image, double factor) const {
  Candidate candidate;
  LF_ASSIGN_OR_RETURN(candidate.image, coder_.Code(image, factor));
  const Result<void> result = DecodeImage(candidate.image.code, &candidate.decoded);
  LF_CHECK(result.has_value());
  return candidate;
}

// Returns the steps of a group, which depend on the noise of its first image.
GroupSteps GroupCoder::StepsFor(const RecordedImage& image) const {
  const CodecPixels pixels = coder_.Prepared(image).pixels;
  const BrightnessRange range = RangeOfPixels(pixels);
  const double noise = range.unit() * NoiseOf(BrightnessOfPixels(pixels, image.layout, range));
  const bool is_noisy = noise > kNoiseOfThreshold * coder_.SettingsFor(image, 1).threshold;
  return is_noisy ? GroupSteps::ForNoise() : GroupSteps();
}

// Returns an image predicted, or by itself with the same threshold if that is not clearly longer.
// nullopt if the group is given up.
//   of_use       factor of the threshold without that of the group's steps
//   alone_bytes  size of the image by itself with this threshold
Result<std::optional<GroupCoder::Candidate>> GroupCoder::BestOf(const RecordedImage& image,
                                                                const GroupMember& member,
                                                                double of_use, size_t alone_bytes,
                                                                Work* work) const {
  if (work->is_given_up) return std::optional<Candidate>();
  const double step = work->steps->Of(work->rank, work->group_size);
  LF_ASSIGN_OR_RETURN(std::optional<Candidate> predicted,
                      Predicted(image, member, of_use * step, work));
  if (predicted) {
    const auto bytes = static_cast<double>(predicted->image.code.size());
    // About the size of the image by itself with the same threshold.
    const double single_bytes = static_cast<double>(alone_bytes) *
                                (work->rate ? std::pow(step, work->rate->bytes_exponent) : 1);
    ++work->predicted_count;
    work->predicted_bytes += bytes;
    work->of_them_alone += single_bytes;
    work->is_given_up =
        work->predicted_count >= kTried && work->predicted_bytes > work->of_them_alone;
    if (work->is_given_up || bytes < kClear * single_bytes) return predicted;
  }
  LF_ASSIGN_OR_RETURN(Candidate single, Single(image, of_use * step));
  if (predicted && static_cast<double>(predicted->image.code.size()) <=
                       kMostPredicted * static_cast<double>(single.image.code.size()))
    return predicted;
  return std::optional(std::move(single));
}

// Reads and encodes an image of the group.
Result<void> GroupCoder::Add(const GroupMember& member, Work* work) const {
  const Result<RecordedImage> read = ReadToCompress(source_, member.id);
  if (!read && read.error().kind == ErrorKind::kInput) {
    work->group.unreadable.push_back({member.id, read.error()});
    return {};
  }
  LF_RETURN_IF_ERROR(read);
  const RecordedImage& image = *read;
  const double of_use = factors_.Of(member.id.value);
  const auto member_of = [&](CodedImage coded, const CodeError& lost) {
    const uint64_t pixel_bytes =
        std::visit([](const auto& pixels) { return pixels.size_bytes(); }, image.pixels);
    return CodedMember{member.id, std::move(coded), lost, pixel_bytes, image.is_rounded};
  };
  LF_ASSIGN_OR_RETURN(CodedImage coded_alone, coder_.Code(image, of_use));
  LF_ASSIGN_OR_RETURN(const CodeError lost_alone, coder_.ErrorOf(image, coded_alone));
  CodedMember& alone = work->alone.emplace_back(member_of(std::move(coded_alone), lost_alone));
  work->group.bytes_alone.push_back(alone.image.code.size() + alone.image.mask.size());

  if (!work->steps) work->steps = StepsFor(image);
  LF_ASSIGN_OR_RETURN(std::optional<Candidate> best,
                      BestOf(image, member, of_use, alone.image.code.size(), work));
  if (!best) return {};
  const StoredValues values = best->image.values;
  const CodeError lost = coder_.ErrorOf(image, values, best->decoded);
  work->group.members.push_back(member_of(std::move(best->image), lost));
  const CodedMember& coded = work->group.members.back();
  work->group.bytes += coded.image.code.size() + coded.image.mask.size();
  if (!work->rate) work->rate = RateOf(alone, coded, work->steps->Of(work->rank, work->group_size));
  if (work->rank < work->anchors.size())
    work->anchors[work->rank] = {member.id, std::move(best->decoded), image.layout, values};
  return {};
}

Result<CodedGroup> GroupCoder::Encode(std::span<const GroupMember> group,
                                      const std::function<void()>& encoded,
                                      uint32_t left_out) const {
  static_assert(ReferenceGroups::kMost <= 32);
  Work work;
  work.group_size = group.size();
  work.anchors.resize(AnchorCount(group.size()));
  // A single image has nobody to be finer for.
  if (group.size() == 1) work.steps = GroupSteps::ForNoise();
  for (; work.rank < group.size(); ++work.rank) {
    if (is_interrupted_ && is_interrupted_()) return Error{ErrorKind::kInterrupted, "interrupted"};
    if (!(left_out >> work.rank & 1)) LF_RETURN_IF_ERROR(Add(group[work.rank], &work));
    if (encoded) encoded();
  }
  uint64_t alone_bytes = 0;
  CodeError alone_error, error;
  for (const CodedMember& member : work.alone) {
    alone_bytes += member.image.code.size() + member.image.mask.size();
    alone_error += member.lost;
  }
  for (const CodedMember& member : work.group.members) error += member.lost;
  const double share = work.rate ? work.rate->FairShare(alone_error, error) : 1;
  if (work.is_given_up ||
      static_cast<double>(work.group.bytes) > share * static_cast<double>(alone_bytes)) {
    work.group.members = std::move(work.alone);
    work.group.bytes = alone_bytes;
  } else {
    for (uint64_t& bytes : work.group.bytes_alone)
      bytes = static_cast<uint64_t>(share * static_cast<double>(bytes));
  }
  return std::move(work.group);
}

}  // namespace lf

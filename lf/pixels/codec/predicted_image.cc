// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/predicted_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <type_traits>
#include <utility>

#include "lf/core/check.h"
#include "lf/pixels/codec/decode_by.h"
#include "lf/pixels/codec/mosaic_squares.h"
#include "lf/pixels/codec/prediction_code.h"
#include "lf/pixels/codec/residual_code.h"
#include "lf/pixels/prediction/block_search.h"
#include "lf/pixels/prediction/brightness.h"

namespace lf {
namespace {

// Returns the binary logarithm of the side of a block, for a mosaic in squares of 2 x 2 pixels.
int BlockBits(const PredictionSettings& settings, PixelLayout layout) {
  const int bits = std::countr_zero(static_cast<unsigned>(settings.block_px));
  return layout == PixelLayout::kMosaic ? std::max(bits - 1, kLeastBlockBits) : bits;
}

template <class Pixel>
PixelRect AreaOf(const Image<Pixel>& image) {
  return {0, 0, image.width(), image.height()};
}

// Returns the rectangle of squares of 2 x 2 pixels that contains the pixels `rect`, and the pixels
// of squares.
PixelRect SquaresAround(const PixelRect& rect) {
  return {rect.x_begin / 2, rect.y_begin / 2, (rect.x_end + 1) / 2, (rect.y_end + 1) / 2};
}
PixelRect PixelsOfSquares(const PixelRect& squares) {
  return {2 * squares.x_begin, 2 * squares.y_begin, 2 * squares.x_end, 2 * squares.y_end};
}

// An image as it is predicted: the image itself, or the squares of a mosaic, which are made here.
template <class Pixel>
class Picture {
 public:
  Picture() = default;
  // Shows the pixels of `image`, which must not go away.
  Picture(const Image<Pixel>& image, PixelLayout layout) : image_(image.view()) {
    if (layout == PixelLayout::kMosaic) squares_ = SquaresOf(image_);
  }
  ImageView<const Pixel> view() const { return squares_.empty() ? image_ : squares_.view(); }

 private:
  ImageView<const Pixel> image_;
  Image<Pixel> squares_;
};

// Predicts the pixels `rect` of an image, which begin at an even column and row if it is a mosaic.
template <class Pixel>
void PredictPixels(Transform transform, const PredictionPlan& plan,
                   std::span<const ReferencePart<Pixel>> references, PixelLayout layout,
                   const PixelRect& rect, ImageView<Pixel> pixels) {
  const auto predict = [&](const PixelRect& area, ImageView<Pixel> predicted) {
    if (transform == Transform::kReference)
      PredictReference(plan, references, area, predicted);
    else
      Predict(plan, references, area, predicted);
  };
  if (layout != PixelLayout::kMosaic) return predict(rect, pixels);
  const PixelRect area = SquaresAround(rect);
  Image<Pixel> squares(area.width(), area.height(), kMostPredictedChannels);
  predict(area, squares.view());
  ToMosaic(squares, pixels);
}

Error WrongReferences(const std::string& fault) {
  return InputError(fmt::format(
      "is an encoded LF image whose prediction {}; copy or make the packed store again", fault));
}

// Returns for each reference image the pixels that predict the pixels `rect` of the image.
std::vector<PixelRect> NeededBy(const CodeHead& head, const PredictionCode& prediction,
                                const PixelRect& rect) {
  const bool is_mosaic = head.info.layout == PixelLayout::kMosaic;
  std::vector<PixelRect> needed =
      NeededOfReferences(prediction.plan, prediction.sizes, is_mosaic ? SquaresAround(rect) : rect);
  if (is_mosaic)
    for (PixelRect& part : needed) part = PixelsOfSquares(part);
  return needed;
}

// Returns true if all pixels of all reference images are there: which of them are needed, takes a
// tenth of the time of a prediction to find out.
bool AreWhole(std::span<const DecodedPart* const> references, const PredictionCode& prediction,
              PixelLayout layout) {
  for (size_t r = 0; r < references.size(); ++r) {
    if (references[r] == nullptr) return false;
    const PixelRect& rect = references[r]->rect;
    const PixelRect has = layout == PixelLayout::kMosaic ? SquaresAround(rect) : rect;
    if (has != PixelRect{0, 0, prediction.sizes[r].width, prediction.sizes[r].height}) return false;
  }
  return true;
}

// Returns a reference image as the prediction needs it. kInput if it has not the pixels `needed`.
//   picture  keeps the squares of a mosaic
template <class Pixel>
Result<ReferencePart<Pixel>> PartOf(const DecodedPart* part, const PixelRect& needed,
                                    const ReferenceSize& size, PixelLayout layout,
                                    Picture<Pixel>* picture) {
  ReferencePart<Pixel> reference{{}, 0, 0, size.width, size.height};
  if (needed.empty()) return reference;
  const Image<Pixel>* const image =
      part == nullptr ? nullptr : std::get_if<Image<Pixel>>(&part->pixels);
  if (image == nullptr || image->channels() != ChannelsOf(layout) ||
      image->width() != part->rect.width() || image->height() != part->rect.height())
    return WrongReferences("needs the pixels of a reference image of its own kind");
  const bool is_mosaic = layout == PixelLayout::kMosaic;
  // A mosaic of an odd size has no second pixel in its last squares.
  const PixelRect has = is_mosaic ? SquaresAround(part->rect) : part->rect;
  const PixelRect needs = is_mosaic ? SquaresAround(needed) : needed;
  if (Intersection(has, needs) != needs ||
      (is_mosaic && (part->rect.x_begin % 2 != 0 || part->rect.y_begin % 2 != 0)))
    return WrongReferences(fmt::format("needs the pixels ({}, {}) to ({}, {}) of a reference image",
                                       needed.x_begin, needed.y_begin, needed.x_end - 1,
                                       needed.y_end - 1));
  *picture = Picture<Pixel>(*image, layout);
  reference.pixels = picture->view();
  reference.x_begin = has.x_begin;
  reference.y_begin = has.y_begin;
  return reference;
}

template <class Pixel>
Result<void> PredictPart(Transform transform, const CodeHead& head,
                         std::span<const DecodedPart* const> references, const PixelRect& rect,
                         CodecPixels* pixels) {
  const PixelLayout layout = head.info.layout;
  LF_ASSIGN_OR_RETURN(const PredictionCode prediction, ReadPrediction(head));
  std::vector<PixelRect> needed;
  if (AreWhole(references, prediction, layout)) {
    for (const DecodedPart* part : references) needed.push_back(part->rect);
  } else {
    needed = NeededBy(head, prediction, rect);
  }
  std::vector<Picture<Pixel>> pictures(references.size());
  std::vector<ReferencePart<Pixel>> parts;
  for (size_t r = 0; r < references.size(); ++r) {
    LF_ASSIGN_OR_RETURN(
        const ReferencePart<Pixel> part,
        PartOf(references[r], needed[r], prediction.sizes[r], layout, &pictures[r]));
    parts.push_back(part);
  }
  if (!std::holds_alternative<Image<Pixel>>(*pixels)) *pixels = Image<Pixel>();
  auto& image = std::get<Image<Pixel>>(*pixels);
  image.Resize(rect.width(), rect.height(), ChannelsOf(layout));
  PredictPixels<Pixel>(transform, prediction.plan, parts, layout, rect, image.view());
  return {};
}

template <class Pixel>
std::string EncodeFrom(const Image<Pixel>& image, PixelLayout layout, const CodecSettings& settings,
                       std::span<const Reference> references,
                       const PredictionSettings& prediction_settings) {
  const Picture<Pixel> target(image, layout);
  std::vector<Picture<Pixel>> pictures;
  std::vector<ReferencePart<Pixel>> parts;
  PredictionCode prediction;
  for (const Reference& reference : references) {
    const auto& decoded = std::get<Image<Pixel>>(*reference.decoded);
    LF_CHECK(decoded.channels() == image.channels() && !decoded.empty() &&
             IsWithinLimits(reference.warp));
    pictures.emplace_back(decoded, layout);
    const ReferenceSize size = PredictedSize(layout, decoded.width(), decoded.height());
    LF_CHECK(std::max(size.width, size.height) <= kMostPredictedSide);
    prediction.sizes.push_back(size);
    prediction.plan.warps.push_back(reference.warp);
  }
  for (size_t r = 0; r < pictures.size(); ++r)
    parts.push_back(
        {pictures[r].view(), 0, 0, prediction.sizes[r].width, prediction.sizes[r].height});
  const BrightnessRange range = RangeOf(target.view());
  const Image<uint8_t> brightness = BrightnessOf(target.view(), range);
  std::vector<Image<uint8_t>> of_references;
  for (const ReferencePart<Pixel>& part : parts)
    of_references.push_back(BrightnessOf(part.pixels, range));
  SearchSettings search;
  search.block_bits = BlockBits(prediction_settings, layout);
  search.step =
      settings.profile == CodecProfile::kLossless ? 0 : 1.5 * settings.threshold / range.unit();
  prediction.plan.blocks = SearchBlocks(brightness, of_references, prediction.plan.warps, search);
  CodecPixels predicted = Image<Pixel>(image.width(), image.height(), image.channels());
  auto& predicted_image = std::get<Image<Pixel>>(predicted);
  PredictPixels<Pixel>(Transform::kSimd, prediction.plan, parts, layout, AreaOf(image),
                       predicted_image.view());
  return EncodeResidual(image, predicted, layout, settings, static_cast<int>(references.size()),
                        BytesOfPrediction(prediction));
}

}  // namespace

std::string EncodePredicted(const CodecPixels& pixels, PixelLayout layout,
                            const CodecSettings& settings, std::span<const Reference> references,
                            const PredictionSettings& prediction) {
  LF_CHECK(prediction.block_px == 8 || prediction.block_px == 16 || prediction.block_px == 32);
  LF_CHECK(!references.empty() && references.size() <= kMostReferences);
  return std::visit(
      [&]<class Pixel>(const Image<Pixel>& image) {
        const ReferenceSize size = PredictedSize(layout, image.width(), image.height());
        LF_CHECK(!image.empty() && std::max(size.width, size.height) <= kMostPredictedSide);
        return EncodeFrom(image, layout, settings, references, prediction);
      },
      pixels);
}

Result<std::vector<PixelRect>> NeededOfReferences(std::string_view code, const PixelRect& wanted) {
  LF_ASSIGN_OR_RETURN(const CodeHead head, TakeHead(&code));
  if (!head.is_predicted()) return std::vector<PixelRect>();
  const PixelRect inside = Intersection(wanted, {0, 0, head.info.width, head.info.height});
  LF_CHECK(!inside.empty());
  LF_ASSIGN_OR_RETURN(const PredictionCode prediction, ReadPrediction(head));
  return NeededBy(head, prediction, TilesAround(head, inside));
}

Result<void> DecodePredictedBy(Transform transform, std::string_view code,
                               std::span<const DecodedPart* const> references,
                               const PixelRect& wanted, DecodedPart* part) {
  std::string_view rest = code;
  LF_ASSIGN_OR_RETURN(const CodeHead head, TakeHead(&rest));
  if (!head.is_predicted()) return DecodeImageBy(transform, code, wanted, part);
  if (references.size() != static_cast<size_t>(head.info.reference_count))
    return WrongReferences(fmt::format("needs {} reference images, not {}",
                                       head.info.reference_count, references.size()));
  const PixelRect inside = Intersection(wanted, {0, 0, head.info.width, head.info.height});
  LF_CHECK(!inside.empty());
  part->rect = TilesAround(head, inside);
  if (head.info.bits == 8)
    LF_RETURN_IF_ERROR(
        PredictPart<uint8_t>(transform, head, references, part->rect, &part->pixels));
  else
    LF_RETURN_IF_ERROR(
        PredictPart<uint16_t>(transform, head, references, part->rect, &part->pixels));
  return DecodeResidual(transform, code, part->rect, &part->pixels);
}

Result<void> DecodePredicted(std::string_view code, std::span<const DecodedPart* const> references,
                             const PixelRect& wanted, DecodedPart* part) {
  return DecodePredictedBy(Transform::kSimd, code, references, wanted, part);
}

}  // namespace lf

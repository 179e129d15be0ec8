// SPDX-License-Identifier: Apache-2.0
// Encodes an image relative to up to four others whose pixels the decoder has, the reference images
// (thesis 6.2), and decodes it. Neighbouring LF images show nearly the same, moved by parallax:
// what is encoded is the difference to a prediction from the reference images, and the depths of
// blocks (lf/pixels/prediction/predict.h). doc/formats/lf_image.md, "Prediction", describes the
// format.
//
// Predicted images are decoded with integers alone, from the decoded pixels of reference images:
// the same bits on every machine. Images of 8 and 16 bits, grey, mosaics and RGB can be predicted,
// in the profiles kDefault and kLossless; all images of a prediction have the same layout and bits.
// Encoding is deterministic.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/pixels/prediction/plane_warp.h"

namespace lf {

// An image from which another one is predicted.
struct Reference {
  // The pixels as the decoder will have them: decoded from an encoded image, not those that were
  // encoded. Width and height are at most kMostPredictedSide; for a mosaic, twice as much.
  const CodecPixels* decoded = nullptr;
  // Positions of the target's pixels in the reference image; those of their squares of 2 x 2 pixels
  // for a mosaic, whose warp is made of Halved() cameras (plane_warp.h).
  PlaneWarp warp;
};

struct PredictionSettings {
  // Side of the blocks that have a depth each: 8, 16 or 32 pixels, and at least 16 for a mosaic.
  // Blocks of 8 pixels take 2 to 3 % fewer bytes than those of 16 and 1.2 times as long to decode.
  int block_px = 16;
};

// Returns the encoded image. Arguments are those of EncodeImage(), with these limits: the profile
// is not kThesis, and width and height are at most kMostPredictedSide; for a mosaic, twice as much.
//   references  1 to kMostReferences (predict.h); more than three hardly ever help
std::string EncodePredicted(const CodecPixels& pixels, PixelLayout layout,
                            const CodecSettings& settings, std::span<const Reference> references,
                            const PredictionSettings& prediction = {});

// Returns for each reference image the pixels that DecodePredicted() needs of it; empty if it needs
// none. For a mosaic, rectangles begin and end at even columns and rows, and may extend beyond an
// image of odd size by a pixel. kInput as DecodePredicted().
Result<std::vector<PixelRect>> NeededOfReferences(std::string_view code, const PixelRect& wanted);

// Decodes the tiles that overlap `wanted`, as DecodeImage() does. Images that are not predicted are
// decoded also, without reference images.
//   references  one for each reference image, in the order in which they were given to
//               EncodePredicted(): the whole image, or a part of it that contains the pixels of
//               NeededOfReferences(); null if it needs none
// Returns kInput if DecodeImage() does, if the bytes that describe the prediction are damaged, or
// if number, type or pixels of the reference images do not suffice; the message does not name the
// file. With other pixels than the encoder had, the result is another picture.
Result<void> DecodePredicted(std::string_view code, std::span<const DecodedPart* const> references,
                             const PixelRect& wanted, DecodedPart* part);

}  // namespace lf

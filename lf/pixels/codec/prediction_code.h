// SPDX-License-Identifier: Apache-2.0
// The bytes of an encoded image that describe how it is predicted from others: sizes and warps of
// the reference images, depths and masks of the blocks (doc/formats/lf_image.md, "Prediction").
// Internal to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lf/pixels/codec/code_head.h"
#include "lf/pixels/prediction/predict.h"

namespace lf {

struct PredictionCode {
  PredictionPlan plan;
  std::vector<ReferenceSize> sizes;  // pixels that are predicted from: squares of a mosaic
};

// Returns the size of the picture that is predicted for an image: that of its squares for a mosaic.
ReferenceSize PredictedSize(PixelLayout layout, int width, int height);

std::string BytesOfPrediction(const PredictionCode& prediction);
// Reads what BytesOfPrediction() wrote for the image of a head with reference images. Returns
// kInput if it is damaged; the message does not name the file. Needs memory for the blocks of the
// image, at most 1/32 of a byte for each pixel, whatever the bytes are.
Result<PredictionCode> ReadPrediction(const CodeHead& head);

}  // namespace lf

// Which rays of an LF image are kept: the more it changes around a pixel, the likelier (thesis
// 4.3.2, Eq. 4.4, Figure 4.8).
//
// The image is smoothed by a Gaussian, its Laplacian taken, and
//
//   p(x, y) = min(1, |LoG(x, y)| alpha + xi)  where |LoG(x, y)| >= beta,  else 0
//
// of stored values, before they become linear light: there noise is about as strong in shadows as
// in light. All is done in whole numbers, so that every machine keeps the same rays.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/capture/lf_pixels.h"
#include "lf/capture/radiance.h"
#include "lf/core/image.h"

namespace lf {

struct ProbabilityOptions {
  double sigma_px = 1;         // of the Gaussian, at most kMostSigma_px; 0: none
  double alpha = 8;            // per unit of stored values, black 0 and white 1; at most kMostAlpha
  double beta = 0;             // in the same unit
  double xi = 0.05;            // of every pixel that passes beta, [0, 1)
  double second_sigma_px = 0;  // of another Gaussian, over p; 0: none
};
inline constexpr double kMostSigma_px = 8;
inline constexpr double kMostAlpha = 255;

// Stored values, 65535 of black .. white, of linear ones (capture/radiance.h): the inverse of
// RadianceTable() with a gain of 1.  [65536]
std::vector<uint16_t> StoredValueTable(const RadianceEncoding& encoding);

// p of the pixels of `rect`, a part of pixels.rect, in 1 / 65535  [rect.height][rect.width]; its
// memory is used again
// Of a mosaic the means of the two greens of every 2 x 2 pixels (at even positions in the LF image)
// are taken for the image, sigma still counts LF pixels, and all four pixels have the same p.
// At the borders of pixels.rect the image goes on as it ends: give some pixels more than those that
// are asked about (PixelsAround()).
// Masked pixels have p = 0.
void ProbabilityMap(const LfPixels& pixels, const PixelRect& rect,
                    const std::vector<uint16_t>& stored_values, const ProbabilityOptions& options,
                    Image<uint16_t>* p);

// How far from a pixel its p depends on others.
int PixelsAround(const ProbabilityOptions& options, bool is_mosaic);

// ProbabilityMap(), pixel by pixel.
void ProbabilityMapReference(const LfPixels& pixels, const PixelRect& rect,
                             const std::vector<uint16_t>& stored_values,
                             const ProbabilityOptions& options, Image<uint16_t>* p);

}  // namespace lf

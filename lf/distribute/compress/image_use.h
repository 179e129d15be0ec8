// SPDX-License-Identifier: Apache-2.0
// Chooses the threshold of each LF image by how much the frames of packages use it, and predicts
// the errors of these frames.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/render/package/package.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {

// How much each LF image counts in each frame of some packages. Takes 12 bytes for each LF image of
// each frame.
struct ImageUse {
  struct Share {
    uint32_t id;    // id of the LF image in the whole light field
    float share;    // ImageShare::share (render/needs/image_shares.h)
    float squared;  // ImageShare::squared
  };
  struct Frame {
    FrameId id;
    std::vector<Share> shares;
  };
  std::vector<Frame> frames;
  StoreFilms films;
};

// Returns the use of the LF images by all frames of the packages, with the lens weights that a
// render has by default: kAuto, or kNone for packages without neighbours. kUsage: a package is made
// for a mode in which LF images have no weights (kRebin, kHybrid), or only some have neighbours.
// kInterrupted: *interrupted became true.
Result<ImageUse> UseBy(std::span<const Package> packages, ThreadPool& pool,
                       const std::atomic<bool>* interrupted);

// The thresholds of LF images, as factors of one threshold: powers of 2^(1/8), from 1/2 to 2.
class ThresholdFactors {
 public:
  // All factors are 1.
  ThresholdFactors() = default;
  // The factors that are chosen by use: with W = sum of ImageShare::squared over all frames and p =
  // number of encoded pixels of an LF image, its factor is
  //
  //   ((sum of W / sum of p) / (W / p))^(1/2),
  //
  // limited to [1/2, 2]. As long as no factor is limited, frames have about the errors that they
  // have if all factors are 1.
  //   rects  pixels of each LF image that are encoded (CompressSource::rects)
  ThresholdFactors(const ImageUse& use, std::span<const PixelRect> rects);

  bool are_one() const { return steps_.empty(); }
  double Of(uint32_t id) const;
  // Returns " by use HASH", with a hash of the factors; "" if all are 1. NameOf(CodecSettings) adds
  // it to the words of the threshold.
  std::string Words() const;

 private:
  static constexpr int kStepsOfTwo = 8;
  std::vector<int8_t> steps_;  // [id]: the factor is 2^(step / kStepsOfTwo)
};

// The error of an LF image consists of noise of its own, and of details that it lacks like all LF
// images that see the same place. Noise averages out in a frame. With mean squared errors D of LF
// images and their shares s, the mean squared error of a frame is about
//
//   (1 - c) (sum of s^2 D) + c (sum of s D^(1/2))^2,    c = kCommonShare.
//
// kCommonShare was measured (doc/codec.md, "Quality by use"). The prediction is for frames whose
// elements are about as large as LF pixels.
inline constexpr double kCommonShare = 0.05;

// Predicted errors of frames, as mean squares of differences in the range from black to white.
struct FrameErrors {
  double mean = 0;  // mean of all frames
  double worst = 0;
  FrameId worst_frame;
};
//   errors  mean squared error of each LF image, [id]
FrameErrors PredictFrames(const ImageUse& use, std::span<const double> errors);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Demosaics LF images with the help of their neighbours, which recorded the missing colours a pixel
// or three away (joint_tile.h has the formula).
//
// Each LF image depends on up to kJointNeighbours others, near ones that look in about the same
// direction (joint_neighbours.h). Its inverse depths are searched as lfdensify does, by comparing
// it with LF images in eight directions, and are then corrected by fractions of a pixel. A guard
// takes nothing from the neighbours where that would not be better (joint_guard.h).
//
// Limits: LF images of regular captures whose neighbours record the same colour of each point,
// because points move by even numbers of pixels between them, gain little. What moves, glitters or
// is seen by one LF image alone stays as it is demosaicked by itself. Recorded values are kept,
// with their noise.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/demosaic/joint_guard.h"
#include "lf/densify/watched_loop.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// The number changes whenever the same mosaics give other colours.
inline constexpr int kJointVersion = 1;
inline constexpr size_t kJointNeighbours = 32;

struct JointImageResult {
  // [height][width][3]: radiance before white balance, after gain and falloff, so that LF images of
  // different exposures have equal values. NaN if the pixel is masked.
  Image<float> rgb;
  GuardErrors errors;
};

// Returns kUsage or kInput, with what to do, if a light field cannot be demosaicked jointly: it has
// no mosaic, virtual LF images, or brackets.
Result<void> CheckForJoint(const LightField& light_field);

class JointDemosaicker {
 public:
  struct Options {
    // Memory for LF images that are kept from one call to the next, 44 bytes for each pixel. Those
    // in use, up to kJointNeighbours + 9 for each thread, and 1600 bytes for each pixel of a tile
    // of 256 x 256 pixels for each thread come on top.
    size_t memory_bytes = size_t{2} << 30;
    Watch watch;  // of the search for LF images that cannot be read
  };

  // Loads every LF image once, to leave out those that cannot be read, and finds the range of
  // depths. Errors of CheckForJoint(). kInput: no depths can be found. kInterrupted.
  static Result<std::unique_ptr<JointDemosaicker>> Make(const LightField& light_field,
                                                        ThreadPool& pool, const Options& options);
  ~JointDemosaicker();

  // Demosaics a whole LF image. The result depends on the calibration and on the LF images that can
  // be read alone. May be called by many threads at the same time. kInput: the LF image cannot be
  // read. kInterrupted: the flag of the watch is set.
  Result<JointImageResult> Demosaic(LfImageId id) const;

 private:
  struct State;
  explicit JointDemosaicker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lf

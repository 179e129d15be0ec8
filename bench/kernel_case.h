// SPDX-License-Identifier: Apache-2.0
// The data on which the kernels of ray collection and their peers are measured: a batch of LF
// images around one frame, all of one flat picture in the focus plane, so that every contender
// should compute the same frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/collection/gather_sampling.h"
#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf::bench {

enum class Estimator { kNearest, kBilinear };

struct CaseSpec {
  std::string name;
  Estimator estimator = Estimator::kNearest;
  PixelFilter filter = PixelFilter::kBilinear;  // used by Estimator::kBilinear
  BayerPattern bayer = BayerPattern::kRggb;
  int image_size_px = 2048;  // LF images are square
  int plate_width = 1920;
  int plate_height = 1080;
  double magnification = 1;  // elements per LF pixel, in the middle of the frame
  // Share of the rays landing on the plate that pass the lens. The rim of the lens cuts every
  // image. 1: the lens is so wide that all rays pass.
  double accepted_share = 0.95;
  int blades = 0;
  FocusTilt tilt;
  Distortion distortion;  // lens distortion of all LF cameras
  double turn_deg = 1;    // LF cameras are rotated about each axis by up to this
  double roll_deg = 0;    // all LF cameras are also rotated about the optical axis by this
  bool parallel = false;  // no LF camera is rotated, and all are in the lens plane
  int image_count = 16;
  int peer_image_count = 16;  // number of images that the slow contenders get
  bool every_target = false;  // our kernel is also run with each instruction set
};

struct KernelCase {
  CaseSpec spec;
  RenderCamera frame;
  std::vector<PinholeCamera> cameras;
  std::vector<LfPixels> images;  // whole LF images
  std::vector<PixelRect> rects;  // pixels that can contribute (selection); others are not visited
  // For lens distortion: shared by all images, which have the same intrinsics.
  std::optional<IdealPixels> ideal_pixels;
  Image<float> ideal_positions;  // [height][width][2]: ideal position of every pixel centre
};

// Makes a case from 8-bit sRGB, converted by the table of lf/light_field/model/radiance.h to 16-bit
// linear light.
KernelCase MakeCase(const CaseSpec& spec);

// Returns every case of the table.
std::vector<CaseSpec> AllCases();

}  // namespace lf::bench

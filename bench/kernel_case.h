// What the kernels of ray collection and their peers are measured on: a batch of LF images around
// one frame, all of one flat picture that lies in the focus plane, so that every contender should
// make the same frame of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/capture/lf_pixels.h"
#include "lf/collection/gather_sampling.h"
#include "lf/core/geometry.h"
#include "lf/core/image.h"

namespace lf::bench {

enum class Estimator { kNearest, kBilinear };

struct CaseSpec {
  std::string name;
  Estimator estimator = Estimator::kNearest;
  PixelFilter filter = PixelFilter::kBilinear;  // of kBilinear
  BayerPattern bayer = BayerPattern::kRggb;
  int image_size_px = 2048;  // LF images are square
  int plate_width = 1920;
  int plate_height = 1080;
  double magnification = 1;  // elements per LF pixel, in the middle of the frame
  // Of the rays of LF images that land on the plate, those that pass the lens; every image is cut
  // by the rim. 1: the lens is so wide that all pass.
  double accepted_share = 0.95;
  int blades = 0;
  FocusTilt tilt;
  Distortion distortion;  // of the LF cameras
  double turn_deg = 1;    // LF cameras are turned about each axis by up to this
  double roll_deg = 0;    // and all of them about the optical axis by this
  bool parallel = false;  // no LF camera is turned, and all stand in the lens plane
  int image_count = 16;
  int peer_image_count = 16;  // of these, those that the slow contenders are given
  bool every_target = false;  // our kernel also restricted to each instruction set
};

struct KernelCase {
  CaseSpec spec;
  RenderCamera frame;
  std::vector<PinholeCamera> cameras;
  std::vector<LfPixels> images;  // whole LF images
  std::vector<PixelRect> rects;  // the pixels that can contribute (selection): all anybody visits
  // With lens distortion, for all images, which share their intrinsics.
  std::optional<IdealPixels> ideal_pixels;
  Image<float> ideal_positions;  // [height][width][2]: of the centre of every pixel
};

// 8-bit sRGB, through the table of lf/capture/radiance.h: 16-bit linear light.
KernelCase MakeCase(const CaseSpec& spec);

// Every case of the table.
std::vector<CaseSpec> AllCases();

}  // namespace lf::bench

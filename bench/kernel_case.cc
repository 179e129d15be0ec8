// SPDX-License-Identifier: Apache-2.0
#include "bench/kernel_case.h"

#include <algorithm>
#include <cmath>

#include "lf/camera/ray_forms.h"
#include "lf/collection/ray_model.h"
#include "lf/core/check.h"
#include "lf/core/random.h"
#include "lf/light_field/model/radiance.h"
#include "lf/selection/overlap.h"

namespace lf::bench {
namespace {

constexpr double kFocalLength_px = 2000;  // for LF images of 2048 x 2048 pixels
constexpr double kFocusDistance_w = 1;
// LF cameras are this far in front of or behind the lens, so that the rim of the lens cuts every
// image.
constexpr double kDepthOffset_w = 0.03;
constexpr double kLateralOffset_w = 0.004;
constexpr double kWideLens_w = 10;

RigidTransform Pose(const Vec3& centre, const Vec3& turns_rad) {
  const Mat3 rotation = (Eigen::AngleAxisd(turns_rad.z(), Vec3::UnitZ()) *
                         Eigen::AngleAxisd(turns_rad.y(), Vec3::UnitY()) *
                         Eigen::AngleAxisd(turns_rad.x(), Vec3::UnitX()))
                            .toRotationMatrix();
  return {rotation, -rotation * centre};
}

std::vector<PinholeCamera> MakeCameras(const CaseSpec& spec, double focal_length_px) {
  RandomSequence random(1);
  std::vector<PinholeCamera> cameras(static_cast<size_t>(spec.image_count));
  const double turn = RadiansFromDegrees(spec.parallel ? 0 : spec.turn_deg);
  const int size = spec.image_size_px;
  for (size_t i = 0; i < cameras.size(); ++i) {
    cameras[i].intrinsics = {
        focal_length_px, focal_length_px, 0.5 * size, 0.5 * size, 0, size, size, spec.distortion};
    const double depth = random.Uniform(0.8, 1) * (i % 2 == 0 ? 1 : -1) * kDepthOffset_w;
    const double x = random.Uniform(-1, 1) * kLateralOffset_w;
    const double y = random.Uniform(-1, 1) * kLateralOffset_w;
    const double pitch = random.Uniform(-turn, turn), yaw = random.Uniform(-turn, turn);
    const double roll = random.Uniform(-turn, turn) + RadiansFromDegrees(spec.roll_deg);
    cameras[i].cam_from_world = Pose({x, y, spec.parallel ? 0 : depth}, {pitch, yaw, roll});
  }
  return cameras;
}

// Returns the value of a picture without borders at a position in elements of a 1920-wide plate.
double Pattern(double x, double y, int channel) {
  const auto wave = [](double t) {
    t -= std::floor(t);
    return 16 * t * t * (1 - t) * (1 - t);
  };
  return 0.1 + 0.4 * wave(x / 91 + 0.3 * channel) + 0.4 * wave((y + 0.3 * x) / 67 - 0.2 * channel);
}

// Returns the ideal positions of pixel centres, [height][width][2].
Image<float> IdealPositions(const IdealPixels& ideal_pixels, int size) {
  Image<float> positions(size, size, 2, -1e6f);
  for (const IdealPatch& patch : ideal_pixels.patches())
    for (int y = patch.rect.y_begin; y < patch.rect.y_end; ++y) {
      const IdealArc arc = patch.Scanline(y);
      for (int x = arc.x_begin; x < arc.x_end; ++x) {
        const Vec3 q = arc.At(arc.Parameter(x));
        positions.at(x, y, 0) = static_cast<float>(q.x() / q.z());
        positions.at(x, y, 1) = static_cast<float>(q.y() / q.z());
      }
    }
  return positions;
}

LfPixels Photograph(const KernelCase& kernel_case, const PinholeCamera& camera,
                    const std::vector<uint16_t>& table) {
  const CaseSpec& spec = kernel_case.spec;
  const int size = spec.image_size_px;
  LfPixels pixels({0, 0, size, size}, spec.bayer);
  const bool is_rgb = spec.bayer == BayerPattern::kNone;
  const RayForms forms = MakeRayForms(camera, kernel_case.frame);
  const double unit = 1920.0 / spec.plate_width;
  const auto value = [&](double u, double v, int channel) {
    return table[static_cast<size_t>(std::lround(255 * Pattern(u, v, channel)))];
  };
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      Vec3 p(x + 0.5, y + 0.5, 1);
      if (kernel_case.ideal_pixels)
        p.head<2>() =
            Vec2(kernel_case.ideal_positions.at(x, y, 0), kernel_case.ideal_positions.at(x, y, 1));
      const double scale = unit / Value(forms.front, p);
      const double u = Value(forms.sensor_x, p) * scale, v = Value(forms.sensor_y, p) * scale;
      if (!is_rgb) {
        pixels.radiance.at(x, y) = value(u, v, BayerChannel(spec.bayer, x, y));
        continue;
      }
      for (int channel = 0; channel < 3; ++channel)
        pixels.radiance.at(x, y, channel) = value(u, v, channel);
    }
  return pixels;
}

// Returns the number of accepted rays among some pixels of some images.
uint64_t AcceptedCount(const KernelCase& kernel_case, const RenderCamera& frame) {
  constexpr size_t kImages = 4;
  constexpr int kStep = 16;
  uint64_t accepted = 0;
  for (size_t i = 0; i < std::min(kImages, kernel_case.cameras.size()); ++i) {
    const RayModel model(kernel_case.cameras[i], frame);
    for (int y = kStep / 2; y < kernel_case.spec.image_size_px; y += kStep)
      for (int x = kStep / 2; x < kernel_case.spec.image_size_px; x += kStep)
        accepted += model.Collect(x, y) ? 1 : 0;
  }
  return accepted;
}

// Returns the radius of the lens with which the desired share of the rays passes.
double LensRadius(const KernelCase& kernel_case) {
  if (kernel_case.spec.accepted_share >= 1) return kWideLens_w;
  RenderCamera frame = kernel_case.frame;
  frame.aperture.radius_w = kWideLens_w;
  const double wanted =
      kernel_case.spec.accepted_share * static_cast<double>(AcceptedCount(kernel_case, frame));
  double low = 0, high = 0.1;
  for (int step = 0; step < 20; ++step) {
    frame.aperture.radius_w = 0.5 * (low + high);
    const bool enough = static_cast<double>(AcceptedCount(kernel_case, frame)) >= wanted;
    (enough ? high : low) = frame.aperture.radius_w;
  }
  return high;
}

}  // namespace

KernelCase MakeCase(const CaseSpec& spec) {
  KernelCase kernel_case;
  kernel_case.spec = spec;
  const double focal_length_px = kFocalLength_px * spec.image_size_px / 2048;
  RenderCamera& frame = kernel_case.frame;
  frame.pinhole.intrinsics = {focal_length_px * spec.magnification,
                              focal_length_px * spec.magnification,
                              0.5 * spec.plate_width,
                              0.5 * spec.plate_height,
                              0,
                              spec.plate_width,
                              spec.plate_height,
                              {}};
  frame.focus_plane = FocusPlane(frame.pinhole, kFocusDistance_w, spec.tilt);
  frame.aperture = {kWideLens_w, spec.blades, 0.2};
  kernel_case.cameras = MakeCameras(spec, focal_length_px);
  std::vector<IdealCell> cells;
  if (spec.distortion.model != DistortionModel::kNone) {
    const Intrinsics& k = kernel_case.cameras[0].intrinsics;
    kernel_case.ideal_pixels.emplace(k);
    kernel_case.ideal_positions = IdealPositions(*kernel_case.ideal_pixels, spec.image_size_px);
    cells = MakeIdealCells(k);
  }
  frame.aperture.radius_w = LensRadius(kernel_case);

  const std::vector<uint16_t> table = RadianceTable(RadianceEncoding{}, 8, 1);
  const PixelReach reach =
      spec.estimator == Estimator::kBilinear ? PixelReach::kNeighbours : PixelReach::kOwn;
  for (const PinholeCamera& camera : kernel_case.cameras) {
    kernel_case.images.push_back(Photograph(kernel_case, camera, table));
    if (spec.filter == PixelFilter::kMosaic)
      kernel_case.images.back().recorded = BayerPattern::kRggb;
    kernel_case.rects.push_back(ContributingRect(camera, frame, cells, reach));
    LF_CHECK(!kernel_case.rects.back().empty());
  }
  return kernel_case;
}

std::vector<CaseSpec> AllCases() {
  using enum DistortionModel;
  std::vector<CaseSpec> cases;
  const auto add = [&](const char* name) -> CaseSpec& {
    cases.push_back({});
    cases.back().name = name;
    return cases.back();
  };
  add("disk");
  add("disk_64_images").image_count = 64;
  add("pentagon").blades = 5;
  add("tilt").tilt = {RadiansFromDegrees(20), RadiansFromDegrees(30)};
  add("distortion_phone").distortion = {kRadialTangential, {0.035}};
  add("distortion_barrel").distortion = {kRadialTangential, {-0.25, 0.07, 0.002, -0.003}};
  add("distortion_fisheye").distortion = {kFisheye, {-0.02, 0.004, -0.002, 3e-4}};
  CaseSpec& separable = add("separable");
  separable.parallel = true;
  separable.accepted_share = 1;  // LF cameras in the lens plane: the lens lets all rays pass
  add("turned_3_deg").turn_deg = 3;
  add("rolled_90_deg").roll_deg = 90;
  add("accepted_10").accepted_share = 0.1;
  add("accepted_60").accepted_share = 0.6;
  add("accepted_100").accepted_share = 1;
  add("magnification_0.5").magnification = 0.5;
  add("magnification_1.5").magnification = 1.5;
  const auto plate = [&](const char* name, int width, int height, int peer_images) {
    CaseSpec& spec = add(name);
    spec.plate_width = width;
    spec.plate_height = height;
    spec.image_size_px = (2048 * width + 959) / 1920 / 2 * 2;
    spec.peer_image_count = peer_images;
  };
  plate("plate_720p", 1280, 720, 16);
  plate("plate_1080p", 1920, 1080, 16);
  plate("plate_4k", 3840, 2160, 4);
  plate("plate_8k", 7680, 4320, 2);
  add("rgb").bayer = BayerPattern::kNone;
  const auto gather = [&](const char* name) -> CaseSpec& {
    CaseSpec& spec = add(name);
    spec.bayer = BayerPattern::kNone;
    spec.estimator = Estimator::kBilinear;
    return spec;
  };
  gather("bilinear");
  gather("bicubic").filter = PixelFilter::kBicubic;
  gather("mosaic").filter = PixelFilter::kMosaic;
  gather("prefiltered").filter = PixelFilter::kPrefiltered;
  gather("bilinear_0.5").magnification = 0.5;
  const auto prefiltered = [&](const char* name) -> CaseSpec& {
    CaseSpec& spec = gather(name);
    spec.filter = PixelFilter::kPrefiltered;
    return spec;
  };
  prefiltered("prefiltered_phone").distortion = {kRadialTangential, {0.035}};
  prefiltered("prefiltered_barrel").distortion = {kRadialTangential, {-0.25, 0.07, 0.002, -0.003}};
  prefiltered("prefiltered_fisheye").distortion = {kFisheye, {-0.02, 0.004, -0.002, 3e-4}};
  CaseSpec& coarse = gather("prefiltered_0.5");
  coarse.filter = PixelFilter::kPrefiltered;
  coarse.magnification = 0.5;
  CaseSpec& coarse_mosaic = gather("mosaic_0.5");
  coarse_mosaic.filter = PixelFilter::kMosaic;
  coarse_mosaic.magnification = 0.5;
  for (CaseSpec& spec : cases) {
    for (const char* name : {"disk", "separable", "distortion_phone", "rgb", "bilinear", "bicubic",
                             "mosaic", "prefiltered"})
      spec.every_target |= spec.name == name;
    spec.peer_image_count = std::min(spec.peer_image_count, spec.image_count);
  }
  return cases;
}

}  // namespace lf::bench

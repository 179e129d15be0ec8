// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/image_feather.h"

#include <algorithm>
#include <cmath>

#include "lf/camera/ray_weight.h"

namespace lf {
namespace {

double Smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// The positions from begin to end, both included, of a row of corners of blocks: position i is
// kWeightBlock * i elements to the right of the first one. Empty if begin > end.
struct PositionRange {
  double begin, end;

  // Keeps only positions where a linear form of the place on the plate is not negative.
  //   first  homogeneous place of position 0
  void Keep(const Vec3& form, const Vec3& first) {
    const double value = form.dot(first), slope = kWeightBlock * form.x();
    if (slope > 0)
      begin = std::max(begin, -value / slope);
    else if (slope < 0)
      end = std::min(end, -value / slope);
    else if (!(value >= 0))
      begin = INFINITY;
  }
};

}  // namespace

double FeatherAt(const Intrinsics& lf_image, double x_px, double y_px) {
  const double width = kFeatherShare * std::min(lf_image.width_px, lf_image.height_px);
  const double across = std::min(x_px - 0.5, lf_image.width_px - 0.5 - x_px);
  const double down = std::min(y_px - 0.5, lf_image.height_px - 0.5 - y_px);
  return Smooth(across / width) * Smooth(down / width);
}

ImageFeather::ImageFeather(const PinholeCamera& lf_camera, const RenderCamera& frame)
    : intrinsics_(lf_camera.intrinsics),
      lf_camera_(lf_camera),
      frame_(frame),
      maps_(MapsOf(lf_camera, frame)) {
  constexpr double kRounding_px = 1e-6;
  border_px_ =
      0.5 + kRounding_px + kFeatherShare * std::min(intrinsics_.width_px, intrinsics_.height_px);
}

ImageFeather::Maps ImageFeather::MapsOf(const PinholeCamera& lf_camera, const RenderCamera& frame) {
  const PinholeCamera& lens = frame.pinhole;
  const Vec3& n = frame.focus_plane.normal;
  const Vec3 offset = lf_camera.CentreWorld() - lens.CentreWorld();
  const double distance = frame.focus_plane.offset_w - n.dot(lens.CentreWorld());
  const double sign = distance < 0 ? -1 : 1;
  const Mat3 direction = lens.cam_from_world.rotation.transpose() * lens.intrinsics.InverseMatrix();
  // X is the focus point of the position e = (x, y, 1) on the plate, c the centre of the LF camera,
  // and c' the centre of the lens: X - c' = distance (direction e) / n.(direction e), and
  // X - c = X - c' - offset. If X is in front of the lens, to_focus e = (X - c) |n.(direction e)|.
  const Mat3 to_focus = sign * (distance * Mat3::Identity() - offset * n.transpose()) * direction;
  Maps maps;
  maps.to_focus = lf_camera.cam_from_world.rotation * to_focus;
  maps.to_pixel = lf_camera.intrinsics.Matrix() * maps.to_focus;
  maps.before_lens = (sign * n.transpose() * direction).transpose();
  maps.runs_forward = (lens.ForwardWorld().transpose() * to_focus).transpose();
  return maps;
}

void ImageFeather::OfRow(int x, int y, int count, uint16_t* feather) const {
  if (intrinsics_.has_distortion() || frame_.surface) return ComputeRow(x, y, count, feather);
  const auto [seen_begin, seen_end, whole_begin, whole_end] = PartsOfRow(x, y, count);
  const auto compute = [&](int begin, int end) {
    ComputeRow(x + begin * kWeightBlock, y, end - begin, feather + begin);
  };
  std::fill_n(feather, seen_begin, uint16_t{0});
  compute(seen_begin, whole_begin);
  std::fill(feather + whole_begin, feather + whole_end, uint16_t{kWholeFeather});
  compute(whole_end, seen_end);
  std::fill(feather + seen_end, feather + count, uint16_t{0});
}

// Each edge of a part is where a linear form of the position is 0. Rounding does not matter: seen
// positions are one more on either side, and whole ones lie within border_px_, where ComputeRow()
// rounds to kWholeFeather.
ImageFeather::RowParts ImageFeather::PartsOfRow(int x, int y, int count) const {
  const Vec3 first(x, y, 1);
  const double forward = maps_.runs_forward.dot(first);
  const double forward_at_end =
      forward + maps_.runs_forward.x() * static_cast<double>((count - 1) * kWeightBlock);
  if (!(forward * forward_at_end > 0)) return {0, count, count, count};
  const double side = forward < 0 ? -1 : 1;
  PositionRange seen{0, count - 1.0};
  seen.Keep(maps_.before_lens, first);
  const Mat3 to_pixel = side * maps_.to_pixel;
  const Vec3 across = to_pixel.row(0).transpose(), down = to_pixel.row(1).transpose(),
             depth = to_pixel.row(2).transpose();
  seen.Keep(depth, first);
  const auto keep_within = [&](double border_px, PositionRange* range) {
    range->Keep(across - border_px * depth, first);
    range->Keep((intrinsics_.width_px - border_px) * depth - across, first);
    range->Keep(down - border_px * depth, first);
    range->Keep((intrinsics_.height_px - border_px) * depth - down, first);
  };
  PositionRange whole = seen;
  keep_within(0.5, &seen);
  keep_within(border_px_, &whole);
  const auto index = [](double position, int least, int most) {
    return static_cast<int>(
        std::clamp(position, static_cast<double>(least), static_cast<double>(most)));
  };
  RowParts parts;
  parts.seen_begin = index(std::floor(seen.begin) - 1, 0, count);
  parts.seen_end = index(std::ceil(seen.end) + 2, parts.seen_begin, count);
  parts.whole_begin = index(std::ceil(whole.begin), parts.seen_begin, parts.seen_end);
  parts.whole_end = index(std::floor(whole.end) + 1, parts.whole_begin, parts.seen_end);
  return parts;
}

void ImageFeather::ComputeRow(int x, int y, int count, uint16_t* feather) const {
  const bool is_distorted = intrinsics_.has_distortion();
  if (is_distorted) std::call_once(map_is_made_, [this] { map_.emplace(intrinsics_.distortion); });
  Maps of_piece;
  const FocalPiece* piece = nullptr;
  for (int i = 0; i < count; ++i) {
    const Vec3 e(x + i * kWeightBlock, y, 1);
    if (frame_.surface && (piece == nullptr || piece != &frame_.surface->PieceAt(e.x(), e.y()))) {
      piece = &frame_.surface->PieceAt(e.x(), e.y());
      RenderCamera camera = FocusedAsAt(frame_, e.x(), e.y());
      of_piece = MapsOf(lf_camera_, camera);
    }
    const Maps& maps = frame_.surface ? of_piece : maps_;
    feather[i] = 0;
    if (!(maps.before_lens.dot(e) > 0)) continue;
    const double side = maps.runs_forward.dot(e) < 0 ? -1 : 1;
    // This test is five times as fast as At().
    if (!is_distorted && IsInside(side * (maps.to_pixel * e)))
      feather[i] = kWholeFeather;
    else
      feather[i] =
          static_cast<uint16_t>(std::lround(kWholeFeather * At(side * (maps.to_focus * e))));
  }
}

// It suffices to test the corners of `rect`: if they pass, a projective map takes `rect` to a
// quadrilateral in the LF image, which is within any rectangle that contains its corners.
bool ImageFeather::IsWhole(const PixelRect& rect) const {
  if (intrinsics_.has_distortion()) return false;
  if (!frame_.surface) return IsWhole(rect, maps_);
  // Corners of blocks have the feather of their own piece. All pieces of the rectangle are between
  // the depths of its blocks of pieces; at both depths, the points are in a convex region.
  const Intrinsics& plate = frame_.pinhole.intrinsics;
  if (Intersection(rect, {0, 0, plate.width_px, plate.height_px}) != rect) return false;
  double q_low = INFINITY, q_high = 0;
  for (const FocalBlock& block : frame_.surface->blocks())
    if (block.elements.x_begin <= rect.x_end && block.elements.x_end >= rect.x_begin &&
        block.elements.y_begin <= rect.y_end && block.elements.y_end >= rect.y_begin) {
      q_low = std::min(q_low, block.q_low);
      q_high = std::max(q_high, block.q_high);
    }
  if (!(q_low <= q_high)) return false;
  for (const double q : {q_low, q_high}) {
    RenderCamera at_depth = frame_;
    at_depth.focus_plane = PlaneOfPiece(frame_.pinhole, {rect, {0, 0, q}});
    if (!IsWhole(rect, MapsOf(lf_camera_, at_depth))) return false;
  }
  return true;
}

bool ImageFeather::IsWhole(const PixelRect& rect, const Maps& maps) const {
  double side = 0;
  for (const int y : {rect.y_begin, rect.y_end})
    for (const int x : {rect.x_begin, rect.x_end}) {
      const Vec3 e(x, y, 1);
      const double forward = maps.runs_forward.dot(e);
      if (!(maps.before_lens.dot(e) > 0) || forward * side < 0) return false;
      side = forward < 0 ? -1 : 1;
      if (!IsInside(side * (maps.to_pixel * e))) return false;
    }
  return true;
}

// Returns the feather of a ray in the LF image.
//   direction  direction of the ray, of any length, in the axes of the LF camera
double ImageFeather::At(const Vec3& direction) const {
  const Intrinsics& k = intrinsics_;
  Vec2 distorted;
  if (map_) {
    const std::optional<Vec2> recorded = map_->Distort(direction);
    if (!recorded) return 0;
    distorted = *recorded;
  } else {
    if (!(direction.z() > 0)) return 0;
    distorted = direction.head<2>() / direction.z();
  }
  return FeatherAt(k, k.fx_px * distorted.x() + k.skew_px * distorted.y() + k.cx_px,
                   k.fy_px * distorted.y() + k.cy_px);
}

}  // namespace lf

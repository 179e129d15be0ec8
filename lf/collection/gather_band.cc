#include <algorithm>
#include <cmath>

#include "lf/camera/ideal_pixels.h"
#include "lf/collection/gather.h"
#include "lf/core/check.h"

namespace lf {
namespace {

constexpr int kChunk = 64;

}  // namespace

// Rays of consecutive elements: where they cross the LF image.
struct GatherPlan::Chunk {
  double x[kChunk];
  double y[kChunk];
  double depth[kChunk];  // homogeneous with x and y
  bool accepted[kChunk];
};

GatherPlan::GatherPlan(const PinholeCamera& lf_camera, const RenderCamera& render_camera)
    : intrinsics_(lf_camera.intrinsics) {
  if (intrinsics_.has_distortion()) {
    distortion_.emplace(intrinsics_.distortion);
    // What lies farthest from the optical axis loses its rays first.
    for (const double x : {0.5, intrinsics_.width_px - 0.5})
      for (const double y : {0.5, intrinsics_.height_px - 0.5})
        may_lack_rays_ |= !IdealPosition(intrinsics_, *distortion_, x, y);
  }
  const PinholeCamera& lens = render_camera.pinhole;
  const Vec3& n = render_camera.focus_plane.normal;
  const Vec3 offset = lf_camera.CentreWorld() - lens.CentreWorld();
  const Vec3 f = lens.ForwardWorld();
  // n.(X - c') for the points of the focus plane.
  const double distance = render_camera.focus_plane.offset_w - n.dot(lens.CentreWorld());
  plane_sign_ = distance < 0 ? -1 : 1;
  // d' = direction e with f.d' = 1;  X - c' = d' distance / n.d'
  const Mat3 direction = lens.cam_from_world.rotation.transpose() * lens.intrinsics.InverseMatrix();
  // (X - c) |n.d'|, where n.d' has the sign of `distance`
  const Mat3 to_focus =
      plane_sign_ * (distance * Mat3::Identity() - offset * n.transpose()) * direction;
  const Mat3 to_lens = offset * f.transpose() - f.dot(offset) * Mat3::Identity();
  plane_ = plane_sign_ * n.transpose() * direction;
  forward_ = f.transpose() * to_focus;
  lens_right_ = lens.RightWorld().transpose() * to_lens * to_focus;
  lens_up_ = lens.UpWorld().transpose() * to_lens * to_focus;
  Mat3 across = lf_camera.cam_from_world.rotation * to_focus;
  if (!distortion_) across = intrinsics_.Matrix() * across;
  across_x_ = across.row(0);
  across_y_ = across.row(1);
  depth_ = across.row(2);
  const Aperture& aperture = render_camera.aperture;
  radius2_w2_ = aperture.radius_w * aperture.radius_w * (1 + kRimTolerance);
  if (aperture.blades > 0) edges_ = Edges(aperture);
}

bool GatherPlan::IsInPolygon(double right, double up, double forward) const {
  return std::all_of(edges_.begin(), edges_.end(), [&](const ApertureEdge& edge) {
    return edge.normal.x() * right + edge.normal.y() * up <=
           edge.distance_w * (1 + kRimTolerance / 2) * forward;
  });
}

void GatherPlan::FindRays(int y, int x_begin, int count, Chunk* chunk) const {
  const double centre_y = y + 0.5;
  const bool is_polygon = !edges_.empty();
  for (int i = 0; i < count; ++i) {
    // From absolute element positions, so that no cut of the work changes a ray.
    const double centre_x = x_begin + i + 0.5;
    const double plane = Value(plane_, centre_x, centre_y);
    const double signed_forward = Value(forward_, centre_x, centre_y);
    const double sign = signed_forward < 0 ? -1 : 1;
    const double forward = sign * signed_forward;
    const double right = sign * Value(lens_right_, centre_x, centre_y);
    const double up = sign * Value(lens_up_, centre_x, centre_y);
    const bool in_disk = right * right + up * up <= radius2_w2_ * (forward * forward);
    chunk->x[i] = sign * Value(across_x_, centre_x, centre_y);
    chunk->y[i] = sign * Value(across_y_, centre_x, centre_y);
    chunk->depth[i] = sign * Value(depth_, centre_x, centre_y);
    chunk->accepted[i] = (plane > 0) & (forward > 0) & in_disk;
    if (is_polygon) chunk->accepted[i] = chunk->accepted[i] && IsInPolygon(right, up, forward);
  }
  if (!distortion_) {
    for (int i = 0; i < count; ++i) {
      const double scale = 1 / chunk->depth[i];
      chunk->accepted[i] &= chunk->depth[i] > 0;
      chunk->x[i] *= scale;
      chunk->y[i] *= scale;
    }
    return;
  }
  for (int i = 0; i < count; ++i) {
    if (!chunk->accepted[i]) continue;
    const std::optional<Vec2> recorded =
        distortion_->Distort({chunk->x[i], chunk->y[i], chunk->depth[i]});
    chunk->accepted[i] = recorded.has_value();
    if (!recorded) continue;
    const Intrinsics& k = intrinsics_;
    chunk->x[i] = k.fx_px * recorded->x() + k.skew_px * recorded->y() + k.cx_px;
    chunk->y[i] = k.fy_px * recorded->y() + k.cy_px;
  }
}

uint64_t GatherPlan::GatherTile(const LfPixels& pixels, TileSums* sums) const {
  sums->Reserve(1);  // at most one ray for each element
  const PixelRect& rect = sums->tile().rect();
  uint64_t accepted = 0;
  Chunk chunk;
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    TileSums::Element* const row =
        sums->elements() + static_cast<ptrdiff_t>(y - rect.y_begin) * rect.width();
    for (int x = rect.x_begin; x < rect.x_end; x += kChunk) {
      const int count = std::min(kChunk, rect.x_end - x);
      FindRays(y, x, count, &chunk);
      for (int i = 0; i < count; ++i) {
        if (!chunk.accepted[i]) continue;
        if (may_lack_rays_ && !RaysArriveAround(intrinsics_, *distortion_, chunk.x[i], chunk.y[i]))
          continue;
        const auto value = InterpolatePixels(pixels, intrinsics_.width_px, intrinsics_.height_px,
                                             chunk.x[i], chunk.y[i]);
        if (!value) continue;
        uint32_t* const element = row[x + i - rect.x_begin].rgb_rays;
        for (int channel = 0; channel < SensorPlate::kChannels; ++channel)
          element[channel] += (*value)[channel];
        element[LfPixels::kRayLane] += 1;
        ++accepted;
      }
    }
  }
  return accepted;
}

}  // namespace lf

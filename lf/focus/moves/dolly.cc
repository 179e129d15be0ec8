// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/dolly.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/focus/moves/move_coverage.h"

namespace lf {
namespace {

constexpr double kDollyDuration_s = 49 / 25.0;
constexpr double kMostOfFocus = 0.1;

// Returns the distance that the lens can move ahead, or back, so that the rays of the picture's
// borders come through LF cameras. At these rays, LF cameras are seen beside the middle of the
// lens. All of the lens must be among them. If they extend less far than the lens, as those of a
// track do upwards, they must stay within the inner half of it, where a row of them is still long.
double RoomAhead(const Shot& shot) {
  const Intrinsics& k = shot.frame;
  const auto ahead = [&](double reach_w, double f_px, double size_px) {
    const double beside_w =
        std::max(reach_w - shot.lens_radius_w, shot.lens_radius_w / 2 - reach_w);
    return beside_w * 2 * f_px / size_px;
  };
  return std::max(0.0, std::min(ahead(shot.reach.right_w, k.fx_px, k.width_px),
                                ahead(shot.reach.up_w, k.fy_px, k.height_px)));
}

}  // namespace

CameraMove MakeDolly(const LightField& light_field, const Shot& shot) {
  const Vec3 centre = shot.start.CentreWorld(), forward = shot.start.ForwardWorld();
  const MoveCoverage coverage =
      CoverageNear(light_field, shot, kMostOfFocus * shot.focus_distance_w);
  const auto unseen = [&](double ahead_w) {
    return coverage.Unseen(centre + ahead_w * forward, 1);
  };
  // Returns the longest step that LF cameras have recorded, in a direction.
  const auto recorded = [&](double wish_w, double sign) {
    for (const double scale : {1.0, 0.8, 0.6, 0.45, 0.3, 0.2, 0.1, 0.05})
      if (unseen(sign * scale * wish_w) <= kMostUnseen) return scale * wish_w;
    return 0.0;
  };
  const double calm_w = kMostOfFocus * shot.focus_distance_w, room_w = RoomAhead(shot);
  const double wish_w = std::min(calm_w, room_w);
  const double ahead_w = recorded(wish_w, 1);
  const double back_w = recorded(std::min(wish_w, calm_w - ahead_w), -1);
  const double length_w = ahead_w + back_w;
  const std::string reason =
      length_w >= (1 - 1e-9) * calm_w ? "a calm film of two seconds goes no farther"
      : length_w < (1 - 1e-9) * std::min(2 * room_w, calm_w)
          ? fmt::format("LF cameras have not recorded {:.0f} % of a frame of the longer movement",
                        100 * std::max(unseen(wish_w), unseen(-wish_w)))
          : fmt::format(
                "farther on, the rays of the picture's borders would come through too few LF "
                "cameras, which extend {:.3g} to the sides and {:.3g} up and down, while the "
                "lens is {:.3g} wide",
                shot.reach.right_w, shot.reach.up_w, 2 * shot.lens_radius_w);
  CameraMove move;
  move.keys_world = {centre - back_w * forward, centre + ahead_w * forward};
  move.duration_s = kDollyDuration_s;
  move.limit = fmt::format(
      "the camera moves {:.3g} in world units straight ahead, {:.2g} % of the focus distance: {}",
      length_w, 100 * length_w / shot.focus_distance_w, reason);
  return move;
}

}  // namespace lf

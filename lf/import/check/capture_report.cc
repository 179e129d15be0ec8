// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/capture_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "lf/camera/ideal_pixels.h"
#include "lf/import/check/capture_warnings.h"
#include "lf/import/check/nearest_distances.h"
#include "lf/light_field/model/brackets.h"
#include "lf/light_field/model/capture_geometry.h"
#include "lf/light_field/model/keep_images.h"

namespace lf {
namespace {

// Returns minimum, median and maximum of at least one value. If the number of values is even, the
// median is the lower of the two middle values.
Spread SpreadOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  return {*least, *middle, *largest};
}

// Returns the angle between the rays of two pixels: the sum of their angles to the ray of the
// pixels' midpoint, because a fish-eye may see more than 180 degrees. Pixels near the border have
// no ray if the distortion model cannot be inverted there; the angle is then measured only up to
// the last position that has a ray.
double AngleBetween(const Intrinsics& k, const Vec2& a_px, const Vec2& b_px) {
  const DistortionMap map(k.distortion);
  const Vec2 middle_px = (a_px + b_px) / 2;
  // Returns the ray of the pixel. If the pixel has no ray, returns the last ray on the way from the
  // midpoint to the pixel.
  const auto direction = [&](const Vec2& pixel) -> Vec3 {
    const auto position = [&](double share) {
      const Vec2 at = middle_px + share * (pixel - middle_px);
      return IdealPosition(k, map, at.x(), at.y());
    };
    double inside = 0, outside = 1;
    if (position(1)) inside = 1;
    while (outside - inside > 1e-12) {
      const double between = 0.5 * (inside + outside);
      (position(between) ? inside : outside) = between;
    }
    return k.InverseMatrix() * position(inside).value_or(Vec3(pixel.x(), pixel.y(), 1));
  };
  const auto angle = [](const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
  };
  const Vec3 middle = direction(middle_px);
  return angle(direction(a_px), middle) + angle(middle, direction(b_px));
}

std::vector<CameraGroup> GroupCameras(const LightField& light_field) {
  std::vector<size_t> image_counts(light_field.intrinsics.size());
  for (const LfCamera& camera : light_field.cameras) ++image_counts[camera.intrinsics_index];
  struct Members {
    size_t image_count = 0;
    // Index of each of the group's intrinsics, and number of its LF images.
    std::vector<std::pair<size_t, size_t>> intrinsics;
  };
  std::map<std::tuple<DistortionModel, int, int>, Members> members;
  for (size_t i = 0; i < image_counts.size(); ++i) {
    const Intrinsics& k = light_field.intrinsics[i];
    if (image_counts[i] == 0) continue;
    Members& group = members[{k.distortion.model, k.width_px, k.height_px}];
    group.image_count += image_counts[i];
    group.intrinsics.emplace_back(i, image_counts[i]);
  }
  std::vector<CameraGroup> groups;
  for (const auto& [key, group_members] : members) {
    CameraGroup group;
    std::tie(group.model, group.width_px, group.height_px) = key;
    group.image_count = group_members.image_count;
    group.intrinsics_count = group_members.intrinsics.size();
    const auto spread = [&, &list = group_members.intrinsics](const auto& value) {
      std::vector<double> values;
      for (const auto& [index, count] : list)
        values.insert(values.end(), count, value(light_field.intrinsics[index]));
      return SpreadOf(std::move(values));
    };
    group.fx_px = spread([](const Intrinsics& k) { return k.fx_px; });
    group.fy_px = spread([](const Intrinsics& k) { return k.fy_px; });
    group.cx_px = spread([](const Intrinsics& k) { return k.cx_px; });
    group.cy_px = spread([](const Intrinsics& k) { return k.cy_px; });
    group.horizontal_fov_rad = spread([](const Intrinsics& k) {
      return AngleBetween(k, Vec2(0, k.height_px / 2.0), Vec2(k.width_px, k.height_px / 2.0));
    });
    group.vertical_fov_rad = spread([](const Intrinsics& k) {
      return AngleBetween(k, Vec2(k.width_px / 2.0, 0), Vec2(k.width_px / 2.0, k.height_px));
    });
    groups.push_back(group);
  }
  std::stable_sort(groups.begin(), groups.end(), [](const CameraGroup& a, const CameraGroup& b) {
    return a.image_count > b.image_count;
  });
  return groups;
}

std::optional<Density> DensityOf(const CaptureReport& report, const std::vector<Vec3>& positions,
                                 const CaptureReportOptions& options) {
  if (!report.spacing_w) return std::nullopt;
  Density density;
  if (options.distance_w) {
    density.source = DistanceSource::kStated;
    density.distance_w = *options.distance_w;
  } else if (report.depth_range) {
    density.source = DistanceSource::kDepthRange;
    density.distance_w = 2 / (1 / report.depth_range->near_w + 1 / report.depth_range->far_w);
  } else if (report.meeting_point_w) {
    density.source = DistanceSource::kMeeting;
    std::vector<double> distances;
    for (const Vec3& position : positions)
      distances.push_back((position - *report.meeting_point_w).norm());
    density.distance_w = SpreadOf(std::move(distances)).median;
  }
  if (!(density.distance_w > 0)) return std::nullopt;
  density.spacing_rad = 2 * std::atan(report.spacing_w->median / 2 / density.distance_w);
  const double z = density.distance_w;
  const auto copies_px = [&](double depth_w) {
    return CopiesApart_px(report.groups[0].fx_px.median, report.spacing_w->median, z, depth_w);
  };
  density.disparity_px = copies_px(std::numeric_limits<double>::infinity());
  density.near_ghost_px = copies_px(0.75 * z);
  density.far_ghost_px = copies_px(1.25 * z);
  return density;
}

void Append(std::vector<CaptureWarning> warnings, CaptureReport* report) {
  for (CaptureWarning& warning : warnings) report->warnings.push_back(std::move(warning));
}

}  // namespace

CaptureReport ReportCapture(const LightField& light_field, const CaptureReportOptions& options,
                            ThreadPool& pool) {
  LF_CHECK(light_field.size() > 0);
  if (const size_t recorded = RecordedCount(light_field);
      recorded > 0 && recorded < light_field.size()) {
    CaptureReportOptions of_recorded = {options.distance_w};
    for (size_t i = 0; i < options.lights.size(); ++i)
      if (!light_field.cameras[i].is_virtual) of_recorded.lights.push_back(options.lights[i]);
    CaptureReport report = ReportCapture(RecordedPart(light_field), of_recorded, pool);
    report.virtual_count = light_field.size() - recorded;
    return report;
  }
  CaptureReport report;
  report.image_count = light_field.size();
  report.mask_count = static_cast<size_t>(
      std::count_if(light_field.mask_names.begin(), light_field.mask_names.end(),
                    [](const std::string& name) { return !name.empty(); }));
  report.groups = GroupCameras(light_field);
  report.depth_range = light_field.depth_range;
  report.unit_m = light_field.unit_m;
  report.alpha = light_field.encoding.alpha;
  report.background = light_field.encoding.Background();
  report.keeps_opacity = light_field.encoding.keeps_opacity;

  const std::vector<uint32_t> firsts = FirstOfPose(light_field);
  report.brackets = FindBrackets(light_field, firsts, options.lights);
  // The LF images of a bracketed pose count as one camera; only the first of them enters `ids`.
  std::vector<Vec3> positions;
  std::vector<LfImageId> ids;
  Eigen::AlignedBox3d box;
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const Vec3 position = light_field.cameras[i].cam_from_world.Inverse().translation;
    box.extend(position);
    if (report.brackets && report.brackets->of_images[i] && firsts[i] != i) continue;
    positions.push_back(position);
    ids.push_back(LfImageId{i});
  }
  report.box_min_w = box.min();
  report.box_max_w = box.max();
  report.meeting_point_w = AxesMeetingPoint(light_field);
  Append(WarnOfDirections(light_field), &report);
  Append(WarnOfUpsideDown(light_field), &report);
  if (report.brackets)
    Append(
        WarnOfBrackets(*report.brackets, light_field.encoding.masks_clipped, options.import_again),
        &report);
  if (positions.size() < 2) return report;

  const std::vector<double> nearest_w = NearestDistances(positions, pool);
  report.spacing_w = SpreadOf(nearest_w);
  Append(WarnOfRepeats(light_field, ids, nearest_w), &report);
  report.density = DensityOf(report, positions, options);
  if (report.density)
    Append(WarnOfSparseness(*report.density, report.groups[0].width_px, report.spacing_w->median),
           &report);
  return report;
}

CaptureWarning WarningAbout(const LightField& light_field, std::string kind, std::string message,
                            const std::vector<LfImageId>& ids) {
  constexpr size_t kShown = 5;
  CaptureWarning warning{std::move(kind), std::move(message), ids.size(), {}};
  for (size_t i = 0; i < std::min(kShown, ids.size()); ++i)
    warning.names.push_back(light_field.image_names[ids[i].value]);
  return warning;
}

}  // namespace lf

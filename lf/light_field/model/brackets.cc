// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/brackets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <unordered_map>

#include "lf/camera/vignetting.h"
#include "lf/core/hash.h"

namespace lf {
namespace {

// Positions count as equal up to kSamePlace of the extent of all positions, plus kRounding of the
// largest distance from the origin.
constexpr double kSamePlace = 1e-9, kRounding = 1e-14;
constexpr double kSameRotation = 1e-6;  // largest norm of the difference of two equal rotations

// Assigns points to the cells of a grid. The grid is so coarse that points within the tolerance of
// each other rarely lie in different cells.
class PlaceGrid {
 public:
  explicit PlaceGrid(double tolerance_w) : tolerance_w_(tolerance_w), cell_w_(1024 * tolerance_w) {}

  // Calls use(hash) for each cell that may contain a point within the tolerance of `point`.
  template <class Use>
  void ForEachCell(const Vec3& point, const Use& use) const {
    std::array<std::array<double, 2>, 3> ends;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double x = point[static_cast<Eigen::Index>(axis)];
      ends[axis] = {CellOf(x - tolerance_w_), CellOf(x + tolerance_w_)};
    }
    for (size_t corner = 0; corner < 8; ++corner) {
      std::array<double, 3> cell;
      bool is_new = true;
      for (size_t axis = 0; axis < 3; ++axis) {
        const size_t end = corner >> axis & 1;
        cell[axis] = ends[axis][end];
        is_new = is_new && (end == 0 || ends[axis][1] != ends[axis][0]);
      }
      if (is_new) use(Hash(cell));
    }
  }
  uint64_t CellAt(const Vec3& point) const {
    return Hash({CellOf(point.x()), CellOf(point.y()), CellOf(point.z())});
  }

 private:
  double CellOf(double x) const { return cell_w_ > 0 ? std::floor(x / cell_w_) : x; }
  // Cells are identified by hashes. If two cells have equal hashes, their points are searched
  // together.
  static uint64_t Hash(std::array<double, 3> cell) {
    for (double& x : cell) x += 0.0;  // +0 and -0 have one hash
    return HashBytes({reinterpret_cast<const char*>(cell.data()), sizeof(cell)});
  }

  double tolerance_w_;
  double cell_w_;
};

// Returns the distance, in world units, up to which two positions count as the same.
double ToleranceOf(const LightField& light_field) {
  Eigen::AlignedBox3d box;
  double reach_w = 0;
  for (const LfCamera& camera : light_field.cameras) {
    box.extend(camera.cam_from_world.Inverse().translation);
    reach_w = std::max(reach_w, camera.cam_from_world.translation.norm());
  }
  return kSamePlace * box.diagonal().norm() + kRounding * reach_w;
}

bool HaveOneView(const LightField& light_field, const LfCamera& a, const LfCamera& b) {
  return light_field.intrinsics[a.intrinsics_index] == light_field.intrinsics[b.intrinsics_index] &&
         (a.cam_from_world.rotation - b.cam_from_world.rotation).norm() <= kSameRotation;
}

// Returns, for each pose with several LF images, these images in ascending order.
std::vector<std::vector<uint32_t>> PosesWithSeveral(const LightField& light_field) {
  const std::vector<uint32_t> firsts = FirstOfPose(light_field);
  std::vector<uint32_t> counts(firsts.size(), 0);
  for (const uint32_t first : firsts) ++counts[first];
  std::vector<std::vector<uint32_t>> poses;
  std::vector<size_t> numbers(firsts.size(), 0);
  for (uint32_t i = 0; i < firsts.size(); ++i) {
    if (counts[firsts[i]] < 2) continue;
    if (firsts[i] == i) {
      numbers[i] = poses.size();
      poses.emplace_back();
    }
    poses[numbers[firsts[i]]].push_back(i);
  }
  return poses;
}

// Applies the rules of ApplyBrackets() to the LF images of one pose. Returns the number of LF
// images for which the pose has a darker LF image.
size_t ApplyToPose(std::vector<uint32_t> images, std::vector<LfCamera>* cameras) {
  const RigidTransform pose = (*cameras)[images[0]].cam_from_world;
  const auto exposure = [&](uint32_t i) { return ExposureOf((*cameras)[i]); };
  std::stable_sort(images.begin(), images.end(),
                   [&](uint32_t a, uint32_t b) { return exposure(a) < exposure(b); });
  // The images are now sorted by exposure, darkest first. Nearly equal exposures form one group.
  // Index in `images` at which each group begins; the last entry is images.size().
  std::vector<size_t> begins;
  for (size_t k = 0; k < images.size(); ++k)
    if (k == 0 || exposure(images[k]) >= kOneExposure * exposure(images[begins.back()]))
      begins.push_back(k);
  begins.push_back(images.size());
  for (size_t e = 0; e + 1 < begins.size(); ++e)
    for (size_t k = begins[e]; k < begins[e + 1]; ++k) {
      LfCamera& camera = (*cameras)[images[k]];
      camera.cam_from_world = pose;
      camera.masks_clipped = e > 0;
      if (e + 2 < begins.size()) camera.brighter = images[begins[e + 1]];
    }
  return images.size() - begins[1];
}

}  // namespace

std::vector<uint32_t> FirstOfPose(const LightField& light_field) {
  const double tolerance_w = ToleranceOf(light_field);
  const PlaceGrid grid(tolerance_w);
  // The first LF image of each pose, by CellAt() of its position.
  std::unordered_multimap<uint64_t, uint32_t> firsts;
  std::vector<uint32_t> of_images;
  std::vector<Vec3> places;
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const LfCamera& camera = light_field.cameras[i];
    places.push_back(camera.cam_from_world.Inverse().translation);
    uint32_t first = i;
    grid.ForEachCell(places[i], [&](uint64_t cell) {
      const auto [begin, end] = firsts.equal_range(cell);
      for (auto it = begin; it != end; ++it)
        if ((places[it->second] - places[i]).norm() <= tolerance_w &&
            HaveOneView(light_field, light_field.cameras[it->second], camera))
          first = std::min(first, it->second);
    });
    of_images.push_back(first);
    if (first == i) firsts.emplace(grid.CellAt(places[i]), i);
  }
  return of_images;
}

double ExposureOf(const LfCamera& camera) {
  double log_gain = 0;
  for (const float gain : camera.gain.of_channels) log_gain += std::log(double{gain});
  return std::exp(-log_gain / 3);
}

double BrightestWhite(const LightField& light_field, const RadianceEncoding& encoding) {
  const double white =
      encoding.transfer == Transfer::kResponse ? encoding.response.back() : double{1};
  double most = 1;
  for (size_t i = 0; i < light_field.size(); ++i) {
    const LfCamera& camera = light_field.cameras[i];
    const double least_share = FalloffRangeOf(light_field.intrinsics[camera.intrinsics_index]).min;
    const auto& gains = camera.gain.of_channels;
    const double brightest = white * *std::max_element(gains.begin(), gains.end()) / least_share;
    if (brightest > most && DefaultMaxRadiance({&light_field.image_names[i], 1}) == 1)
      most = brightest;
  }
  constexpr double kSteps = 100;
  return std::ceil(most * kSteps) / kSteps;
}

void MakeRoomForGains(LightField* light_field) {
  if (DefaultMaxRadiance(light_field->image_names) > 1) return;
  light_field->encoding.max_radiance = std::max(
      light_field->encoding.max_radiance, BrightestWhite(*light_field, light_field->encoding));
}

size_t ApplyBrackets(LightField* light_field) {
  for (LfCamera& camera : light_field->cameras) {
    camera.brighter = LfCamera::kNone;
    camera.masks_clipped = false;
  }
  if (!light_field->encoding.masks_clipped) return 0;
  size_t masked_count = 0;
  for (const std::vector<uint32_t>& images : PosesWithSeveral(*light_field))
    masked_count += ApplyToPose(images, &light_field->cameras);
  return masked_count;
}

}  // namespace lf

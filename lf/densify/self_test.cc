// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/self_test.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lf/core/median.h"
#include "lf/densify/depth_plane.h"
#include "lf/densify/synthesis.h"
#include "lf/densify/working_images.h"

namespace lf {
namespace {

constexpr int kTestedWidth = 200;
constexpr size_t kMostTests = 8;
constexpr int kBlendDepths = 12;

// Returns the tones of light, smoothed by two means over 3 x 3 pixels. NaN where there is no light.
Image<float> SmoothTones(const Image<uint16_t>& light, const ToneCurve& curve) {
  Image<float> tones(light.width(), light.height(), 3, NAN);
  for (int y = 0; y < light.height(); ++y)
    for (int x = 0; x < light.width(); ++x)
      for (int c = 0; c < 3 && light.at(x, y, LfPixels::kRayLane) != 0; ++c)
        tones.at(x, y, c) = curve.Tone(light.at(x, y, c));
  for (int round = 0; round < 2; ++round) {
    const Image<float> sharp = tones;
    for (int y = 1; y + 1 < tones.height(); ++y)
      for (int x = 1; x + 1 < tones.width(); ++x)
        for (int c = 0; c < 3; ++c) {
          float sum = 0;
          for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) sum += sharp.at(x + i, y + j, c);
          tones.at(x, y, c) = sum / 9;
        }
  }
  return tones;
}

double PsnrDb(const Image<float>& a, const Image<float>& b) {
  constexpr int kBorder = 4;
  double squares = 0, count = 0;
  for (int y = kBorder; y < a.height() - kBorder; ++y)
    for (int x = kBorder; x < a.width() - kBorder; ++x)
      for (int c = 0; c < 3; ++c) {
        const double error = static_cast<double>(a.at(x, y, c) - b.at(x, y, c)) / 255;
        if (std::isnan(error)) continue;
        squares += error * error;
        ++count;
      }
  if (count == 0) return 0;
  constexpr double kLeast = 1e-10;
  return -10 * std::log10(std::max(squares / count, kLeast));
}

// Returns the natural neighbours of a point among the other points; none if it is on their hull.
std::vector<WeightedPoint> NeighboursWithout(std::vector<Vec2> points, uint32_t left_out) {
  const Vec2 place = points[left_out];
  points.erase(points.begin() + left_out);
  std::vector<WeightedPoint> neighbours = NaturalNeighbours(points, place);
  for (WeightedPoint& neighbour : neighbours)
    if (neighbour.index >= left_out) ++neighbour.index;
  return neighbours;
}

// Returns the angle at which two cameras see the point at inverse depth z on the axis of the first.
double AngleDeg(const PinholeCamera& first, const PinholeCamera& second, double z) {
  const Vec3 centre = first.CentreWorld();
  const Vec3 to_point = first.cam_from_world.rotation.row(2).transpose();
  // The direction from the second camera, times z: it may be far away.
  const Vec3 from_second = to_point - z * (second.CentreWorld() - centre);
  return DegreesFromRadians(
      std::atan2(to_point.cross(from_second).norm(), to_point.dot(from_second)));
}

// Tests of one light field.
class Tester {
 public:
  Tester(const LightField& light_field, const LfImageStore& store, const DensifyPlan& plan,
         InterruptFlag interrupted)
      : light_field_(light_field),
        plan_(plan),
        divisor_(std::max(1, light_field.intrinsics.front().width_px / kTestedWidth)),
        curve_(light_field.encoding),
        images_(light_field, store, divisor_, std::numeric_limits<size_t>::max()),
        planes_(PlanesFor(plan.ShiftPx() * plan.divisor / divisor_)),
        tolerance_(
            ToleranceFor(plan.range, planes_, plan.shift_per_depth_px * plan.divisor / divisor_)),
        interrupted_(interrupted) {}

  // Tests an LF image that others surround.
  Result<LeftOut> Test(uint32_t left_out);

 private:
  // Working images and their depths.
  struct Group {
    std::vector<std::shared_ptr<const WorkingImage>> images;
    std::vector<DepthPlane> planes;
  };
  Result<Group> SweepWithout(uint32_t left_out, std::span<const uint32_t> wanted);

  const LightField& light_field_;
  const DensifyPlan& plan_;
  const int divisor_;
  const ToneCurve curve_;
  WorkingImages images_;
  const int planes_;
  const double tolerance_;
  const InterruptFlag interrupted_;
};

Result<Tester::Group> Tester::SweepWithout(uint32_t left_out, std::span<const uint32_t> wanted) {
  Group group;
  for (const uint32_t id : wanted) {
    LF_ASSIGN_OR_RETURN(auto reference, images_.Get(LfImageId{id}));
    std::vector<std::shared_ptr<const WorkingImage>> others;
    std::vector<SweepView> views;
    for (const uint32_t other : plan_.compare_with[id]) {
      if (other == left_out) continue;
      LF_ASSIGN_OR_RETURN(auto image, images_.Get(LfImageId{other}));
      views.push_back(ViewFrom(*reference, *image));
      others.push_back(std::move(image));
    }
    group.planes.push_back(SweepDepths(*reference, views, plan_.range, planes_, interrupted_));
    group.images.push_back(std::move(reference));
  }
  return group;
}

Result<LeftOut> Tester::Test(uint32_t left_out) {
  std::vector<WeightedPoint> neighbours = NeighboursWithout(plan_.plane.points, left_out);
  if (neighbours.size() > kMostSources) neighbours.resize(kMostSources);
  std::vector<uint32_t> ids;
  double sum = 0;
  for (const WeightedPoint& neighbour : neighbours) {
    ids.push_back(neighbour.index);
    sum += neighbour.weight;
  }
  LF_ASSIGN_OR_RETURN(Group group, SweepWithout(left_out, ids));
  LF_ASSIGN_OR_RETURN(const auto recorded, images_.Get(LfImageId{left_out}));
  const auto made_with = [&](const std::vector<DepthPlane>& planes) {
    std::vector<Source> sources;
    for (size_t i = 0; i < ids.size(); ++i)
      sources.push_back(
          {group.images[i].get(), &planes[i], static_cast<float>(neighbours[i].weight / sum)});
    return Synthesize(recorded->camera, sources, plan_.range, tolerance_, interrupted_).light;
  };
  const Image<float> truth = SmoothTones(recorded->light, curve_);
  LeftOut result{light_field_.image_names[left_out]};
  const double middle = (plan_.range.least + plan_.range.greatest) / 2;
  for (size_t i = 0; i < ids.size(); ++i)
    result.angle_deg +=
        neighbours[i].weight / sum * AngleDeg(recorded->camera, group.images[i]->camera, middle);
  result.virtual_psnr_db = PsnrDb(SmoothTones(made_with(group.planes), curve_), truth);
  for (int i = 0; i < kBlendDepths; ++i) {
    std::vector<DepthPlane> flat = group.planes;
    const auto number = static_cast<uint16_t>(1 + i * InverseDepths::kLast / (kBlendDepths - 1));
    for (DepthPlane& plane : flat) std::fill(plane.pixels().begin(), plane.pixels().end(), number);
    result.blend_psnr_db =
        std::max(result.blend_psnr_db, PsnrDb(SmoothTones(made_with(flat), curve_), truth));
  }
  return result;
}

}  // namespace

Result<std::vector<LeftOut>> TestByLeavingOut(const LightField& light_field,
                                              const LfImageStore& store, const DensifyPlan& plan,
                                              ThreadPool& pool, const Watch& watch) {
  std::vector<uint32_t> inner;
  for (uint32_t i = 0; i < light_field.size(); ++i)
    if (NeighboursWithout(plan.plane.points, i).size() >= 3) inner.push_back(i);
  const size_t count = std::min(kMostTests, inner.size());
  std::vector<LeftOut> tests(count);
  Tester tester(light_field, store, plan, watch.interrupted);
  LF_RETURN_IF_ERROR(ForEachWatched(pool, count, watch, [&](size_t i) -> Result<void> {
    const size_t chosen = count == 1 ? inner.size() / 2 : i * (inner.size() - 1) / (count - 1);
    LF_ASSIGN_OR_RETURN(tests[i], tester.Test(inner[chosen]));
    return {};
  }));
  return tests;
}

double MedianPsnrDb(const std::vector<LeftOut>& tests) {
  std::vector<double> psnrs;
  for (const LeftOut& test : tests) psnrs.push_back(test.virtual_psnr_db);
  return Median(std::move(psnrs));
}

double MedianGainDb(const std::vector<LeftOut>& tests) {
  std::vector<double> gains;
  for (const LeftOut& test : tests) gains.push_back(test.GainDb());
  return Median(std::move(gains));
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/self_test.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "lf/core/median.h"
#include "lf/densify/bicubic.h"
#include "lf/densify/camera_chart.h"
#include "lf/densify/camera_lattice.h"
#include "lf/densify/depth_plane.h"
#include "lf/densify/depth_sweep.h"
#include "lf/densify/synthesis.h"
#include "lf/densify/virtual_cameras.h"
#include "lf/densify/working_images.h"

namespace lf {
namespace {

// Width of the images that are compared. Those of a film may be smaller, because each film is
// tested.
constexpr int kTestedWidth = 200, kTestedWidthOfFilm = 160;
constexpr size_t kMostTests = 8;
constexpr int kBlendDepths = 12;
constexpr size_t kLeastSources = 2;
constexpr size_t kLeastAround = 3;  // LF cameras that surround another one

// Returns the tones of light, smoothed by two means over 3 x 3 pixels. NaN where pixels are masked.
// Grey is behind what is transparent, so that bright and dark outlines differ from it.
Image<float> SmoothTones(const Image<uint16_t>& light, const ToneCurve& curve) {
  Image<float> tones(light.width(), light.height(), 3, NAN);
  constexpr uint8_t kGrey = 128;
  uint16_t grey = curve.black();
  while (curve.Tone(grey) < kGrey) ++grey;
  const auto grey_light = static_cast<float>(grey - curve.black());
  for (int y = 0; y < light.height(); ++y)
    for (int x = 0; x < light.width(); ++x) {
      const uint16_t* pixel = &light.at(x, y);
      if (pixel[LfPixels::kRayLane] == 0) continue;
      const float behind = grey_light * (1 - OpacityOfLane(pixel[LfPixels::kRayLane]));
      for (int c = 0; c < 3; ++c) tones.at(x, y, c) = curve.Tone(RoundToLight(pixel[c] + behind));
    }
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

bool ShowsNothing(const Image<uint16_t>& light, int x, int y) {
  constexpr float kFaint = 0.016f;
  const uint16_t lane = light.at(x, y, LfPixels::kRayLane);
  return lane != 0 && OpacityOfLane(lane) <= kFaint;
}

// Compares smooth tones where something is to be seen in one of both images.
//   light_a, light_b  the images that they were made of
double PsnrDb(const Image<float>& a, const Image<uint16_t>& light_a, const Image<float>& b,
              const Image<uint16_t>& light_b) {
  constexpr int kBorder = 4;
  double squares = 0, count = 0;
  for (int y = kBorder; y < a.height() - kBorder; ++y)
    for (int x = kBorder; x < a.width() - kBorder; ++x) {
      if (ShowsNothing(light_a, x, y) && ShowsNothing(light_b, x, y)) continue;
      for (int c = 0; c < 3; ++c) {
        const double error = static_cast<double>(a.at(x, y, c) - b.at(x, y, c)) / 255;
        if (std::isnan(error)) continue;
        squares += error * error;
        ++count;
      }
    }
  if (count == 0) return 0;
  constexpr double kLeast = 1e-10;
  return -10 * std::log10(std::max(squares / count, kLeast));
}

// Returns the LF cameras that a chart shows, without the one that it is around, and the place of
// this one among them. Empty: there are no others.
struct Others {
  std::vector<uint32_t> ids;
  std::vector<Vec2> points;         // [ids]
  std::vector<uint32_t> forbidden;  // the left-out LF camera and those of its side; ascending
  LatticePlace at;

  // True if other LF cameras are on all sides.
  bool Surround() const { return at.neighbours.size() >= kLeastAround && at.inside == at.place; }
  // True if it is almost on the line between others.
  bool HaveBetween() const {
    constexpr double kMostBeside = 0.25;  // share of the distance to the nearest one
    if (at.neighbours.size() < 2) return false;
    double nearest = INFINITY;
    for (const Vec2& point : points) nearest = std::min(nearest, point.norm());
    return (at.inside - at.place).norm() <= kMostBeside * nearest;
  }
};
//   one_side  true: the side of the nearest one is left out, so that the rest does not surround it
Others OthersAround(const LightField& light_field, const DensifyPlan& plan, uint32_t left_out,
                    bool one_side) {
  const PinholeCamera camera = light_field.Camera(LfImageId{left_out});
  const CameraChart chart =
      ChartAround(light_field, plan.used, camera, InverseDistanceOf(camera, plan.subject));
  Vec2 towards = Vec2::Zero();
  for (size_t i = 0; i < chart.ids.size() && one_side; ++i)
    if (chart.ids[i] != left_out &&
        (towards == Vec2::Zero() || chart.points[i].norm() < towards.norm()))
      towards = chart.points[i];
  constexpr double kBeside = 0.1;  // a point straight beside the left-out one is on neither side
  Others others;
  for (size_t i = 0; i < chart.ids.size(); ++i) {
    if (chart.ids[i] == left_out ||
        (one_side && chart.points[i].dot(towards) > -kBeside * towards.squaredNorm())) {
      others.forbidden.push_back(chart.ids[i]);
      continue;
    }
    others.ids.push_back(chart.ids[i]);
    others.points.push_back(chart.points[i]);
  }
  if (!others.ids.empty()) others.at = PlaceAmong(others.points, Vec2::Zero());
  return others;
}

// Returns the sources of a virtual LF image at the place of the left-out one: numbers of
// Others::ids. Their depths can be found without LF images that are forbidden.
std::vector<WeightedPoint> SourcesOf(const Others& others, const DensifyPlan& plan) {
  std::vector<WeightedPoint> sources = others.at.neighbours;
  if (sources.size() < kLeastAround) AddNearest(others.points, Vec2::Zero(), &sources);
  std::erase_if(sources, [&](const WeightedPoint& source) {
    const std::vector<uint32_t>& compared = plan.compare_with[others.ids[source.index]];
    return std::all_of(compared.begin(), compared.end(), [&](uint32_t id) {
      return std::binary_search(others.forbidden.begin(), others.forbidden.end(), id);
    });
  });
  if (sources.size() > kMostSources) sources.resize(kMostSources);
  return sources;
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

int DivisorFor(int width_px, bool is_film) {
  return std::max(1, is_film ? (width_px + kTestedWidthOfFilm / 2) / kTestedWidthOfFilm
                             : width_px / kTestedWidth);
}

// Tests of one light field.
class Tester {
 public:
  Tester(const LightField& light_field, const LfImageStore& store, const DensifyPlan& plan,
         InterruptFlag interrupted)
      : light_field_(light_field),
        plan_(plan),
        divisor_(DivisorFor(light_field.intrinsics.front().width_px, plan.is_film)),
        curve_(light_field.encoding),
        images_(light_field, store, divisor_, std::numeric_limits<size_t>::max()),
        planes_(PlanesFor(plan.ShiftPx() * plan.divisor / divisor_)),
        tolerance_(
            ToleranceFor(plan.range, planes_, plan.shift_per_depth_px * plan.divisor / divisor_)),
        interrupted_(interrupted) {}

  // Tests an LF image that has others around it, or on one side of it that is not left out.
  Result<LeftOut> Test(uint32_t left_out, bool one_side);

 private:
  // Working images and their depths.
  struct Group {
    std::vector<std::shared_ptr<const WorkingImage>> images;
    std::vector<DepthPlane> planes;
  };
  // Sweeps some LF images. Each must have one that it is compared with and that is not forbidden.
  Result<Group> Sweep(std::span<const uint32_t> wanted, std::span<const uint32_t> forbidden);

  const LightField& light_field_;
  const DensifyPlan& plan_;
  const int divisor_;
  const ToneCurve curve_;
  WorkingImages images_;
  const int planes_;
  const double tolerance_;
  const InterruptFlag interrupted_;
};

Result<Tester::Group> Tester::Sweep(std::span<const uint32_t> wanted,
                                    std::span<const uint32_t> forbidden) {
  Group group;
  for (const uint32_t id : wanted) {
    LF_ASSIGN_OR_RETURN(auto reference, images_.Get(LfImageId{id}));
    std::vector<std::shared_ptr<const WorkingImage>> others;
    std::vector<SweepView> views;
    for (const uint32_t other : plan_.compare_with[id]) {
      if (std::binary_search(forbidden.begin(), forbidden.end(), other)) continue;
      LF_ASSIGN_OR_RETURN(auto image, images_.Get(LfImageId{other}));
      views.push_back(ViewFrom(*reference, *image));
      others.push_back(std::move(image));
    }
    group.planes.push_back(SweepDepths(*reference, views, plan_.range, planes_, interrupted_));
    group.images.push_back(std::move(reference));
  }
  return group;
}

Result<LeftOut> Tester::Test(uint32_t left_out, bool one_side) {
  const Others others = OthersAround(light_field_, plan_, left_out, one_side);
  const std::vector<WeightedPoint> neighbours = SourcesOf(others, plan_);
  std::vector<uint32_t> ids;
  double sum = 0;
  for (const WeightedPoint& neighbour : neighbours) {
    ids.push_back(others.ids[neighbour.index]);
    sum += neighbour.weight;
  }
  LF_ASSIGN_OR_RETURN(Group group, Sweep(ids, others.forbidden));
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
  result.is_beyond = one_side;
  const double middle = (plan_.range.least + plan_.range.greatest) / 2;
  for (size_t i = 0; i < ids.size(); ++i)
    result.angle_deg +=
        neighbours[i].weight / sum * AngleDeg(recorded->camera, group.images[i]->camera, middle);
  const auto psnr_db = [&](const Image<uint16_t>& made) {
    return PsnrDb(SmoothTones(made, curve_), made, truth, recorded->light);
  };
  result.virtual_psnr_db = psnr_db(made_with(group.planes));
  for (int i = 0; i < kBlendDepths; ++i) {
    std::vector<DepthPlane> flat = group.planes;
    const auto number = static_cast<uint16_t>(1 + i * InverseDepths::kLast / (kBlendDepths - 1));
    for (DepthPlane& plane : flat) std::fill(plane.pixels().begin(), plane.pixels().end(), number);
    result.blend_psnr_db = std::max(result.blend_psnr_db, psnr_db(made_with(flat)));
  }
  return result;
}

}  // namespace

Result<std::vector<LeftOut>> TestByLeavingOut(const LightField& light_field,
                                              const LfImageStore& store, const DensifyPlan& plan,
                                              ThreadPool& pool, const Watch& watch) {
  std::vector<uint32_t> inner, between, beside;
  for (const uint32_t id : plan.sources) {
    const Others others = OthersAround(light_field, plan, id, false);
    const bool has_sources = SourcesOf(others, plan).size() >= kLeastSources;
    if (others.Surround() && has_sources) inner.push_back(id);
    if (others.HaveBetween() && has_sources) between.push_back(id);
    if (IsWidened(plan) &&
        SourcesOf(OthersAround(light_field, plan, id, true), plan).size() >= kLeastSources)
      beside.push_back(id);
  }
  if (inner.size() < kMostTests / 2) inner = std::move(between);
  const size_t inside_count = std::min(kMostTests, inner.size());
  const size_t count = inside_count + std::min(kMostTests / 2, beside.size());
  std::vector<LeftOut> tests(count);
  Tester tester(light_field, store, plan, watch.interrupted);
  // Returns number i of `some` that are spread over all.
  const auto spread = [](const std::vector<uint32_t>& all, size_t i, size_t some) {
    return all[some == 1 ? all.size() / 2 : i * (all.size() - 1) / (some - 1)];
  };
  LF_RETURN_IF_ERROR(ForEachWatched(pool, count, watch, [&](size_t i) -> Result<void> {
    const bool one_side = i >= inside_count;
    const uint32_t left_out = one_side ? spread(beside, i - inside_count, count - inside_count)
                                       : spread(inner, i, inside_count);
    LF_ASSIGN_OR_RETURN(tests[i], tester.Test(left_out, one_side));
    return {};
  }));
  return tests;
}

std::vector<LeftOut> TestsOf(const std::vector<LeftOut>& tests, bool is_beyond) {
  std::vector<LeftOut> result;
  std::copy_if(tests.begin(), tests.end(), std::back_inserter(result),
               [&](const LeftOut& test) { return test.is_beyond == is_beyond; });
  return result;
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

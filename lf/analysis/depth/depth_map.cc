// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/depth_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "lf/analysis/depth/fill_depths.h"
#include "lf/analysis/depth/guided_depths.h"
#include "lf/analysis/depth/lens_views.h"
#include "lf/analysis/depth/plane_sweep.h"
#include "lf/analysis/depth/plane_votes.h"
#include "lf/analysis/depth/sharp_plate.h"
#include "lf/analysis/focus_stack/focus_planes.h"
#include "lf/core/log.h"
#include "lf/live/lens_order.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/pipeline/develop_frame.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {
namespace {

constexpr int kTileSide = 64;
constexpr size_t kLeastInLens = 12;
constexpr size_t kLeastPlanes = 8, kMostPlanes = 256;
constexpr double kStep = 0.5;  // elements that a point moves from one plane to the next
// A sweep is warned of if a point moves by more elements from one plane to the next, or by a larger
// share of the frame's width between the nearest and the farthest distance.
constexpr double kMostMovedByStep = 1, kMostMovedShare = 0.25;
// Radius of the windows in which elements of one colour are compared, in radii of the windows of
// costs: elements beside a border get its depth up to one such radius away.
constexpr int kGuideRadius = 3;
constexpr double kSweepShare = 0.9;  // share of the work, for progress

Error Interrupted() { return {ErrorKind::kInterrupted, "interrupted"}; }

Result<void> CheckOptions(const DepthMapOptions& options) {
  const DepthRange& range = options.range;
  if (!(range.near_w > 0 && range.near_w < range.far_w))
    return UsageError(fmt::format(
        "the distances to test reach from {:g} to {:g} world units: expected the nearest above 0 "
        "and below the farthest",
        range.near_w, range.far_w));
  if (options.most_views < kLeastViews || options.most_views > kMostSweptViews)
    return UsageError(fmt::format("at most {} LF images are to be compared: expected {} to {}",
                                  options.most_views, kLeastViews, kMostSweptViews));
  if (options.plane_count != 0 &&
      (options.plane_count < 2 || options.plane_count > kMostDepthPlanes))
    return UsageError(fmt::format("{} distances are to be tested: expected 2 to {}",
                                  options.plane_count, kMostDepthPlanes));
  if (options.window_radius < 0 || options.window_radius > 16)
    return UsageError(fmt::format("the window has a radius of {} elements: expected 0 to 16",
                                  options.window_radius));
  return {};
}

// Returns the LF cameras in the lens, spread evenly if there are more than `most`, and the radius
// of the lens that has them.
struct LensCameras {
  std::vector<LensCamera> cameras;
  double radius_w = 0;
  size_t before_count = 0;  // LF cameras in the lens as it is, not widened
};

LensCameras CamerasIn(const LightField& light_field, const RenderCamera& frame,
                      const DepthRange& range, size_t most) {
  const Intrinsics& plate = frame.pinhole.intrinsics;
  const double middle_w = 2 / (1 / range.near_w + 1 / range.far_w);
  const Vec3 middle = PointAt(frame, 0.5 * plate.width_px, 0.5 * plate.height_px, middle_w);
  LensCameras lens;
  std::vector<double> distances;
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    if (light_field.cameras[i].is_virtual) continue;
    const PinholeCamera camera = light_field.Camera(LfImageId{i});
    if (!((camera.cam_from_world * middle).z() > 0)) continue;
    const Vec2 point = LensPointOfLine(frame, camera.CentreWorld(), middle);
    if (!point.allFinite()) continue;
    lens.cameras.push_back({LfImageId{i}, point});
    distances.push_back(point.norm());
  }
  std::vector<double> sorted = distances;
  std::sort(sorted.begin(), sorted.end());
  lens.radius_w = frame.aperture.radius_w;
  lens.before_count = static_cast<size_t>(
      std::upper_bound(sorted.begin(), sorted.end(), lens.radius_w * (1 + kRimTolerance)) -
      sorted.begin());
  if (!sorted.empty())
    lens.radius_w = std::max(lens.radius_w, sorted[std::min(sorted.size(), kLeastInLens) - 1]);
  std::erase_if(lens.cameras, [&](const LensCamera& camera) {
    return camera.lens_point.norm() > lens.radius_w * (1 + kRimTolerance);
  });
  std::vector<Vec2> points;
  for (const LensCamera& camera : lens.cameras) points.push_back(camera.lens_point);
  std::vector<LensCamera> spread;
  for (const size_t i : FarthestPointOrder(points, most)) spread.push_back(lens.cameras[i]);
  std::sort(spread.begin(), spread.end(),
            [](const LensCamera& a, const LensCamera& b) { return a.id < b.id; });
  lens.cameras = std::move(spread);
  return lens;
}

// Returns by how many elements a point moves in the LF images at the rim of the lens from the
// nearest distance to the farthest.
double MovedBetween(const RenderCamera& frame, const DepthRange& range, double lens_radius_w) {
  return frame.pinhole.intrinsics.fx_px * lens_radius_w * (1 / range.near_w - 1 / range.far_w);
}

// Returns distances that are even in 1 / distance from near to far, and one more on either side,
// because no depth is found at the ends.
std::vector<double> PlanesOf(const DepthRange& range, size_t count) {
  const double step = (1 / range.near_w - 1 / range.far_w) / static_cast<double>(count - 1);
  std::vector<double> planes;
  for (size_t i = 0; i < count + 2; ++i) {
    const double inverse = 1 / range.near_w - step * (static_cast<double>(i) - 1);
    // Beyond infinity there is no plane: the last one is twice as far as the last but one.
    planes.push_back(inverse > 0.25 * step ? 1 / inverse : 2 * planes.back());
  }
  return planes;
}

// Returns the distance at an index with a fraction. Planes are even in 1 / distance.
double DistanceAt(const std::vector<double>& planes_w, double index) {
  const auto below = std::min(static_cast<size_t>(index), planes_w.size() - 2);
  const double t = index - static_cast<double>(below);
  return 1 / ((1 - t) / planes_w[below] + t / planes_w[below + 1]);
}

std::vector<PixelRect> TilesOf(const PixelRect& part) {
  std::vector<PixelRect> tiles;
  for (int y = part.y_begin; y < part.y_end; y += kTileSide)
    for (int x = part.x_begin; x < part.x_end; x += kTileSide)
      tiles.push_back(
          {x, y, std::min(x + kTileSide, part.x_end), std::min(y + kTileSide, part.y_end)});
  return tiles;
}

// The steps of MakeDepthMap().
class DepthMaker {
 public:
  DepthMaker(const ImageIndex& index, const LfImageStore& store, FrameId id,
             const RenderCamera& frame, const DepthMapOptions& options, const VotedDepths* voted,
             ThreadPool& pool, const std::function<void(double)>& progress)
      : light_field_(index.light_field()),
        id_(id),
        options_(options),
        voted_(voted),
        aperture_radius_w_(frame.aperture.radius_w),
        pool_(pool),
        progress_(progress),
        frame_(Pinhole(frame, options.range)),
        lens_(index.recorded(), frame_, LensWeights::kHat, SelectFor(), pool),
        in_lens_(CamerasIn(light_field_, frame, options.range, options.most_views)),
        swept_(frame.pinhole.intrinsics.width_px, frame.pinhole.intrinsics.height_px) {
    const size_t count = options.plane_count > 0
                             ? options.plane_count
                             : PlanesFor(frame, options.range, in_lens_.radius_w);
    map_.planes_w = PlanesOf(options.range, count);
    std::vector<LensCamera> cameras = in_lens_.cameras;
    for (const LfImageId near : lens_.near())
      if (lens_.Takes(near) &&
          std::none_of(cameras.begin(), cameras.end(), [&](const auto& c) { return c.id == near; }))
        cameras.push_back({near, Vec2::Zero(), false});
    views_.emplace(light_field_, store, frame_, std::move(cameras),
                   DepthRange{map_.planes_w.front(), map_.planes_w.back()}, options.window_radius,
                   options.strict);
  }

  Result<DepthMap> Make() {
    if (!voted_ && in_lens_.cameras.size() < kLeastViews)
      return InputError(fmt::format(
          "{} LF camera{} the scene through the lens: expected at least {} to compare",
          in_lens_.cameras.size(), in_lens_.cameras.size() == 1 ? " sees" : "s see", kLeastViews));
    if (!voted_) TellOfLens();
    const Intrinsics& plate = frame_.pinhole.intrinsics;
    map_.range = options_.range;
    map_.view_count = voted_ ? voted_->view_count : in_lens_.cameras.size();
    LF_ASSIGN_OR_RETURN(const std::vector<PixelRect> parts,
                        views_->CutPlate(options_.memory_bytes));
    if (voted_) {
      TakeVoted();
    } else {
      for (const PixelRect& part : parts) {
        LF_RETURN_IF_ERROR(views_->Load(part, pool_, options_.stop));
        LF_RETURN_IF_ERROR(Sweep(part));
      }
      Judge();
    }
    Fill();
    map_.sharp = SensorPlate(plate.width_px, plate.height_px);
    for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
      LF_RETURN_IF_ERROR(views_->Load(*part, pool_, options_.stop));
      LF_RETURN_IF_ERROR(Sharpen(*part));
    }
    map_.skipped = views_->skipped();
    FrameRays rays;
    rays.image_count = views_->views().size();
    map_.notes = MakePlateNotes(id_, frame_, rays, std::span(&lens_, 1), light_field_.encoding);
    return std::move(map_);
  }

 private:
  // The sharp picture is that of a pinhole. Its focus plane only decides which points of the lens
  // LF cameras beside its plane stand for.
  static RenderCamera Pinhole(const RenderCamera& frame, const DepthRange& range) {
    RenderCamera pinhole = frame;
    OpenUpTo(0, &pinhole);
    pinhole.focus_distance_w = 2 / (1 / range.near_w + 1 / range.far_w);
    pinhole.focus_tilt = {};
    pinhole.focus_plane = FocusPlane(pinhole.pinhole, pinhole.focus_distance_w, pinhole.focus_tilt);
    return pinhole;
  }
  static SelectOptions SelectFor() {
    SelectOptions select;
    select.reach = PixelReach::kNeighbours;
    return select;
  }
  bool IsStopped() const { return options_.stop != nullptr && *options_.stop; }

  // Returns by how many elements a point moves from one distance to the next in the outermost LF
  // images.
  double MovedByStep() const {
    return MovedBetween(frame_, options_.range, in_lens_.radius_w) /
           static_cast<double>(map_.planes_w.size() - 3);
  }

  size_t ElementStep() const {
    return static_cast<size_t>(std::clamp(std::ceil(1 / MovedByStep()), 1.0, 1e3));
  }

  // Says before the work what makes depths rare.
  void TellOfLens() const {
    if (in_lens_.cameras.size() > in_lens_.before_count)
      LogInfo(
          "the lens has a diameter of {:.4g} world units and {} LF camera{}: for the depths it is "
          "widened to {:.4g} world units, with {}",
          2 * aperture_radius_w_, in_lens_.before_count, in_lens_.before_count == 1 ? "" : "s",
          2 * in_lens_.radius_w, in_lens_.cameras.size());
    const double moved = MovedBetween(frame_, options_.range, in_lens_.radius_w);
    const int width = frame_.pinhole.intrinsics.width_px;
    if (moved > kMostMovedShare * width)
      LogWarning(
          "the LF cameras are far apart: between the nearest and the farthest distance a point "
          "moves by {:.0f} elements in the outermost LF images, and the frame is {} wide. LF "
          "images that differ so much seldom agree, so that few elements may have a depth: narrow "
          "the range of distances, or record the scene more densely",
          moved, width);
    if (MovedByStep() > kMostMovedByStep)
      LogWarning(
          "{} distances are tested: from one to the next a point moves by {:.1f} elements in the "
          "outermost LF images, so that depths between them are missed. Narrow the range of "
          "distances, make the frame smaller, or test more distances ({} are needed, {} are "
          "possible)",
          map_.planes_w.size() - 2, MovedByStep(), std::ceil(moved / kStep) + 1, kMostDepthPlanes);
  }

  void Tell(double share) const {
    if (progress_) progress_(share);
  }

  Result<void> Sweep(const PixelRect& part) {
    const SweepOptions sweep{map_.planes_w, options_.window_radius, ElementStep()};
    const std::vector<PixelRect> tiles = TilesOf(part);
    const auto whole = static_cast<double>(swept_.index.width()) * swept_.index.height();
    pool_.ForEach(tiles.size(), [&](size_t t) {
      if (IsStopped()) return;
      std::vector<SweptDepth> swept;
      SweepTile(views_->views(), frame_, sweep, tiles[t], &swept);
      auto depth = swept.begin();
      for (int y = tiles[t].y_begin; y < tiles[t].y_end; ++y)
        for (int x = tiles[t].x_begin; x < tiles[t].x_end; ++x, ++depth) Set(x, y, *depth);
      Tell(kSweepShare * static_cast<double>(done_ += static_cast<size_t>(tiles[t].pixel_count())) /
           whole);
    });
    if (IsStopped()) return Interrupted();
    return {};
  }

  void Set(int x, int y, const SweptDepth& depth) {
    swept_.index.at(x, y) = depth.index;
    swept_.confidence.at(x, y) = depth.confidence;
    for (int c = 0; c < 3; ++c) swept_.roots.at(x, y, c) = depth.roots[static_cast<size_t>(c)];
  }

  // Decides which of the swept depths hold.
  void Judge() {
    GuideOptions guide;
    guide.radius = kGuideRadius * std::max(1, options_.window_radius);
    guide.same_depth = 1.25f * static_cast<float>(ElementStep());
    guide.least_confidence = static_cast<float>(options_.least_confidence);
    guide.white_root =
        RootOfLight(static_cast<uint16_t>(std::clamp(light_field_.encoding.Scale(), 1.0, 65535.0)));
    DoubtLonelyDepths(guide, pool_, &swept_);
    if (options_.clean) MendDepths(guide, pool_, &swept_);
    map_.depth_w = Image<float>(swept_.index.width(), swept_.index.height(), 1,
                                std::numeric_limits<float>::quiet_NaN());
    for (int y = 0; y < swept_.index.height(); ++y)
      for (int x = 0; x < swept_.index.width(); ++x) {
        const float confidence = swept_.confidence.at(x, y);
        if (confidence >= options_.least_confidence && confidence > 0)
          map_.depth_w.at(x, y) =
              static_cast<float>(DistanceAt(map_.planes_w, swept_.index.at(x, y)));
      }
    map_.confidence = std::move(swept_.confidence);
  }

  void TakeVoted() {
    map_.planes_w.clear();
    map_.depth_w = voted_->inverse;
    map_.confidence = voted_->confidence;
    for (int y = 0; y < map_.depth_w.height(); ++y)
      for (int x = 0; x < map_.depth_w.width(); ++x) {
        float& depth = map_.depth_w.at(x, y);
        const bool is_sure = map_.confidence.at(x, y) >= options_.least_confidence;
        depth = is_sure ? 1 / depth : std::numeric_limits<float>::quiet_NaN();
      }
  }

  // Inverse distances are filled, because they are linear on planes.
  void Fill() {
    Image<float> inverse = map_.depth_w;
    for (float& depth : inverse.pixels()) {
      if (!std::isnan(depth)) ++map_.known_count;
      depth = 1 / depth;
    }
    map_.filled_w =
        FilledDepths(inverse, map_.confidence, static_cast<float>(1 / frame_.focus_distance_w));
    for (int y = 0; y < inverse.height(); ++y)
      for (int x = 0; x < inverse.width(); ++x) {
        const bool is_known = !std::isnan(map_.depth_w.at(x, y));
        map_.filled_w.at(x, y) = is_known ? map_.depth_w.at(x, y) : 1 / map_.filled_w.at(x, y);
      }
  }

  Result<void> Sharpen(const PixelRect& part) {
    pool_.ForEach(static_cast<size_t>(part.height()), [&](size_t row) {
      if (IsStopped()) return;
      AddSharpRow(views_->views(), frame_, lens_, map_.filled_w,
                  part.y_begin + static_cast<int>(row), &map_.sharp);
    });
    if (IsStopped()) return Interrupted();
    Tell(1 - (1 - kSweepShare) * part.y_begin / map_.depth_w.height());
    return {};
  }

  const LightField& light_field_;
  const FrameId id_;
  const DepthMapOptions& options_;
  const VotedDepths* const voted_;  // null: depths are found by a sweep
  const double aperture_radius_w_;
  ThreadPool& pool_;
  const std::function<void(double)>& progress_;
  const RenderCamera frame_;
  const FrameLens lens_;
  const LensCameras in_lens_;
  std::optional<LensViews> views_;
  SweptMap swept_;
  std::atomic<size_t> done_ = 0;
  DepthMap map_;
};

}  // namespace

Result<DepthRange> RangeToSweep(const LightField& light_field, const RenderCamera& camera,
                                std::optional<double> near_w, std::optional<double> far_w,
                                ThreadPool& pool) {
  constexpr double kWiderNear = 1.5, kWiderFar = 3;
  DepthRange range;
  if (!near_w || !far_w) {
    LF_ASSIGN_OR_RETURN(range, FindFocusRange(light_field, camera, pool));
    if (!light_field.depth_range) range = {range.near_w / kWiderNear, range.far_w * kWiderFar};
  }
  range = {near_w.value_or(range.near_w), far_w.value_or(range.far_w)};
  if (!(range.near_w < range.far_w))
    return UsageError(fmt::format(
        "the nearest distance is {:.6g} and the farthest {:.6g} world units: expected the nearest "
        "below the farthest",
        range.near_w, range.far_w));
  return range;
}

size_t PlanesFor(const RenderCamera& frame, const DepthRange& range, double lens_radius_w) {
  const double moved = MovedBetween(frame, range, lens_radius_w);
  return static_cast<size_t>(std::clamp(std::ceil(moved / kStep) + 1,
                                        static_cast<double>(kLeastPlanes),
                                        static_cast<double>(kMostPlanes)));
}

Result<DepthMap> MakeDepthMap(const ImageIndex& index, const LfImageStore& store, FrameId id,
                              const RenderCamera& frame, const DepthMapOptions& options,
                              ThreadPool& pool, const std::function<void(double)>& progress) {
  if (!options.from_store) {
    LF_RETURN_IF_ERROR(CheckOptions(options));
    return DepthMaker(index, store, id, frame, options, nullptr, pool, progress).Make();
  }
  LF_ASSIGN_OR_RETURN(const VotedDepths voted,
                      VoteDepths(index.light_field(), store, frame, pool, options.stop));
  DepthMapOptions of_store = options;
  of_store.range = voted.range;
  return DepthMaker(index, store, id, frame, of_store, &voted, pool, progress).Make();
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/frame_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "lf/camera/hood.h"
#include "lf/core/check.h"
#include "lf/core/random.h"
#include "lf/core/value_named.h"
#include "lf/selection/lens_weights/lens_cells.h"
#include "lf/selection/lens_weights/lens_coverage.h"
#include "lf/selection/lens_weights/transmitted_light.h"

namespace lf {
namespace {

// Approximate upper bound of how far the lens points of LF cameras move from one node of the grid
// to the next, as a share of the distance between LF cameras, unless the limits below make the grid
// coarser.
constexpr double kStepOfDistance = 1.0 / 3;
constexpr int kLeastPartNodes = 17;    // columns or rows of nodes for a part of the lens
constexpr int kMostNodes = 48;         // largest number of columns or rows of nodes
static_assert(kMostNodes <= 256);      // nodes_across_ stores them as bytes
constexpr int kLeastNodeStep_px = 32;  // elements from node to node; finer costs more than the rays
// If lens points move by less than this share of the distance between LF cameras, the LF cameras
// are in the lens plane except for rounding errors.
constexpr double kAtRest = 1e-6;

constexpr double kLeastShare = 1e-9;  // smaller shares of the lens are rounding errors

constexpr double kUnit = 256;  // value in weights_ for a weight of 1

// For one element, the intersection of each camera's ray with the lens plane, and the index of the
// camera. A camera whose ray is parallel to the lens plane is left out.
struct LensPoints {
  std::vector<Vec2> points;
  std::vector<size_t> cameras;
};

LensPoints PointsAt(const RenderCamera& frame, std::span<const Vec3> centres_world,
                    const Vec3& focus_point) {
  LensPoints seen;
  const LensPlane plane(frame);
  for (size_t i = 0; i < centres_world.size(); ++i) {
    const Vec2 point = plane.PointOfLine(centres_world[i], focus_point);
    if (!point.allFinite()) continue;
    seen.points.push_back(point);
    seen.cameras.push_back(i);
  }
  return seen;
}

// Returns the approximate distance between neighbouring points around the lens, computed from the
// density of the kCamerasAround points nearest to the lens centre, or of all points within the lens
// if these are more.
double DistanceAround(const LensPoints& seen, double radius) {
  std::vector<double> distances;
  for (const Vec2& point : seen.points) distances.push_back(point.norm());
  if (distances.empty()) return 0;
  std::sort(distances.begin(), distances.end());
  const auto within = static_cast<size_t>(
      std::upper_bound(distances.begin(), distances.end(), radius) - distances.begin());
  const size_t count = std::min(distances.size(), std::max(within, kCamerasAround));
  return std::max(radius, distances[count - 1]) * std::sqrt(kPi / static_cast<double>(count));
}

// Largest movement of the lens points of LF cameras, in world units, as the element moves from the
// left to the right edge of the plate (across), or from the upper to the lower edge (down).
struct Movement {
  double across = 0;
  double down = 0;
};

Movement MovementOf(const RenderCamera& frame, std::span<const Vec3> centres_world) {
  const Intrinsics& plate = frame.pinhole.intrinsics;
  std::optional<Vec3> focus[3][3];
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      focus[j][i] = FocusPointOfElement(frame, 0.5 * i * plate.width_px, 0.5 * j * plate.height_px);
  const LensPlane plane(frame);
  const auto moved = [&](const Vec3& centre, const std::optional<Vec3>& a,
                         const std::optional<Vec3>& b) {
    if (!a || !b) return 0.0;
    const double d = (plane.PointOfLine(centre, *a) - plane.PointOfLine(centre, *b)).norm();
    return std::isfinite(d) ? d : 0.0;
  };
  Movement most;
  const auto add = [&](const Vec3& centre) {
    for (int k = 0; k < 3; ++k) {
      most.across = std::max(most.across, moved(centre, focus[k][0], focus[k][1]) +
                                              moved(centre, focus[k][1], focus[k][2]));
      most.down = std::max(most.down, moved(centre, focus[0][k], focus[1][k]) +
                                          moved(centre, focus[1][k], focus[2][k]));
    }
  };
  for (const Vec3& centre : centres_world) add(centre);
  // The part of the lens that the hood leaves moves like the lens point of the hood's centre.
  if (frame.hood.exists())
    add(frame.pinhole.CentreWorld() + frame.hood.distance_w * frame.pinhole.ForwardWorld());
  return most;
}

int NodeCount(double movement, double distance, int size_px, int least_step_px) {
  if (!(movement > kAtRest * distance)) return 1;
  const double steps = movement / (kStepOfDistance * distance);
  const int most = std::clamp(size_px / least_step_px, 2, kMostNodes);
  return static_cast<int>(std::min(2 + steps, static_cast<double>(most)));
}

// Returns true if elements at a corner of the plate have no focus point, because the focus plane is
// tilted.
bool HasHorizon(const RenderCamera& frame) {
  const Intrinsics& plate = frame.pinhole.intrinsics;
  for (const int x : {0, plate.width_px})
    for (const int y : {0, plate.height_px})
      if (!FocusPointOfElement(frame, x, y)) return true;
  return false;
}

// Returns the share s for which the smallest shares, up to s, sum up to a tenth of the sum of all
// shares. Even very many tiny shares, such as those of cameras at almost the same position, do not
// lower it much.
double ShareOfFirstTenth(std::vector<double> shares) {
  std::sort(shares.begin(), shares.end());
  const double tenth = 0.1 * std::accumulate(shares.begin(), shares.end(), 0.0);
  double sum = 0;
  for (const double share : shares)
    if ((sum += share) >= tenth) return share;
  return 0;
}

// The opening of a lens with a hood or a transmission, for rays through a focus point: the part
// that the hood leaves, and the light that it lets through.
struct PartialLens {
  PartialLens(const RenderCamera& frame, const Vec3& focus_world)
      : opening(RimVertices(frame.aperture)) {
    const std::vector<ApertureEdge> edges = HoodOnLens(frame, focus_world);
    for (const ApertureEdge& edge : edges) opening.Clip(edge.normal, edge.distance_w);
    constexpr int kSamples = 256;
    places = OpenPlaces(frame, focus_world, kSamples);
    measure = [&frame](const ConvexPolygon& part) {
      return frame.transmission ? TransmittedLight(*frame.transmission, frame.aperture, part)
                                : part.Area();
    };
  }

  ConvexPolygon opening;
  PartMeasure measure;            // of parts of the opening
  std::vector<LensPlace> places;  // spread evenly over the opening
};

double SumOf(std::span<const LensPlace> places) {
  double sum = 0;
  for (const LensPlace& place : places) sum += place.weight;
  return sum;
}

double NodePosition(int index, int count, int size_px) {
  return count == 1 ? 0.5 * size_px : static_cast<double>(index) * size_px / (count - 1);
}

}  // namespace

const char* NameOf(LensWeights weights) {
  constexpr const char* kNames[] = {"none", "area", "hat", "auto"};
  return kNames[static_cast<int>(weights)];
}

std::optional<LensWeights> LensWeightsOf(std::string_view name) {
  return ValueNamed(
      name, {LensWeights::kNone, LensWeights::kArea, LensWeights::kHat, LensWeights::kAuto});
}

double AutoHatShare(double diameter_w, double camera_distance_w) {
  if (!(camera_distance_w > 0)) return diameter_w > 0 ? 0 : 1;
  const double distances = diameter_w / camera_distance_w;
  const double t = std::clamp((kCellsFrom - distances) / (kCellsFrom - kHatsUpTo), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double CameraDistance(const RenderCamera& frame, std::span<const Vec3> centres_world) {
  const Intrinsics& plate = frame.pinhole.intrinsics;
  const std::optional<Vec3> middle =
      FocusPointOfElement(frame, 0.5 * plate.width_px, 0.5 * plate.height_px);
  if (!middle) return 0;
  return DistanceAround(PointsAt(frame, centres_world, *middle), frame.aperture.radius_w);
}

std::vector<LensPlace> OpenPlaces(const RenderCamera& frame, const Vec3& focus_world, int count) {
  const std::vector<ApertureEdge> edges = HoodOnLens(frame, focus_world);
  const bool is_pinhole = !(frame.aperture.radius_w > 0);
  std::vector<LensPlace> places;
  for (const Vec2& place : SampleLens(frame.aperture, is_pinhole ? 1 : count)) {
    if (std::any_of(edges.begin(), edges.end(), [&](const ApertureEdge& edge) {
          return edge.normal.dot(place) > edge.distance_w;
        }))
      continue;
    const double light = frame.transmission && !is_pinhole
                             ? LightThrough(*frame.transmission, frame.aperture, place)
                             : 1;
    if (light > 0) places.push_back({place, light});
  }
  return places;
}

std::vector<Vec3> DistinctPlaces(std::span<const Vec3> centres_world) {
  std::vector<Vec3> places(centres_world.begin(), centres_world.end());
  std::sort(places.begin(), places.end(), [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  });
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

FrameWeights::FrameWeights(const RenderCamera& frame, std::span<const Vec3> centres_world,
                           LensWeights kind, ThreadPool& pool, bool are_brackets)
    : radius_w_(frame.aperture.radius_w),
      width_px_(frame.pinhole.intrinsics.width_px),
      height_px_(frame.pinhole.intrinsics.height_px),
      nodes_begin_(centres_world.size(), kNone) {
  LF_CHECK(kind != LensWeights::kNone);
  LF_CHECK(kind != LensWeights::kArea || frame.aperture.radius_w > 0);
  const double distance = are_brackets ? CameraDistance(frame, DistinctPlaces(centres_world))
                                       : CameraDistance(frame, centres_world);
  if (kind == LensWeights::kHat) hat_share_ = 1;
  if (kind == LensWeights::kAuto) hat_share_ = AutoHatShare(2 * frame.aperture.radius_w, distance);
  size_t in_opening_count = 0;
  if (const std::optional<Vec3> focus =
          FocusPointOfElement(frame, 0.5 * width_px_, 0.5 * height_px_)) {
    const std::vector<Vec2> points = PointsAt(frame, centres_world, *focus).points;
    coverage_ = CoverageOf(points, frame.aperture);
    const ApertureTest opening(frame.aperture);
    for (const Vec2& point : points) in_opening_count += opening.Contains(point) ? 1 : 0;
  }
  SetGrid(frame, centres_world, distance, in_opening_count);
  std::vector<Node> nodes(static_cast<size_t>(columns_) * rows_);
  pool.ForEach(nodes.size(), [&](size_t n) {
    nodes[n] = MakeNode(frame, centres_world, static_cast<int>(n) % columns_,
                        static_cast<int>(n) / columns_);
  });
  SetWeights(nodes);
  SetPlaces();
}

FrameWeights::FrameWeights(const RenderCamera& frame, std::span<const Vec3> centres_world,
                           const PartOfLens& part_of, ThreadPool& pool)
    : hat_share_(1),
      radius_w_(frame.aperture.radius_w),
      width_px_(frame.pinhole.intrinsics.width_px),
      height_px_(frame.pinhole.intrinsics.height_px),
      nodes_begin_(centres_world.size(), kNone) {
  // The part also changes at the borders of LF images, wherever they are on the plate.
  SetGrid(frame, centres_world, CameraDistance(frame, centres_world), 0, kLeastPartNodes);
  std::vector<Node> nodes(static_cast<size_t>(columns_) * rows_);
  parts_.assign(nodes.size(), 0);
  pool.ForEach(nodes.size(),
               [&](size_t n) { nodes[n] = MakeNodeOfPart(frame, centres_world, part_of, n); });
  SetWeights(nodes);
  SetPlaces();
}

FrameWeights::Node FrameWeights::MakeNodeOfPart(const RenderCamera& frame,
                                                std::span<const Vec3> centres_world,
                                                const PartOfLens& part_of, size_t node) {
  const double x = NodePosition(static_cast<int>(node) % columns_, columns_, width_px_);
  const double y = NodePosition(static_cast<int>(node) / columns_, rows_, height_px_);
  Node shares_of_node;
  const std::optional<Vec3> focus = FocusPointOfElement(frame, x, y);
  if (!focus) return shares_of_node;
  const LensPart part = part_of(x, y, *focus);
  const double between = SumOf(part.between), beyond = SumOf(part.beyond);
  const double sum = between + beyond;
  if (!(sum > 0)) return shares_of_node;
  parts_[node] = static_cast<float>(std::min(sum, 1.0));
  const LensPoints all = PointsAt(frame, centres_world, *focus);
  LensPoints seen;
  for (size_t k = 0; k < all.points.size(); ++k) {
    if (!part.sees[all.cameras[k]]) continue;
    seen.points.push_back(all.points[k]);
    seen.cameras.push_back(all.cameras[k]);
  }
  const std::vector<double> of_between = HatShares(seen.points, part.between);
  const std::vector<double> of_beyond = SpreadShares(seen.points, part.beyond, part.spread_w);
  for (size_t k = 0; k < seen.points.size(); ++k) {
    const double share = between * of_between[k] + beyond * of_beyond[k];
    if (share > kLeastShare)
      shares_of_node.push_back({seen.cameras[k], share, seen.points[k].norm()});
  }
  return shares_of_node;
}

double FrameWeights::PartAt(int x, int y) const {
  const auto between = [](int element, int count, int size_px) {
    const double place = count == 1 ? 0 : (element + 0.5) * (count - 1) / size_px;
    const int node = std::min(static_cast<int>(place), std::max(0, count - 2));
    return std::pair(node, place - node);
  };
  const auto [column, across] = between(x, columns_, width_px_);
  const auto [row, down] = between(y, rows_, height_px_);
  const auto at = [&, c = column, r = row](int right, int below) -> double {
    return parts_[static_cast<size_t>(std::min(r + below, rows_ - 1)) * columns_ +
                  std::min(c + right, columns_ - 1)];
  };
  const double upper = at(0, 0) + across * (at(1, 0) - at(0, 0));
  const double lower = at(0, 1) + across * (at(1, 1) - at(0, 1));
  return upper + down * (lower - upper);
}

bool FrameWeights::HasPart() const {
  return std::any_of(parts_.begin(), parts_.end(), [](float part) { return part > 0; });
}

PixelRect FrameWeights::ElementsOf(size_t camera) const {
  PixelRect bounds;
  const std::span<const uint16_t> weights = NodesOf(camera);
  // A block takes the weight of its middle for all of its elements.
  const auto reach = [](int node, int count, int size_px) {
    if (count == 1) return std::pair(0, size_px);
    const double step = static_cast<double>(size_px) / (count - 1);
    return std::pair(std::max(0, static_cast<int>((node - 1) * step) - kWeightBlock),
                     std::min(size_px, static_cast<int>((node + 1) * step) + 1 + kWeightBlock));
  };
  for (size_t n = 0; n < weights.size(); ++n) {
    if (weights[n] == 0) continue;
    const auto [left, right] = reach(static_cast<int>(n) % columns_, columns_, width_px_);
    const auto [top, bottom] = reach(static_cast<int>(n) / columns_, rows_, height_px_);
    bounds = Bounds(bounds, {left, top, right, bottom});
  }
  return bounds;
}

void FrameWeights::SetGrid(const RenderCamera& frame, std::span<const Vec3> centres_world,
                           double distance_w, size_t in_opening_count, int least_nodes) {
  const auto at_least = [least_nodes](int count, int size_px) {
    return std::max(count, std::clamp(size_px / kWeightBlock, 1, least_nodes));
  };
  columns_ = at_least(1, width_px_);
  rows_ = at_least(1, height_px_);
  const Movement movement = MovementOf(frame, centres_world);
  const auto set_step = [&] {
    if (columns_ > 1) step_w_ += movement.across / (columns_ - 1);
    if (rows_ > 1) step_w_ += movement.down / (rows_ - 1);
  };
  if (distance_w == 0) return set_step();
  // Weights have a sharp edge where the hood cuts the lens, and at edges of the transmission. They
  // move from node to node.
  const bool is_partial = frame.hood.exists() || frame.transmission;
  const int step_px = is_partial ? kWeightBlock : kLeastNodeStep_px;
  columns_ = at_least(NodeCount(movement.across, distance_w, width_px_, step_px), width_px_);
  rows_ = at_least(NodeCount(movement.down, distance_w, height_px_, step_px), height_px_);
  const size_t share_count = static_cast<size_t>(columns_) * rows_ * centres_world.size();
  if (share_count > kMostShares && hat_share_ == 0 && in_opening_count >= kManyInOpening &&
      !HasHorizon(frame)) {
    // With a hood, the opening is another one at every element; a transmission divides cells. The
    // weights state both.
    keeps_opening_ = !is_partial;
    CoarsenTo((keeps_opening_ ? kWholeCellShares : kMostShares) / centres_world.size());
  }
  set_step();
}

void FrameWeights::CoarsenTo(size_t node_count) {
  const auto coarser = [](int count) { return std::min(count, std::max(2, count * 7 / 8)); };
  while (static_cast<size_t>(columns_) * rows_ > node_count && std::max(columns_, rows_) > 2) {
    columns_ = coarser(columns_);
    rows_ = coarser(rows_);
  }
}

FrameWeights::Node FrameWeights::MakeNode(const RenderCamera& frame,
                                          std::span<const Vec3> centres_world, int column,
                                          int row) const {
  Node node;
  const std::optional<Vec3> focus = FocusPointOfElement(
      frame, NodePosition(column, columns_, width_px_), NodePosition(row, rows_, height_px_));
  if (!focus) return node;  // the node is beyond the horizon of a tilted focus plane
  const LensPoints seen = PointsAt(frame, centres_world, *focus);
  std::vector<double> shares(seen.points.size(), 0);
  const auto mix = [&](const std::vector<double>& part, double by) {
    for (size_t k = 0; k < shares.size(); ++k) shares[k] += by * part[k];
  };
  if (frame.hood.exists() || frame.transmission) {
    const PartialLens lens(frame, *focus);
    if (hat_share_ < 1)
      mix(CellShares(seen.points, lens.opening, CoveredBy(seen.points), lens.measure),
          1 - hat_share_);
    if (hat_share_ > 0) mix(HatShares(seen.points, lens.places), hat_share_);
  } else {
    if (hat_share_ < 1) {
      const CoveredRegion covered = CoveredBy(seen.points);
      mix(keeps_opening_ ? WholeCellShares(seen.points, frame.aperture, covered)
                         : CellShares(seen.points, frame.aperture, covered),
          1 - hat_share_);
    }
    if (hat_share_ > 0) mix(HatShares(seen.points, frame.aperture), hat_share_);
  }
  for (size_t k = 0; k < shares.size(); ++k) {
    if (!(shares[k] > kLeastShare)) continue;
    node.push_back({seen.cameras[k], shares[k], seen.points[k].norm()});
  }
  return node;
}

void FrameWeights::SetWeights(const std::vector<Node>& nodes) {
  std::vector<double> shares;
  double together = 0;  // largest sum of the shares of an element
  const double within_w =
      keeps_opening_ ? radius_w_ + step_w_ : std::numeric_limits<double>::infinity();
  for (const Node& node : nodes) {
    double of_node = 0;
    for (const CameraShare& share : node) {
      shares.push_back(share.share);
      if (share.distance_w <= within_w) of_node += share.share;
    }
    together = std::max(together, of_node);
  }
  if (shares.empty()) return;
  const double most = std::min(*std::max_element(shares.begin(), shares.end()),
                               kMostSmallShares * ShareOfFirstTenth(shares));
  const double scale = kUnit * std::min(kMaxWeight / most, kMostTogether / together);
  weights_per_share_ = scale / kUnit;
  int64_t sum = 0;
  size_t node_count = 0;  // number of nodes with a share
  for (size_t n = 0; n < nodes.size(); ++n) {
    node_count += nodes[n].empty() ? 0 : 1;
    for (const CameraShare& share : nodes[n]) {
      farthest_w_ = std::max(farthest_w_, share.distance_w);
      size_t& begin = nodes_begin_[share.camera];
      if (begin == kNone) {
        begin = weights_.size();
        weights_.resize(begin + nodes.size(), 0);
      }
      weights_[begin + n] = static_cast<uint16_t>(
          std::min(std::lround(share.share * scale), std::lround(kUnit * kMaxWeight)));
      if (!keeps_opening_ || share.distance_w <= radius_w_) sum += weights_[begin + n];
    }
  }
  sum_of_weights_ = static_cast<double>(sum) / (kUnit * static_cast<double>(node_count));
}

double FrameWeights::LargestWeight() const {
  return weights_.empty() ? 0 : *std::max_element(weights_.begin(), weights_.end()) / kUnit;
}

void FrameWeights::Reduce(double factor) {
  LF_CHECK(factor >= 0 && factor <= 1);
  for (uint16_t& weight : weights_) weight = static_cast<uint16_t>(std::lround(factor * weight));
  sum_of_weights_ *= factor;
  weights_per_share_ *= factor;
}

std::optional<uint8_t> FrameWeights::ConstantOf(size_t camera) const {
  if (nodes_begin_[camera] == kNone) return 0;
  const std::span<const uint16_t> weights = NodesOf(camera);
  if (std::any_of(weights.begin(), weights.end(), [&](uint16_t w) { return w != weights[0]; }))
    return {};
  return static_cast<uint8_t>(At(camera, 0, 0));
}

// A block may extend beyond any edge of the plate.
FrameWeights::Place FrameWeights::PlaceOfBlock(int end, int count, int size_px) {
  if (count == 1) return {};
  const int middle = std::clamp(end - kWeightBlock / 2, 0, size_px - 1);
  const int64_t place = int64_t{256} * middle * (count - 1) / size_px;
  return {static_cast<int>(place >> 8), static_cast<int>(place & 255)};
}

void FrameWeights::SetPlaces() {
  for (int end = 0; end <= height_px_ + kWeightBlock; ++end)
    places_down_.push_back(PlaceOfBlock(end, rows_, height_px_));
  ends_across_ = width_px_ / kWeightBlock + 2;
  for (int shift = 0; shift < kWeightBlock; ++shift) {
    const size_t begin = nodes_across_.size();
    for (int i = 0; i < ends_across_; ++i) {
      const Place place = PlaceOfBlock(i * kWeightBlock + shift, columns_, width_px_);
      nodes_across_.push_back(static_cast<uint8_t>(place.node));
      fractions_across_.push_back(static_cast<uint8_t>(place.fraction));
    }
    run_lengths_.resize(nodes_across_.size(), 1);
    for (size_t i = nodes_across_.size() - 1; i > begin; --i)
      if (nodes_across_[i - 1] == nodes_across_[i]) run_lengths_[i - 1] = run_lengths_[i] + 1;
  }
}

WeightBlocks FrameWeights::BlocksOf(size_t camera) const {
  const uint64_t any = MixBits(camera);
  return {static_cast<int>(any % kWeightBlock), static_cast<int>((any >> 32) % kWeightBlock)};
}

// Defines the weights. OfRow() computes the same weights in fewer steps.
uint32_t FrameWeights::At(size_t camera, int x, int y) const {
  if (nodes_begin_[camera] == kNone) return 0;
  const WeightBlocks blocks = BlocksOf(camera);
  const Place h = PlaceOfBlock(blocks.EndX(x), columns_, width_px_);
  const Place v = PlaceOfBlock(blocks.EndY(y), rows_, height_px_);
  uint64_t sum = 0;
  for (const int below : {0, 1})
    for (const int right : {0, 1}) {
      const auto across = static_cast<uint64_t>(right == 1 ? h.fraction : 256 - h.fraction);
      const auto down = static_cast<uint64_t>(below == 1 ? v.fraction : 256 - v.fraction);
      // With a single row or column, the second one has the fraction 0.
      const int column = std::min(h.node + right, columns_ - 1);
      const int row = std::min(v.node + below, rows_ - 1);
      sum += across * down * NodesOf(camera)[static_cast<size_t>(row) * columns_ + column];
    }
  return static_cast<uint32_t>((sum + (1 << 23)) >> 24);
}

void FrameWeights::OfRow(size_t camera, int end_x, int end_y, int count, uint8_t* weights) const {
  if (nodes_begin_[camera] == kNone) {
    std::fill_n(weights, count, uint8_t{0});
    return;
  }
  const Place v = places_down_[end_y];
  const uint16_t* const upper = &weights_[nodes_begin_[camera]] + v.node * columns_;
  const uint16_t* const lower = upper + (rows_ > 1 ? columns_ : 0);
  // Returns the weight at a column of nodes, in units of 2^-16. All numbers fit in 32 bits, because
  // weights are at most kUnit * kMaxWeight.
  const auto between_rows = [&](int node) {
    return static_cast<uint32_t>(upper[node] * (256 - v.fraction) + lower[node] * v.fraction);
  };
  const int to_right = columns_ > 1 ? 1 : 0;
  const int first = end_x % kWeightBlock * ends_across_ + end_x / kWeightBlock;
  for (int i = 0; i < count;) {
    const int node = nodes_across_[first + i], run = std::min(count - i, run_lengths_[first + i]);
    const uint32_t left = between_rows(node), change = between_rows(node + to_right) - left;
    const uint32_t rounded = 256 * left + (1 << 23);
    const uint8_t* const fractions = &fractions_across_[first + i];
    for (int k = 0; k < run; ++k)
      weights[i + k] = static_cast<uint8_t>((rounded + change * fractions[k]) >> 24);
    i += run;
  }
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// The weights of all LF cameras in one frame, for each of its elements. They are integers
// (doc/ray.md, "What is added"), and are computed before any LF image is read.
//
// The point of the lens through which an LF camera sees an element depends on the element, unless
// the LF camera is in the lens plane. Shares (lens_cells.h) are computed at the nodes of a grid
// over the plate, and interpolated between the nodes. The farther such a point moves over the lens,
// from one edge of the plate to the other, the finer the grid is.
//
// If so many LF cameras are seen through the lens that this would take more than kMostShares
// shares, whole cells are used on a grid of kWholeCellShares (WholeCellShares()). The edge of the
// opening then is the test of each ray, because a coarse grid would blur it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/parallel.h"
#include "lf/selection/lens_weights/covered_region.h"
#include "lf/selection/lens_weights/lens_cells.h"
#include "lf/selection/lens_weights/lens_coverage.h"
#include "lf/selection/lens_weights/lens_weights.h"

namespace lf {

// The version of doc/lens-integral.md. A change of the code that gives rays other weights raises
// it.
inline constexpr int kLensWeightsVersion = 5;

// AutoHatShare() returns the share of the hats in the weights of kAuto. It is 1 if the lens's
// diameter is at most kHatsUpTo camera distances, and 0 from kCellsFrom camera distances on. In
// between it changes smoothly, so that nothing jumps while an aperture opens. If the camera
// distance is 0 (unknown), it is 1 for pinholes and 0 for other lenses.
inline constexpr double kHatsUpTo = 1;
inline constexpr double kCellsFrom = 1.75;
double AutoHatShare(double diameter_w, double camera_distance_w);

// A part of the opening, as it is seen from one element. The sum of the weights of all places is
// the part's share of the lens: <= 1.
struct LensPart {
  std::vector<LensPlace> between;  // places between LF cameras
  std::vector<LensPlace> beyond;   // places beyond all LF cameras
  double spread_w = 0;             // above 0 if there are places beyond
  std::vector<bool> sees;          // [camera]: false if the LF camera does not see the element
};

class FrameWeights {
 public:
  //   centres_world  positions of the LF cameras whose LF images may contribute
  //   kind           must not be kNone
  //   are_brackets   true: when the distance between LF cameras is measured, LF cameras at the same
  //                  position count as one
  FrameWeights(const RenderCamera& frame, std::span<const Vec3> centres_world, LensWeights kind,
               ThreadPool& pool, bool are_brackets = false);

  // Makes the weights of a part of the opening, which differs from element to element: the sum of
  // its places' weights, divided among the LF cameras. Those of places between LF cameras are
  // divided by natural neighbours (HatShares()), and those of places beyond by a Gaussian with the
  // sigma spread_w (SpreadShares()).
  //   part_of  returns the part as it is seen from the position (x, y) on the plate, which has the
  //            focus point `focus_world`. Called by several threads at the same time
  using PartOfLens = std::function<LensPart(double x_px, double y_px, const Vec3& focus_world)>;
  FrameWeights(const RenderCamera& frame, std::span<const Vec3> centres_world,
               const PartOfLens& part_of, ThreadPool& pool);

  // Returns the share of the lens that the part has in an element, 0 to 1. Only for the weights of
  // a part.
  double PartAt(int x, int y) const;
  // Returns the number by which shares were multiplied to make them weights; 0 if there are none.
  double WeightsPerShare() const { return weights_per_share_; }
  // True if the part has a share in some element.
  bool HasPart() const;
  // Returns the bounds of the elements in which the LF camera may have a weight above 0.
  PixelRect ElementsOf(size_t camera) const;

  // Returns the weight of an LF camera's rays that land on an element, from 0 (they add nothing) to
  // kMaxWeight. `camera` is an index in centres_world. All elements of a block of BlocksOf(camera)
  // have the same weight. If keeps_opening() is true, rays that miss the opening must be left out
  // by the caller; their weights have no meaning.
  //
  // Weights are proportional to shares, and the largest share of the frame has kMaxWeight, with two
  // exceptions. First, shares are limited to kMostSmallShares times a small share s: the smallest
  // shares, up to s, sum up to a tenth of the sum of all shares. Second, all weights are reduced if
  // their sum in an element would exceed kMostTogether.
  uint32_t At(size_t camera, int x, int y) const;
  // Writes the weights of `count` blocks of a row. The first block ends (exclusive) at (end_x,
  // end_y).
  void OfRow(size_t camera, int end_x, int end_y, int count, uint8_t* weights) const;
  WeightBlocks BlocksOf(size_t camera) const;

  // Returns the sum of the weights of all LF cameras whose rays pass through the opening, as the
  // mean over the nodes that have any; 0 if none has.
  double SumOfWeights() const { return sum_of_weights_; }
  // Returns the largest weight at any node.
  double LargestWeight() const;
  // Multiplies all weights by a factor of at most 1, and rounds them as before. The frame stays the
  // same but for this rounding, and its weights count less beside those of other instants.
  void Reduce(double factor);

  // True if the LF camera has a share above 0 at some node.
  bool TakesPart(size_t camera) const { return nodes_begin_[camera] != kNone; }

  // Returns the weights of an LF camera at the nodes, [row][column], in 1/256, between which
  // OfRow() interpolates. Empty if the LF camera takes no part.
  std::span<const uint16_t> NodesOf(size_t camera) const {
    if (!TakesPart(camera)) return {};
    return std::span(weights_).subspan(nodes_begin_[camera], static_cast<size_t>(columns_) * rows_);
  }

  // Returns the weight of all rays of an LF camera, or nullopt if it depends on the element.
  std::optional<uint8_t> ConstantOf(size_t camera) const;

  // True if weights are those of whole cells, which are not clipped by the opening.
  bool keeps_opening() const { return keeps_opening_; }

  // Rays that meet the lens plane farther than this from the lens centre have weight 0, or miss the
  // opening.
  double reach_w() const { return keeps_opening_ ? radius_w_ : farthest_w_ + step_w_; }

  // The share of the hats in the weights: 0 for kArea, 1 for kHat.
  double hat_share() const { return hat_share_; }

  // Coverage of the lens as seen from the middle of the plate (lens_coverage.h); a default
  // LensCoverage if the middle has no focus point.
  const LensCoverage& coverage() const { return coverage_; }

  // Numbers of columns and rows of nodes. The outer ones are on the edges of the plate; a single
  // column or row is in its middle.
  int columns() const { return columns_; }
  int rows() const { return rows_; }

  static constexpr double kMostSmallShares = 32;
  // Largest sum of the weights of an element. The counts of a plate can hold eight times this sum.
  // The coarser steps of reduced weights do not matter if there are thousands of LF images in one
  // lens.
  static constexpr double kMostTogether = 2e6;
  // Whole cells are used for lenses through which at least kManyInOpening LF cameras are seen, if
  // the nodes would otherwise take more than kMostShares shares. A cell at the edge of the opening
  // then counts wholly or not at all. The error is random, about 0.3 % of the difference between
  // the light at the edge and elsewhere for 1024 LF cameras, and falls with their number to the
  // power of 3/4. A share takes half a microsecond. Errors between the nodes are smaller than this
  // one and random, so that kWholeCellShares are as good as four times as many (a mean over the
  // lens with a sharp edge in it differs by less than 2 dB).
  static constexpr size_t kManyInOpening = 1024;
  static constexpr size_t kMostShares = 4'000'000;
  static constexpr size_t kWholeCellShares = 1'000'000;

 private:
  static constexpr size_t kNone = SIZE_MAX;
  struct CameraShare {
    size_t camera;
    double share;
    double distance_w;  // distance from the lens centre to the LF camera's lens point
  };
  using Node = std::vector<CameraShare>;  // the LF cameras with a share above 0 at a node
  // Position between nodes, across or down: the index of the node to the left (or above), and the
  // distance from this node in 1/256 of the distance between nodes.
  struct Place {
    int node = 0;
    int fraction = 0;
  };

  //   in_opening_count  number of LF cameras seen through the opening from the middle of the plate
  //   least_nodes       least number of columns and rows, on a plate that is large enough
  void SetGrid(const RenderCamera& frame, std::span<const Vec3> centres_world, double distance_w,
               size_t in_opening_count, int least_nodes = 1);
  // Makes the grid coarser until it has at most this many nodes, or four.
  void CoarsenTo(size_t node_count);
  Node MakeNode(const RenderCamera& frame, std::span<const Vec3> centres_world, int column,
                int row) const;
  Node MakeNodeOfPart(const RenderCamera& frame, std::span<const Vec3> centres_world,
                      const PartOfLens& part_of, size_t node);
  void SetWeights(const std::vector<Node>& nodes);
  void SetPlaces();
  // Returns the position of the middle of a block, across or down.
  //   end      exclusive end of the block
  //   count    number of columns or rows of nodes
  //   size_px  width or height of the plate
  static Place PlaceOfBlock(int end, int count, int size_px);

  double hat_share_ = 0;
  bool keeps_opening_ = false;
  LensCoverage coverage_;
  double radius_w_;
  int width_px_;
  int height_px_;
  int columns_ = 1;
  int rows_ = 1;
  double sum_of_weights_ = 0;
  double weights_per_share_ = 0;
  double farthest_w_ = 0;            // largest CameraShare::distance_w at any node
  double step_w_ = 0;                // largest movement of lens points from one node to the next
  std::vector<size_t> nodes_begin_;  // [camera]: index of its first weight in weights_, or kNone
  std::vector<uint16_t> weights_;    // for each camera that takes part: [row][column], in 1/256
  std::vector<float> parts_;         // share of the part of the lens: [row][column]
  std::vector<Place> places_down_;   // [end_y] of a block: PlaceOfBlock()
  // PlaceOfBlock() across, [end_x % kWeightBlock][end_x / kWeightBlock]: the blocks of a row are
  // adjacent.
  int ends_across_ = 0;  // number of columns of these tables
  std::vector<uint8_t> nodes_across_;
  std::vector<uint8_t> fractions_across_;
  std::vector<int> run_lengths_;  // number of successive blocks, from this one on, at one node
};

// CameraDistance() returns the approximate distance between neighbouring LF cameras around the
// lens, in world units. It is computed from the density of the points where the rays of these LF
// cameras to the middle of the plate meet the lens plane. The density is that of the kCamerasAround
// points nearest to the lens centre, or of all points within the lens if these are more. 0 if there
// are no points, or if the middle of the plate has no focus point.
inline constexpr size_t kCamerasAround = 12;
double CameraDistance(const RenderCamera& frame, std::span<const Vec3> centres_world);

// Returns places spread evenly over the opening of the lens, for rays through a focus point: those
// that the hood leaves open, of `count` places of the whole opening, with the light that the
// transmission lets through (0 to 1) as their weights. A place without light is left out. A pinhole
// has one place.
std::vector<LensPlace> OpenPlaces(const RenderCamera& frame, const Vec3& focus_world, int count);

// Returns each position once, sorted by x, then y, then z. It is used for brackets, which have
// several LF images of one pose, so that the distance between poses does not depend on the number
// of exposures.
std::vector<Vec3> DistinctPlaces(std::span<const Vec3> centres_world);

// The lens plane of a frame.
class LensPlane {
 public:
  explicit LensPlane(const RenderCamera& frame)
      : centre_(frame.pinhole.CentreWorld()),
        forward_(frame.pinhole.ForwardWorld()),
        right_(frame.pinhole.RightWorld()),
        up_(frame.pinhole.UpWorld()) {}

  // Returns the intersection of the plane with the line through an LF camera's centre and a point,
  // in lens coordinates (doc/ray.md, Geometry 5). Not finite if the line is parallel to the plane.
  Vec2 PointOfLine(const Vec3& centre_world, const Vec3& point_world) const {
    const Vec3 along = centre_world - point_world;
    const double t = forward_.dot(centre_ - point_world) / forward_.dot(along);
    const Vec3 offset = point_world + t * along - centre_;
    return {right_.dot(offset), up_.dot(offset)};
  }

 private:
  Vec3 centre_, forward_, right_, up_;
};

// Returns the point of one line. LensPlane is faster for many.
inline Vec2 LensPointOfLine(const RenderCamera& frame, const Vec3& centre_world,
                            const Vec3& point_world) {
  return LensPlane(frame).PointOfLine(centre_world, point_world);
}

}  // namespace lf

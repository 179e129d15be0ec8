// Weights of all LF cameras in one frame, all over its plate: integers (doc/ray.md, "What is
// added"), known before an LF image is read.
//
// The point of the lens through which an LF camera sees an element depends on the element, unless
// the camera stands in the lens plane. Shares (lens_cells.h) are computed at the nodes of a grid
// over the plate, which is the finer the more these points move, and interpolated between the
// nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/parallel.h"
#include "lf/selection/lens_weights/lens_coverage.h"

namespace lf {

// How rays are weighted (doc/lens-integral.md).
//   kNone  all equally, as in the thesis
//   kArea  by cells, which need a lens area: radius_w > 0
//   kHat   by hats, for lenses as narrow as pinholes
//   kAuto  by cells, by hats, or by both if the size of the lens is in between: AutoHatShare()
enum class LensWeights { kNone, kArea, kHat, kAuto };

// The version of doc/lens-integral.md. It is raised when rays get other weights.
inline constexpr int kLensWeightsVersion = 3;

// Returns "none", "area", "hat" or "auto".
const char* NameOf(LensWeights weights);
std::optional<LensWeights> LensWeightsOf(std::string_view name);  // nullopt: another word

// Returns the part of hats in kAuto's weights: 1 up to a diameter of kHatsUpTo camera distances, 0
// from kCellsFrom on, and smooth in between, so that an aperture may open along a path.
inline constexpr double kHatsUpTo = 1;
inline constexpr double kCellsFrom = 1.75;
double AutoHatShare(double diameter_w, double camera_distance_w);

class FrameWeights {
 public:
  //   centres_world  of the LF cameras whose images may contribute
  //   kind           not kNone
  //   are_brackets   several LF cameras at one position count as one when the distance between
  //                  cameras is measured
  FrameWeights(const RenderCamera& frame, std::span<const Vec3> centres_world, LensWeights kind,
               ThreadPool& pool, bool are_brackets = false);

  // Returns the weight of a ray of the camera to an element, 0 (it adds nothing) to kMaxWeight. The
  // elements of a block of BlocksOf(camera) have the same weight.
  //
  // The largest share of the frame has kMaxWeight, with two exceptions. If it is more than
  // kMostSmallShares times a small share, it counts only as so much; the small share is the one up
  // to which the smallest shares make up a tenth of all. And all weights are reduced if they would
  // sum up to more than kMostTogether.
  uint32_t At(size_t camera, int x, int y) const;
  // Writes the weights of `count` blocks side by side, the first of which ends before (end_x,
  // end_y).
  void OfRow(size_t camera, int end_x, int end_y, int count, uint8_t* weights) const;
  WeightBlocks BlocksOf(size_t camera) const;

  // True if the camera has a share above 0 at some node.
  bool TakesPart(size_t camera) const { return nodes_begin_[camera] != kNone; }

  // True if weights are the same all over the plate.
  bool is_constant() const { return columns_ * rows_ == 1; }

  // Rays that meet the lens plane farther from the lens centre have no weight.
  double reach_w() const { return farthest_w_ + step_w_; }

  // The part of hats in the weights: 0 for kArea, 1 for kHat.
  double hat_share() const { return hat_share_; }

  // Coverage of the lens as seen from the middle of the plate (lens_coverage.h).
  const LensCoverage& coverage() const { return coverage_; }

  // Nodes of the grid, which extends from edge to edge of the plate; 1: a node in the middle.
  int columns() const { return columns_; }
  int rows() const { return rows_; }

  static constexpr double kMostSmallShares = 32;
  // Largest sum of weights that the counts of a plate can hold if rays count up to 8 times
  // (mosaics). Light fields with thousands of LF images in one lens do not need fine steps of
  // weights.
  static constexpr double kMostTogether = 2e6;

 private:
  static constexpr size_t kNone = SIZE_MAX;
  struct CameraShare {
    size_t camera;
    double share;
    double distance_w;  // of the lens point from the lens centre
  };
  using Node = std::vector<CameraShare>;  // shares above 0
  // The node before the middle of a block, and the block's distance from it, in 1/256 of the
  // distance between nodes.
  struct Place {
    int node = 0;
    int fraction = 0;
  };

  void SetGrid(const RenderCamera& frame, std::span<const Vec3> centres_world, double distance_w);
  Node MakeNode(const RenderCamera& frame, std::span<const Vec3> centres_world, int column,
                int row) const;
  void SetWeights(const std::vector<Node>& nodes);
  void SetPlaces();

  double hat_share_ = 0;
  LensCoverage coverage_;
  int width_px_;
  int height_px_;
  int columns_ = 1;
  int rows_ = 1;
  double farthest_w_ = 0;             // largest distance of a lens point with weight, at any node
  double step_w_ = 0;                 // movement of lens points from node to node
  std::vector<Place> places_across_;  // [end of the block]
  std::vector<Place> places_down_;
  std::vector<size_t> nodes_begin_;  // [camera]: index of its first weight; kNone: it has none
  std::vector<uint16_t> weights_;    // [row][column] of one camera after the other, in 1/256
};

// Returns the approximate distance between neighbouring LF cameras around the lens, measured where
// they see through it: of the kCamerasAround nearest ones, or of all within the lens if these are
// more. 0 if there is none.
inline constexpr size_t kCamerasAround = 12;
double CameraDistance(const RenderCamera& frame, std::span<const Vec3> centres_world);

// Returns each position once, in the order of coordinates. Brackets have several LF images of one
// pose, and the distance between poses does not depend on their number.
std::vector<Vec3> DistinctPlaces(std::span<const Vec3> centres_world);

// Returns the point where the line through a world point and an LF camera meets the lens plane, in
// lens coordinates (doc/ray.md, Geometry 5). Not finite if the line is parallel to the lens plane.
Vec2 LensPointOfLine(const RenderCamera& frame, const Vec3& centre_world, const Vec3& point_world);

}  // namespace lf

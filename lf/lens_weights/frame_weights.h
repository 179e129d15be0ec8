// What every LF camera counts for in one frame, all over its plate: integer weights (doc/ray.md,
// "What is added"), known before an LF image is read.
//
// Through which point of the lens an LF camera sees an element depends on the element, unless the
// camera stands in the lens plane. Shares (lens_cells.h) are found at the nodes of a grid over the
// plate, as fine as these points move, and interpolated between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/parallel.h"
#include "lf/lens_weights/lens_coverage.h"

namespace lf {

// How rays are weighed (doc/lens-integral.md).
//   kNone  alike, as in the thesis
//   kArea  by cells, which want a lens of some size: radius_w > 0
//   kHat   by hats, for lenses as narrow as pinholes
//   kAuto  by the one or the other, or by both where the lens is between them: AutoHatShare()
enum class LensWeights { kNone, kArea, kHat, kAuto };

// The version of doc/lens-integral.md: raised when rays get other weights.
inline constexpr int kLensWeightsVersion = 3;

// "none", "area", "hat", "auto"
const char* NameOf(LensWeights weights);

// What part of kAuto's weights are hats, in [0, 1]: all below kHatsUpTo camera distances of
// diameter, none above kCellsFrom, smoothly between, so that an aperture may open along a path.
inline constexpr double kHatsUpTo = 1;
inline constexpr double kCellsFrom = 1.75;
double AutoHatShare(double diameter_w, double camera_distance_w);

class FrameWeights {
 public:
  // centres_world  of the LF cameras whose images may contribute
  // kind           not kNone
  // are_brackets   several LF cameras at one place are one for the distance between cameras
  FrameWeights(const RenderCamera& frame, std::span<const Vec3> centres_world, LensWeights kind,
               ThreadPool& pool, bool are_brackets = false);

  // Of a ray of the camera's to an element, whose block is one of BlocksOf(camera): 0 (it adds
  // nothing) to kMaxWeight. The largest share of the frame has kMaxWeight, unless it is more than
  // kMostSmallShares times the small ones, those that make up a tenth of the lens: then it is taken
  // for so much; or unless all together would be more than kMostTogether.
  uint32_t At(size_t camera, int x, int y) const;
  // The same of blocks side by side, the first of which ends before (end_x, end_y).
  void OfRow(size_t camera, int end_x, int end_y, int count, uint8_t* weights) const;
  WeightBlocks BlocksOf(size_t camera) const;

  // Whether it has any but 0, on a node.
  bool TakesPart(size_t camera) const { return nodes_begin_[camera] != kNone; }

  // Whether weights are the same all over the plate.
  bool is_constant() const { return columns_ * rows_ == 1; }

  // Rays that meet the lens plane farther from the lens centre have no weight.
  double reach_w() const { return farthest_w_ + step_w_; }

  // The part of hats in it: 0 for kArea, 1 for kHat.
  double hat_share() const { return hat_share_; }

  // As seen from the middle of the plate (lens_coverage.h).
  const LensCoverage& coverage() const { return coverage_; }

  // Of the grid, from edge to edge of the plate; 1: its middle.
  int columns() const { return columns_; }
  int rows() const { return rows_; }

  static constexpr double kMostSmallShares = 32;
  // What the counts of a plate hold where rays count up to 8 times (mosaics). Light fields of
  // thousands of LF images in one lens do not need the steps.
  static constexpr double kMostTogether = 2e6;

 private:
  static constexpr size_t kNone = SIZE_MAX;
  struct Share {
    size_t camera;
    double share;
    double distance_w;  // of the lens point from the lens centre
  };
  using Node = std::vector<Share>;  // those above 0
  // Of a block: the node before its middle, and how far it is to the next one, in 1/256.
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
  double farthest_w_ = 0;             // lens point with weight, from a node
  double step_w_ = 0;                 // of lens points from node to node
  std::vector<Place> places_across_;  // by where the block ends
  std::vector<Place> places_down_;
  std::vector<size_t> nodes_begin_;  // [camera]: its part of weights_, if it has one
  std::vector<uint16_t> weights_;    // [row][column] of one camera after the other, in 1/256
};

// About how far apart the LF cameras around the lens see through it, from their centres:
// kCamerasAround of them, or all that the lens holds. 0 if there is none.
inline constexpr size_t kCamerasAround = 12;
double CameraDistance(const RenderCamera& frame, std::span<const Vec3> centres_world);

// Each place once, in an order of their coordinates: brackets have several LF images of one pose,
// and how far apart the poses are does not depend on how many.
std::vector<Vec3> DistinctPlaces(std::span<const Vec3> centres_world);

// Where the line through a world point and an LF camera meets the lens plane, in lens coordinates
// (doc/ray.md, Geometry 5). Not finite if it runs beside it.
Vec2 LensPointOfLine(const RenderCamera& frame, const Vec3& centre_world, const Vec3& point_world);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/overlap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lf/camera/ray_forms.h"
#include "lf/core/check.h"

namespace lf {
namespace {

constexpr double kLensMargin = 1e-6;
constexpr double kPlateMarginPx = 1e-6;
constexpr double kPixelMarginPx = 1e-6;    // rounding error of a vertex of the polygon
constexpr int kNeighboursPx = 2;           // number of pixels read on each side of a ray
constexpr double kBesideElement_px = 3.1;  // pixels beside an element that a prefilter reads
constexpr int kCorrectionPx = 2;       // pixels that the correction reads on each side of a pixel
constexpr double kZeroMargin = 1e-12;  // rounding error of a linear form, relative to its terms

// Returns how many pixels on each side of a ray are read for the ray.
int NeighboursOf(PixelReach reach, const PinholeCamera& lf_camera, const FrameOutline& frame) {
  if (reach == PixelReach::kOwn) return 0;
  if (reach == PixelReach::kNeighbours) return kNeighboursPx;
  LF_CHECK(frame.magnification);
  const double width_px =
      std::clamp(ElementWidth_px(lf_camera, *frame.magnification), 1., kWidestElement_px);
  const int of_prefilter = static_cast<int>(std::ceil(width_px / 2 + kBesideElement_px));
  return reach == PixelReach::kCorrectedElement ? of_prefilter + kCorrectionPx : of_prefilter;
}

// Returns the largest difference, within the LF image, between a linear form of the pixel position
// and its value in the middle of the image.
double SpreadOf(const PixelForm& form, const Intrinsics& image) {
  return 0.5 * (std::abs(form[0]) * image.width_px + std::abs(form[1]) * image.height_px);
}

double InMiddle(const PixelForm& form, const Intrinsics& image) {
  return Value(form, 0.5 * image.width_px, 0.5 * image.height_px);
}

// Returns true if a linear form of the pixel position is below 0 in the whole LF image, by more
// than the rounding error.
bool IsBelowZero(const PixelForm& form, const Intrinsics& image) {
  const double spread = SpreadOf(form, image), middle = InMiddle(form, image);
  return middle + spread < -kZeroMargin * (spread + std::abs(middle) + std::abs(form[2]));
}

// A convex polygon of pixel positions, at first the whole LF image, that is clipped by half-planes
// (Sutherland, Hodgman 1974). Each half-plane adds at most one vertex.
class Clipped {
 public:
  explicit Clipped(const Intrinsics& image) : image_(image) {
    const double w = image.width_px, h = image.height_px;
    vertices_ = {Vec2(0, 0), Vec2(w, 0), Vec2(w, h), Vec2(0, h)};
    count_ = 4;
  }
  Clipped(const Clipped&) = delete;
  Clipped& operator=(const Clipped&) = delete;

  bool empty() const { return count_ == 0; }

  // Keeps the part of the polygon with form <= 0.
  void Clip(const PixelForm& form) {
    // These tests are quick, and enough for almost all half-planes, which contain either the whole
    // LF image or nothing of it.
    if (IsBelowZero(form, image_)) return;
    if (IsBelowZero(-form, image_)) {
      count_ = 0;
      return;
    }
    std::array<double, kCapacity> values;
    bool any_beyond = false;
    for (size_t i = 0; i < count_; ++i) {
      values[i] = ValueOrZero(form, vertices_[i]);
      any_beyond |= values[i] > 0;
    }
    if (!any_beyond) return;
    std::array<Vec2, kCapacity>& kept = spare_;
    size_t kept_count = 0;
    for (size_t i = 0; i < count_; ++i) {
      LF_CHECK(kept_count + 2 <= kCapacity);
      const size_t next = i + 1 < count_ ? i + 1 : 0;
      const Vec2& a = vertices_[i];
      const Vec2& b = vertices_[next];
      const double value_a = values[i], value_b = values[next];
      if (value_a <= 0) kept[kept_count++] = a;
      if ((value_a < 0 && value_b > 0) || (value_a > 0 && value_b < 0))
        kept[kept_count++] = a + (b - a) * (value_a / (value_a - value_b));
    }
    std::copy_n(kept.begin(), kept_count, vertices_.begin());
    count_ = kept_count;
  }

  // Returns the bounds of the pixels whose centres are in the polygon's bounding box, extended by
  // `beyond` pixels on each side and clipped to the image.
  PixelRect Pixels(const Intrinsics& image, int beyond) const {
    if (empty()) return {};
    Vec2 low = vertices_[0], high = vertices_[0];
    for (size_t i = 1; i < count_; ++i) {
      low = low.cwiseMin(vertices_[i]);
      high = high.cwiseMax(vertices_[i]);
    }
    const auto first = [](double v) {
      return static_cast<int>(std::ceil(v - 0.5 - kPixelMarginPx));
    };
    const auto last = [](double v) {
      return static_cast<int>(std::floor(v - 0.5 + kPixelMarginPx));
    };
    return Intersection({0, 0, image.width_px, image.height_px},
                        {first(low.x()) - beyond, first(low.y()) - beyond,
                         last(high.x()) + 1 + beyond, last(high.y()) + 1 + beyond});
  }

 private:
  // Enough for the 4 corners, and one vertex for each of 7 + blades half-planes, for up to 64
  // blades. A lens with more blades is clipped by the 16 edges of a disk (FrameOutline).
  static constexpr size_t kCapacity = 96;

  static double ValueOrZero(const PixelForm& form, const Vec2& p) {
    const double value = Value(form, p.x(), p.y());
    const double magnitude =
        std::abs(form[0] * p.x()) + std::abs(form[1] * p.y()) + std::abs(form[2]);
    return std::abs(value) <= kZeroMargin * magnitude ? 0 : value;
  }

  const Intrinsics& image_;
  std::array<Vec2, kCapacity> vertices_;
  std::array<Vec2, kCapacity> spare_;
  size_t count_ = 0;
};

// Returns true if all rays of the LF image pass through the circle of radius inner_w around the
// lens centre. It suffices to test the corners of the image, because the circle is convex and a
// projective map takes image positions to the points where their rays meet the lens plane.
bool LensHolds(const RayForms& forms, double inner_w, const Intrinsics& image) {
  const double w = image.width_px, h = image.height_px;
  for (const Vec2& corner : {Vec2(0, 0), Vec2(w, 0), Vec2(w, h), Vec2(0, h)}) {
    const double forward = Value(forms.forward, corner.x(), corner.y());
    const double right = Value(forms.lens_right, corner.x(), corner.y());
    const double up = Value(forms.lens_up, corner.x(), corner.y());
    const double reach = inner_w * forward;
    if (!(forward > 0 && right * right + up * up <= reach * reach)) return false;
  }
  return true;
}

PixelRect ClippedRect(const Intrinsics& image, std::span<const PixelForm> plate,
                      const RayForms& forms, const FrameOutline& frame, int beyond) {
  Clipped region(image);
  for (const PixelForm& form : plate) {
    region.Clip(form);
    if (region.empty()) return {};
  }
  // Skips clipping by the edges of the lens (16 for a disk) if the lens contains all rays of the LF
  // image, as it does for most LF cameras in a wide lens.
  if (LensHolds(forms, frame.lens_inner_w, image)) return region.Pixels(image, beyond);
  const double margin_w = kLensMargin * frame.camera.aperture.radius_w;
  for (const ApertureEdge& edge : frame.lens_edges) {
    region.Clip(LensHalfPlane(forms, edge, margin_w));
    if (region.empty()) return {};
  }
  return region.Pixels(image, beyond);
}

// Returns true if the half-plane form <= 0 contains no point of the cell's box.
bool Excludes(const PixelForm& form, const IdealCell& cell) {
  return Value(form, cell.middle) > form.cwiseAbs().dot(cell.extent.transpose());
}

// Returns half-planes of the LF pixels whose rays can pass through the points that the elements of
// a block see between the depths of their pieces. The points are in the convex hull of eight
// corners; the LF image of this hull is within the bounds of the corners, if all of these are on
// one side of the LF camera.
std::vector<PixelForm> BlockHalfPlanes(const PinholeCamera& lf_camera, const RenderCamera& frame,
                                       const FocalBlock& block, const RayForms& forms) {
  constexpr double kRounding = 1e-9, kMargin_px = 1e-3;
  std::vector<PixelForm> half_planes = {-forms.forward};
  const Mat3 pixel = lf_camera.intrinsics.Matrix() * lf_camera.cam_from_world.rotation;
  const Vec3 centre = lf_camera.CentreWorld();
  Vec2 low = Vec2::Constant(INFINITY), high = -low;
  int in_front = 0;
  for (const int y : {block.elements.y_begin, block.elements.y_end})
    for (const int x : {block.elements.x_begin, block.elements.x_end}) {
      const Ray ray = RayOfPixel(frame.pinhole, x, y);
      for (const double q : {block.q_low * (1 - kRounding), block.q_high * (1 + kRounding)}) {
        const Vec3 point = ray.At(1 / q);
        const Vec3 p = pixel * (point - centre);
        if (!(std::abs(p.z()) > 1e-6 * (point - centre).norm())) return half_planes;
        // A fish-eye may record a ray at more than 90 degrees, whose ideal position is behind it.
        if (lf_camera.intrinsics.has_distortion() &&
            !(p.z() > 0 && frame.pinhole.ForwardWorld().dot(point - centre) > 0))
          return half_planes;
        in_front += p.z() > 0 ? 1 : 0;
        const Vec2 at(p.x() / p.z(), p.y() / p.z());
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
      }
    }
  if (in_front != 0 && in_front != 8) return half_planes;
  // Positions beyond 1e8 px are beyond every image, and could lose the digits of the margin.
  low = low.cwiseMax(-1e8) - Vec2::Constant(kMargin_px);
  high = high.cwiseMin(1e8) + Vec2::Constant(kMargin_px);
  half_planes.insert(half_planes.end(),
                     {PixelForm(0, 0, -1), PixelForm(-1, 0, low.x()), PixelForm(1, 0, -high.x()),
                      PixelForm(0, -1, low.y()), PixelForm(0, 1, -high.y())});
  return half_planes;
}

PixelRect BoundsOfCells(std::span<const IdealCell> cells, std::span<const PixelForm> plate,
                        std::span<const PixelForm> lens) {
  PixelRect rect;
  for (const IdealCell& cell : cells) {
    const auto excludes = [&](const PixelForm& form) { return Excludes(form, cell); };
    if (cell.has_bounds && (std::any_of(plate.begin(), plate.end(), excludes) ||
                            std::any_of(lens.begin(), lens.end(), excludes)))
      continue;
    rect = Bounds(rect, cell.rect);
  }
  return rect;
}

// Returns a cell whose box contains the ideal positions of all pixels of the LF image. has_bounds
// is false if one of `cells` has no bounds.
IdealCell BoundImage(const Intrinsics& image, std::span<const IdealCell> cells) {
  IdealCell whole;
  if (!image.has_distortion()) {
    whole.middle = {0.5 * image.width_px, 0.5 * image.height_px, 1};
    whole.extent = {0.5 * image.width_px, 0.5 * image.height_px, 0};
    whole.has_bounds = true;
    return whole;
  }
  whole.has_bounds = std::all_of(cells.begin(), cells.end(),
                                 [](const IdealCell& cell) { return cell.has_bounds; });
  if (!whole.has_bounds) return whole;
  Vec3 low = cells[0].middle - cells[0].extent, high = cells[0].middle + cells[0].extent;
  for (const IdealCell& cell : cells) {
    low = low.cwiseMin(cell.middle - cell.extent);
    high = high.cwiseMax(cell.middle + cell.extent);
  }
  whole.middle = 0.5 * (low + high);
  whole.extent = 0.5 * (high - low);
  return whole;
}

}  // namespace

PixelRect ContributingRect(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                           std::span<const IdealCell> cells, PixelReach reach) {
  return ImageOverlap(lf_camera, cells, reach).Rect(render_camera);
}

ImageOverlap::ImageOverlap(const PinholeCamera& lf_camera, std::span<const IdealCell> cells,
                           PixelReach reach)
    : lf_camera_(lf_camera), cells_(cells), reach_(reach), centre_world_(lf_camera.CentreWorld()) {
  LF_CHECK(!lf_camera.intrinsics.has_distortion() || !cells.empty());
  const IdealCell box = BoundImage(lf_camera.intrinsics, cells);
  direction_world_ =
      lf_camera.cam_from_world.rotation.transpose() * lf_camera.intrinsics.InverseMatrix();
  has_bounds_ = box.has_bounds;
  if (!has_bounds_) return;
  middle_world_ = direction_world_ * box.middle;
  axes_world_ = direction_world_ * box.extent.asDiagonal();
}

// A ray of direction d meets the lens plane at M d / (f.d) (doc/ray.md, 5), where f is the render
// camera's forward direction and the matrix M is constant. The separating line is normal to the
// direction from the lens centre to the point where the ray of direction middle_world_ meets the
// lens plane. It touches a circle that contains every polygon by which Rect() clips, so that
// PlainlyMisses() never contradicts Rect().
bool ImageOverlap::PlainlyMisses(const RenderCamera& render_camera) const {
  if (!has_bounds_) return false;
  constexpr double kRounding = 1e-9;
  constexpr double kLensGrowth = (1 + 4 * kLensMargin) * kDiskPolygonRadius;
  const Vec3 f = render_camera.pinhole.ForwardWorld();
  const auto spread = [this](const Vec3& form) {
    return (form.transpose() * axes_world_).cwiseAbs().sum();
  };
  const double length = middle_world_.lpNorm<1>() + axes_world_.lpNorm<1>();
  const double forward = f.dot(middle_world_);
  if (forward + spread(f) < -kRounding * length) return true;
  if (forward <= 0) return false;

  const Vec3 offset = centre_world_ - render_camera.pinhole.CentreWorld();
  const double depth = f.dot(offset);
  const Vec3 middle_on_lens = offset * forward - depth * middle_world_;
  const double distance = middle_on_lens.norm();
  if (!(distance > 0)) return false;
  const Vec3 outwards = middle_on_lens / distance;
  const double radius_w = kLensGrowth * render_camera.aperture.radius_w;
  const Vec3 beyond = (outwards.dot(offset) - radius_w) * f - depth * outwards;
  return beyond.dot(middle_world_) - spread(beyond) >
         kRounding * length * (offset.lpNorm<1>() + radius_w);
}

FrameOutline::FrameOutline(const RenderCamera& render_camera, PixelReach reach)
    : camera(render_camera) {
  if (DependsOnElement(reach)) magnification.emplace(render_camera);
  // A lens with very many blades is treated as a disk, whose 16-gon contains it.
  constexpr int kMostBlades = 64;
  if (camera.aperture.blades > kMostBlades) camera.aperture = {camera.aperture.radius_w, 0, 0};
  lens_edges = Edges(camera.aperture);
  lens_inner_w = camera.aperture.radius_w;
  for (const ApertureEdge& edge : lens_edges)
    lens_inner_w = std::min(lens_inner_w, edge.distance_w);
}

PixelRect ImageOverlap::Rect(const FrameOutline& frame) const {
  if (PlainlyMisses(frame.camera)) return {};
  const Intrinsics& image = lf_camera_.intrinsics;
  const bool distorted = image.has_distortion();
  const RayForms forms = MakeRayForms(direction_world_, centre_world_, frame.camera);
  const int beyond = NeighboursOf(reach_, lf_camera_, frame);
  std::vector<PixelForm> lens;
  if (distorted) lens = LensHalfPlanes(forms, frame.camera, kLensMargin);
  PixelRect rect;
  const auto add = [&](std::span<const PixelForm> plate) {
    rect = Bounds(rect, distorted ? BoundsOfCells(cells_, plate, lens)
                                  : ClippedRect(image, plate, forms, frame, beyond));
  };
  if (frame.camera.surface)
    for (const FocalBlock& block : frame.camera.surface->blocks())
      add(BlockHalfPlanes(lf_camera_, frame.camera, block, forms));
  for (const int plane_sign : {-1, 1}) {
    if (frame.camera.surface) break;
    if (!distorted && IsBelowZero(plane_sign * forms.plane, image)) continue;
    add(PlateHalfPlanes(forms, frame.camera, plane_sign, kPlateMarginPx));
  }
  // ClippedRect() has added the neighbours on each side of a ray. BoundsOfCells() has not, and they
  // may lie beyond its rectangle.
  if (!distorted || rect.empty()) return rect;
  return Intersection(
      {0, 0, image.width_px, image.height_px},
      {rect.x_begin - beyond, rect.y_begin - beyond, rect.x_end + beyond, rect.y_end + beyond});
}

}  // namespace lf

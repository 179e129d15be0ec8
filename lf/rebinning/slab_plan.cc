// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/slab_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lf {
namespace {

constexpr double kMostTurn_rad = RadiansFromDegrees(30);
constexpr double kMostCoarser = 1.5;  // largest acceptable width of a cell, in wanted widths
constexpr double kStPerDistance = 0.25, kLeastStPerDistance = 1.0 / 256;
constexpr double kUvPerPixel = 0.25, kUvPerElement = 0.125;

// Visits the focus points of 5 x 5 positions, which are spread over the plate and up to one reach
// beyond its edges.
template <class Visit>
void ForEachPlace(const FrameQueries& frame, const Visit& visit) {
  constexpr int kSteps = 4;
  const Intrinsics& plate = frame.camera.pinhole.intrinsics;
  const double margin_px = ReachOf(frame.kernel, frame.points).plate_px;
  for (int row = 0; row <= kSteps; ++row)
    for (int column = 0; column <= kSteps; ++column) {
      const std::optional<Vec3> focus = FocusPointOfElement(
          frame.camera, -margin_px + (plate.width_px + 2 * margin_px) * column / kSteps,
          -margin_px + (plate.height_px + 2 * margin_px) * row / kSteps);
      if (focus) visit(*focus);
    }
}

class SectionPlanner {
 public:
  SectionPlanner(std::span<const FrameQueries> frames, const SlabChoices& choices)
      : frames_(frames), choices_(choices) {}

  void Plan(size_t begin, size_t end, std::vector<SlabSection>* sections) const {
    SlabSection section;
    section.begin = begin;
    section.end = end;
    const bool fits = Place(&section) && SetBounds(&section) && SetWidths(&section);
    if (fits || end - begin == 1) {
      sections->push_back(section);
      return;
    }
    const size_t middle = begin + (end - begin) / 2;
    Plan(begin, middle, sections);
    Plan(middle, end, sections);
  }

 private:
  // Places the planes. Returns true if all frames look in about the direction that the planes face.
  bool Place(SlabSection* section) const {
    Vec3 forward = Vec3::Zero(), up = Vec3::Zero(), position = Vec3::Zero();
    for (size_t f = section->begin; f < section->end; ++f) {
      const PinholeCamera& camera = frames_[f].camera.pinhole;
      forward += camera.ForwardWorld();
      up += camera.UpWorld();
      position += camera.CentreWorld() / static_cast<double>(section->end - section->begin);
    }
    forward = choices_.forward_world.value_or(forward);
    position = choices_.position_world.value_or(position);
    const std::optional<RigidTransform> pose = LookAlong(position, forward, up);
    if (!pose) {
      // There is no mean direction or no mean `up`, because those of the frames are opposite. A
      // single frame always has a pose: callers test SlabChoices::forward_world against its view.
      section->slab.st.origin_world = position;
      return false;
    }
    const PinholeCamera facing{{}, *pose};
    const Vec3 normal = facing.ForwardWorld();
    Slab& slab = section->slab;
    slab.st = slab.uv = {position, facing.RightWorld(), -facing.UpWorld()};
    slab.uv.origin_world += FocusDistance(*section, position, normal) * normal;
    bool all_look_along = true;
    for (size_t f = section->begin; f < section->end; ++f)
      all_look_along = all_look_along && frames_[f].camera.pinhole.ForwardWorld().dot(normal) >=
                                             std::cos(kMostTurn_rad);
    return all_look_along;
  }

  // Returns the distance of the uv plane from the st plane: half-way in disparity between the
  // nearest and the farthest focus distance along the normal.
  double FocusDistance(const SlabSection& section, const Vec3& position, const Vec3& normal) const {
    if (choices_.uv_distance_w) return *choices_.uv_distance_w;
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (size_t f = section.begin; f < section.end; ++f) {
      const PinholeCamera& camera = frames_[f].camera.pinhole;
      const Intrinsics& k = camera.intrinsics;
      const std::optional<Vec3> focus =
          FocusPointOfElement(frames_[f].camera, 0.5 * k.width_px, 0.5 * k.height_px);
      const double distance =
          focus ? normal.dot(*focus - position) : frames_[f].camera.focus_distance_w;
      if (!(distance > 0)) continue;
      least = std::min(least, distance);
      most = std::max(most, distance);
    }
    if (most == 0) return frames_[section.begin].camera.focus_distance_w;
    return 2 / (1 / least + 1 / most);
  }

  // Sets the bounds, and moves the planes' origins to the middle of the bounds. Returns true if all
  // rays cut both planes.
  bool SetBounds(SlabSection* section) const {
    bool all_cut = true;
    const std::optional<SlabBounds> bounds = BoundsOf(
        section->slab, frames_.subspan(section->begin, section->end - section->begin), &all_cut);
    section->bounds = {};
    if (!bounds) return false;
    const SlabPoint middle = (bounds->low + bounds->high) / 2;
    for (int plane = 0; plane < 2; ++plane) {
      SlabPlane& to_move = plane == 0 ? section->slab.st : section->slab.uv;
      to_move.origin_world +=
          middle[2 * plane] * to_move.axis_a + middle[2 * plane + 1] * to_move.axis_b;
    }
    section->bounds = {bounds->low - middle, bounds->high - middle};
    return all_cut;
  }

  // Sets the widths of the cells. Returns true if keys have room for cells about as narrow as
  // wanted.
  bool SetWidths(SlabSection* section) const {
    Slab& slab = section->slab;
    const Vec3 normal = slab.st.Normal();
    const double distance = normal.dot(slab.uv.origin_world - slab.st.origin_world);
    double st = std::numeric_limits<double>::infinity(), lf_pixel = st, element = st;
    for (size_t f = section->begin; f < section->end; ++f) {
      const LfSampling& sampling = frames_[f].sampling;
      st = std::min(st, sampling.camera_distance_w);
      lf_pixel = std::min(
          lf_pixel,
          sampling.pixel_rad * std::abs(normal.dot(slab.uv.origin_world - sampling.middle_world)));
      element = std::min(element, distance / frames_[f].camera.pinhole.intrinsics.fx_px);
    }
    section->pixel_uv_w = lf_pixel;
    const double uv =
        choices_.r_uv_w.value_or(std::max(kUvPerPixel * lf_pixel, kUvPerElement * element));
    const double most_st = kStPerDistance * st, least_st = kLeastStPerDistance * st;
    st = most_st;
    for (size_t f = section->begin; f < section->end; ++f)
      ForEachPlace(frames_[f], [&](const Vec3& focus) {
        const double depth = normal.dot(focus - slab.st.origin_world);
        const double off = std::abs(distance - depth);
        if (depth > 0 && uv * depth < st * off) st = uv * depth / off;
      });
    st = choices_.r_st_w.value_or(std::max(st, least_st));
    const SlabPoint half = section->bounds.high;
    constexpr double kKeys = kMostCells - 1;
    slab.r_st_w = std::max(st, half.head<2>().maxCoeff() / kKeys);
    slab.r_uv_w = std::max(uv, half.tail<2>().maxCoeff() / kKeys);
    return slab.r_st_w <= kMostCoarser * st && slab.r_uv_w <= kMostCoarser * uv;
  }

  std::span<const FrameQueries> frames_;
  const SlabChoices& choices_;
};

}  // namespace

std::optional<SlabBounds> BoundsOf(const Slab& slab, std::span<const FrameQueries> frames,
                                   bool* all_cut) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  SlabBounds bounds{SlabPoint::Constant(kInf), SlabPoint::Constant(-kInf)};
  for (const FrameQueries& frame : frames) {
    const double reach_w =
        frame.camera.aperture.radius_w + ReachOf(frame.kernel, frame.points).lens_w;
    ForEachPlace(frame, [&](const Vec3& focus) {
      for (const Vec2& corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(-1, 1), Vec2(1, 1)}) {
        const Vec3 lens = LensPointWorld(frame.camera, reach_w * corner);
        const std::optional<SlabPoint> point = Parameterize(slab, Ray{lens, focus - lens});
        if (point && point->allFinite()) {
          bounds.low = bounds.low.cwiseMin(*point);
          bounds.high = bounds.high.cwiseMax(*point);
        } else if (all_cut != nullptr) {
          *all_cut = false;
        }
      }
    });
  }
  if (!(bounds.low.array() <= bounds.high.array()).all()) return std::nullopt;
  return bounds;
}

std::vector<SlabSection> PlanSlabs(std::span<const FrameQueries> frames,
                                   const SlabChoices& choices) {
  std::vector<SlabSection> sections;
  if (!frames.empty()) SectionPlanner(frames, choices).Plan(0, frames.size(), &sections);
  return sections;
}

}  // namespace lf

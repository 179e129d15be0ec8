// SPDX-License-Identifier: Apache-2.0
// Places for virtual LF cameras in the lenses of a film.
//
// A film needs virtual LF cameras only where its lenses stand, which is often a small part of the
// capture. Its frames are divided into sections, whose lenses lie almost in one plane. In each of
// these planes virtual LF cameras stand on a hexagonal lattice wherever a lens is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/densify/camera_chart.h"
#include "lf/densify/camera_lattice.h"
#include "lf/densify/virtual_cameras.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// A part of a film. `camera` is the pinhole camera in its middle, and the lens plane of `camera` is
// that of the section: the lenses of its frames are turned by a few degrees against it, and so near
// to it that rays reach the same part of both but for a fifth of the lens.
struct FilmSection {
  std::vector<size_t> frames;  // ascending
  PinholeCamera camera;
  double inverse_focus = 0;  // mean inverse focus distance of the frames
};
//   frames  in their order; one or more
std::vector<FilmSection> SectionsOf(std::span<const RenderCamera> frames);

// A place in the lens plane of a section.
struct LensPlace {
  size_t section = 0;
  Vec3 centre_world = Vec3::Zero();
  LatticePlace at;  // its place among the LF cameras of the section's chart
  double Beyond() const { return (at.place - at.inside).norm(); }
};

struct LensPlaces {
  std::vector<LensPlace> places;
  // Least radius, over all frames, up to which the lens is filled; infinity if all are filled.
  double filled_radius_w = 0;
};

class FilmLenses {
 public:
  // The light field and the frames must outlive this object.
  //   used  LF cameras of which virtual ones may be made, ascending
  FilmLenses(const LightField& light_field, std::span<const uint32_t> used,
             std::span<const RenderCamera> frames);

  // Returns the LF cameras of which virtual ones in the lenses are made: for each frame, those that
  // its section's chart shows nearest to its lens, at most kServing; ascending.
  static constexpr size_t kServing = 24;
  std::vector<uint32_t> Serving() const;

  // Returns the LF cameras in a lens or as far as `distance` beside one, ascending.
  std::vector<uint32_t> Recorded(double distance) const;

  // Returns the area of all lenses, in which lenses that overlap count once only if they are equal.
  double Area_w2() const;

  // Returns the places of lattices with this distance between neighbours that lie in a lens or as
  // far as `distance` beside one, and in the convex hull of the section's chart or at most
  // `outside` away from it, without those that are nearer than half the distance to an LF camera.
  LensPlaces Places(double distance, double outside) const;

  // Returns the virtual LF camera at a place. Its picture has the directions in which the frames
  // look through this place, and its pixels are as large as those of its sources or as elements,
  // whichever are larger. Its sources are chosen as those of VirtualCameraAt().
  VirtualCamera CameraAt(const LensPlace& place, double distance, int divisor) const;

 private:
  // Returns the frame whose lens is nearest to a point.
  size_t NearestFrame(const Vec3& point_world) const;

  const LightField& light_field_;
  std::span<const RenderCamera> frames_;
  std::vector<FilmSection> sections_;
  std::vector<Vec3> centres_world_;       // [frame]
  std::vector<size_t> section_of_frame_;  // [frame]
  std::vector<CameraChart> charts_;       // [section]
};

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// The track along which a moving camera recorded LF images, such as the frames of a hand-held
// video.
#pragma once

#include <string>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// LF images in the order in which they were recorded, without gaps.
struct RecordedTrack {
  std::vector<LfImageId> images;
  std::vector<Vec3> positions_world;  // of the LF cameras of `images`
  // Distances along the track, from its first LF camera to each; they increase.
  std::vector<double> places_w;
  size_t at = 0;           // index of the LF image that the track was asked for
  double neighbour_w = 0;  // median distance from one LF image to the next
};

// Returns the part of the sequence that LF image `id` belongs to. A sequence are the LF images
// whose names differ in their last number alone (frame_0001.png, frame_0002.png, or times such as
// IMG_20260128_120301.jpg), in the order of these numbers. The part ends where the LF cameras jump:
// where a step, divided by the difference of the two numbers, is more than twice as long as the
// steps beside it, or where two successive LF cameras are more than eight median steps apart. LF
// cameras at the position of the one before are left out.
//
// kInput if no track can be found: fewer than three LF images follow each other without a gap, or
// the order of the names is not that of the positions (the median step is more than three times
// as long as the median distance to the nearest LF camera).
Result<RecordedTrack> FindTrack(const LightField& light_field, LfImageId id);

// Returns true if a film along the track shows more than other films of the light field: if the
// track has half of all LF images, at least 12; if neighbours are near, at most a twelfth of the
// track's extent and 3 degrees apart as seen from the subject; and if the track does not sweep over
// a surface, as a robot does that records a grid row by row.
bool IsDenseTrack(const LightField& light_field, const RecordedTrack& track,
                  double focus_distance_w);

// A track without the shaking of the hand: at each place, the point and the direction of the line
// that fits the LF cameras around it best, weighted by their distance along the track.
class SmoothTrack {
 public:
  //   sigma_w  standard deviation of the Gaussian weights, along the track
  // Refers to `track`, which must live longer.
  SmoothTrack(const RecordedTrack& track, double sigma_w) : track_(track), sigma_w_(sigma_w) {}

  struct Point {
    Vec3 position_world;
    Vec3 direction_world;  // forwards along the track, of length 1, or 0 if the track has none here
  };
  //   place_w  distance along the track, as RecordedTrack::places_w
  Point At(double place_w) const;

 private:
  const RecordedTrack& track_;
  double sigma_w_;
};

}  // namespace lf

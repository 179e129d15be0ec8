// SPDX-License-Identifier: Apache-2.0
// Lets the camera of an example path move along the track on which the LF images were recorded.
#pragma once

#include "lf/core/result.h"
#include "lf/focus/moves/recorded_track.h"
#include "lf/focus/moves/shot.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns a movement along the smoothed track past Shot::start, in the order of recording.
//
// The movement begins at the LF camera, and grows in both directions until one of these ends it:
// - it is 12 degrees long, where a degree is a step, sideways or towards the subject, of 1/57 of
//   the distance to it; it takes 3 degrees a second, but at least two seconds;
// - the lens would reach beyond the end of the track, or beyond a gap;
// - the track turns away by 45 degrees from its direction at the LF camera;
// - LF cameras of the track have not recorded 1 % of a frame. An element counts as recorded as in
//   MakeOrbit(), or if the track passes beside LF cameras at a distance, up to that distance.
// The frames are cropped by the share with the largest crop times length. The track is smoothed
// over 4 % of the focus distance, or more if the LF cameras are far apart.
CameraMove MakeAlong(const LightField& light_field, const RecordedTrack& track, const Shot& shot);

}  // namespace lf

// Develops the plate of a frame into its picture, and tells what is in it.
#pragma once

#include <functional>

#include "lf/core/parallel.h"
#include "lf/film/develop/develop.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/light_field/model/radiance.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/state/plate_notes.h"
#include "lf/render/state/report.h"

namespace lf {

struct RenderedFrame {
  DevelopedFrame picture;
  FrameReport report;  // without samples and noise
};

// Returns the notes by which a picture of the frame is made. The caller must set estimator, fps,
// smooth_below and fill_radius_px, and may set the others.
PlateNotes MakePlateNotes(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                          const FrameLens& lens, const RadianceEncoding& encoding);

// Develops the plate.
//   completion        the part interpolated from rebinned rays, or null
//   with_effective    false: leaves DevelopedFrame::effective_count empty, which takes time
//   is_interrupted    called often, by any thread; may be empty. Once it returns true, the rest is
//                     skipped and the result must not be used.
RenderedFrame DevelopFrame(const PlateNotes& notes, const SensorPlate& plate,
                           const Completion* completion, bool with_effective, ThreadPool& pool,
                           const std::function<bool()>& is_interrupted);

}  // namespace lf

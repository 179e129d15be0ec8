// SPDX-License-Identifier: Apache-2.0
// Develops the plate of a frame into its picture, and reports what the picture contains.
#pragma once

#include <functional>
#include <span>

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
  FrameReport report;  // without `samples` and `noise`, which FilmRenderer::Measure() adds
};

// Returns the notes from which DevelopFrame() makes the picture of the frame. The caller must still
// set estimator, fps, shutter, develop.smooth_below and develop.fill_radius_px. It may set version,
// ranks_done and the skipped LF images.
PlateNotes MakePlateNotes(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                          std::span<const FrameLens> lenses, const RadianceEncoding& encoding);

// Develops the plate.
//   completion        the part of the picture that is interpolated from rebinned rays; null if
//                     there is none
//   with_effective    true: fills DevelopedFrame::effective_count if there are lens weights, which
//                     takes time; false: leaves it empty
//   is_interrupted    called often, by any thread; empty: nothing interrupts. Once it returns true,
//                     the remaining work is skipped and the result must not be used.
RenderedFrame DevelopFrame(const PlateNotes& notes, const SensorPlate& plate,
                           const Completion* completion, bool with_effective, ThreadPool& pool,
                           const std::function<bool()>& is_interrupted);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Frames and their plates as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>
#include <set>
#include <utility>

#include "lf/film/develop/develop.h"
#include "lf/film/plate/plate_file.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/pixels/files/image_file.h"
#include "lf/render/state/plate_notes.h"
#include "lf/render/state/run_inputs.h"

namespace lf::python {

// A finished or unfinished frame: its picture, and the notes that its file gets.
struct Frame {
  DevelopedFrame picture;
  PlateNotes notes;
  // [height][width] 1 where light was recorded, filled or interpolated: the alpha that a file may
  // get. Empty if the picture has opacities.
  Image<uint8_t> has_light = {};
  ImageMetadata more_metadata = {};  // entries that its file gets after those of the notes
};

// Returns the frame of a picture that was developed with DevelopOptions::adds_opacity. Opacities
// that were added become has_light.
//   keeps_opacity  the opacities are those of the LF images
Frame MakeFrame(DevelopedFrame picture, PlateNotes notes, bool keeps_opacity);

// A plate with the notes from which it can be developed.
struct Plate {
  SensorPlate sums{0, 0};
  std::optional<PlateGaps> gaps;  // of the lenses of a hybrid
  PlateNotes notes;
  RunInputs inputs;  // inputs of the rays and of the camera; as far as its file states them
  // The shards whose rays the plate has, of shard_count shards.
  uint32_t shard_count = 1;
  std::set<uint32_t> shards = {1};

  // Returns the entries that plates must have in common if they are added.
  PlateEntries Shared() const {
    PlateEntries shared = inputs;
    for (auto& entry : SharedEntries(TextOf(notes))) shared.push_back(std::move(entry));
    return shared;
  }
};

// Returns a plate with the same sums and counts.
SensorPlate CopyOf(const SensorPlate& plate);
PlateGaps CopyOf(const PlateGaps& gaps);

void AddFrames(pybind11::module_& module);

}  // namespace lf::python

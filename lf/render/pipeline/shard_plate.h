// SPDX-License-Identifier: Apache-2.0
// The plate files of a frame that lfmerge adds: finds them, and checks that they belong together.
// Internal to this folder.
#pragma once

#include <filesystem>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/film/plate/plate_file.h"
#include "lf/render/settings/shard.h"
#include "lf/render/state/plate_notes.h"
#include "lf/render/state/run_inputs.h"

namespace lf {

// The facts about one plate file. The rays stay in the file.
struct ShardPlate {
  std::filesystem::path path;
  Shard shard;
  PlateNotes notes;
  RunInputs inputs;  // entries that all plates of a frame have in common
  int width_px = 0;
  int height_px = 0;
  PlateKind kind = PlateKind::kColours;
  bool has_gaps = false;
};

// Returns the files among the given ones and the plates anywhere below the given folders, sorted.
// kInput: a folder cannot be read, or has no plates. kUsage: a file is given twice.
Result<std::vector<std::filesystem::path>> PlateFilesOf(
    const std::vector<std::filesystem::path>& given);

// Opens a plate, and adds WithPlateRemedy() to errors.
Result<PlateReader> OpenPlate(const std::filesystem::path& path);
// Reads the facts about a plate. Errors are those of OpenPlate(), PlateNotesOf() and ShardIn().
Result<ShardPlate> LookAtPlate(const std::filesystem::path& path);
// Adds to the error of a plate that cannot be read what to do.
Error WithPlateRemedy(const Error& error);

// Returns the inputs that say which light field a plate was rendered from, and how its numbers
// became light.
RunInputs LightFieldOf(const ShardPlate& plate);

// Sorts the plates of a frame, of which there must be one, by their shards. kInput: a shard is
// missing or given twice, or the plates are of different renders; the message names them.
Result<void> CheckShards(FrameId frame, std::vector<ShardPlate>* plates);

}  // namespace lf

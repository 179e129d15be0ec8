// SPDX-License-Identifier: Apache-2.0
// Reads the data sets of NSVF and its successors: pose/*.txt, rgb/* and intrinsics.txt
// (doc/formats/nsvf.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/import/exports/export_cameras.h"

namespace lf {

// Reads one pose, a matrix of 4 x 4 numbers, world_from_cam, with the axes x right, y down, z
// forward. kInput names the file, the line, the value and what was expected.
Result<RigidTransform> ParseNsvfPose(std::string_view text, const std::filesystem::path& file);

// Reads intrinsics.txt: a matrix of 4 x 4 or 3 x 3 numbers, or a first line "f cx cy 0". Pixel
// centres are at whole numbers. The size is not stated.
Result<Intrinsics> ParseNsvfIntrinsics(std::string_view text, const std::filesystem::path& file);

// Reads the data set of which `file` is a pose. Images of rgb/ belong to poses in the order of
// their names. kInput: there are more or fewer images than poses; without rgb/, images have the
// names of the poses. The depth range is that of near_and_far.txt, if it is there.
Result<LightField> ReadNsvf(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Reads the cameras.xml of Agisoft Metashape and PhotoScan (File > Export > Export Cameras, Agisoft
// XML): doc/formats/metashape.md. The formulas are those of the appendix "Camera models" of
// Metashape's user manual:
//
//   u = w / 2 + cx + x' f + x' b1 + y' b2, v = h / 2 + cy + y' f, in pixels; (0.5, 0.5) is the
//   centre of the upper left pixel
//   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8) + p1 (r^2 + 2 x^2) + 2 p2 x y
//   y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8) + p2 (r^2 + 2 y^2) + 2 p1 x y
//
// with (x, y) = (X, Y) / Z for frame cameras, and the same times atan(r) / r for equidistant
// fish-eyes. Metashape's p1 and p2 are OpenCV's p2 and p1.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/exports/export_cameras.h"

namespace lf {

// Parses the text of a file. An image is named by the label of its camera, which often lacks the
// extension; if several cameras have one label, by GROUP/LABEL or, outside of groups, SENSOR/LABEL,
// because Metashape takes the photographs of rigs from folders. Its pose is the transform of the
// camera or, in a rig, the transform of its master after the place of its sensor relative to the
// master's; then the transform of its component or of the chunk. World units are those of the
// chunk's coordinate system, metres as a rule, or the chunk's own if the chunk is not scaled; a
// message says which. A geographic coordinate system is not projected: positions are geocentric.
// Left out, and counted in a warning: cameras that are disabled or were not aligned, and those of
// components that are not placed relative to the component with most cameras.
// kInput: no cameras; several chunks; a lens other than frame or equidistant fish-eye; a
// calibration of PhotoScan 1.1 or older (fx), or with p3 or p4; a wrong number. The message names
// the element, the value and what was expected.
//   file  for messages; its folder is that of the images
Result<ExportedCameras> ParseMetashape(std::string_view text, const std::filesystem::path& file);

// Reads a file as ParseMetashape() does. kInput if it has more than kMostXmlBytes,
// or if two cameras would have the same image file.
Result<LightField> ReadMetashape(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf

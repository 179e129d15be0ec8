// SPDX-License-Identifier: Apache-2.0
// Reads the CSV files of camera parameters that RealityCapture and RealityScan export (Alignment >
// Export > Registration): doc/formats/realitycapture.md. Two of their forms hold whole cameras:
//
//   Internal/External camera parameters
//     #name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2
//   OpenCV-compliant Internal/External Camera Parameters
//     #name,tx,ty,tz,R00,R01,...,R22,f_pix,px_pix,py_pix,k1,k2,t2,t1,k3,k4
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/exports/export_cameras.h"

namespace lf {

// Parses the text of a file. Columns are found by their names, in any order; heading may be called
// yaw, and alt z. Other columns are ignored.
//   x, y, alt             camera centre; world: x east, y north, z up
//   heading, pitch, roll  degrees (RealityRotation() of reality_lens.h)
//   f                     focal length as on a 35 mm film: f / 36 of the image's larger side
//   px, py                principal point: offset from the image's middle, as a share of its larger
//                         side
//   tx, ty, tz; R00...    cam_from_world
//   f_pix, px_pix, py_pix in pixels, from the upper left corner
//   k1 ... t2             coefficients of Brown's distortion (RealityDistortion())
// The image files state the sizes. Warns if k1 alone is not 0, because this may also be the
// division model. kInput names the line, the column and the value: no header; a column is missing,
// as in exports of geographic positions or without lenses; a number that is none or too large.
//   file  for messages; its folder is that of the images
Result<ExportedCameras> ParseRealityCsv(std::string_view text, const std::filesystem::path& file);

// Reads a file as ParseRealityCsv() does.
Result<LightField> ReadRealityCsv(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Reads the XMP files that RealityCapture and RealityScan write beside the images (Alignment >
// Export > XMP): doc/formats/realitycapture.md. Each states the camera of the image of the same
// name.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/exports/export_cameras.h"

namespace lf {

// The camera in one file.
struct RealitySidecar {
  ExportedImage image;    // lengths are shares of the image's larger side, from its middle
  std::string component;  // the component to which the pose is relative; "": none, the world
};

// Parses the text of a file. Values may be attributes of rdf:Description or elements in it:
//   xcr:Rotation         cam_from_world, row by row
//   xcr:Position         camera centre
//   xcr:FocalLength35mm  as on a 35 mm film: f / 36 of the image's larger side
//   xcr:PrincipalPointU  offset from the image's middle, as a share of its larger side; so is V
//   xcr:DistortionModel, xcr:DistortionCoeficients (sic)
//                        none or perspective; brown3, brown4, brown3t2 or brown4t2 with k1 k2 k3 k4
//                        t1 t2 (RealityDistortion())
// Returns nullopt if the file states no pose, such as that of another program or of an image that
// was not aligned.
// kInput: a wrong number; a pose without a focal length; another distortion model; a skew other
// than 0 or an aspect ratio other than 1, whose meaning is not documented.
//   file  for messages; its name without .xmp is the image's
Result<std::optional<RealitySidecar>> ParseRealityXmp(std::string_view text,
                                                      const std::filesystem::path& file);

// Reads all XMP files in the folder of `file`. If poses are relative to several components, those
// of the largest one are read, and the others are counted in a warning.
Result<LightField> ReadRealityXmp(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Reads the NAME.nvm of VisualSFM (doc/formats/nvm.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/import/exports/export_cameras.h"

namespace lf {

// Reads the cameras of the first model of a file, NVM_V3 or NVM_V3_R9T. NVM_V3 states a rotation as
// the quaternion w x y z and the centre c: x_cam = R (x_world - c); NVM_V3_R9T states R row by row
// and t: x_cam = R x_world + t. Axes: x right, y down, z forward. The principal point is the middle
// of the image, whose size the file does not state, or that of FixedK fx cx fy cy r.
//
// The number r undoes distortion: r_undistorted = r_distorted (1 + r r_distorted^2). Its inverse is
// approximated by kRadialTangential with k1 to k6, a quotient of polynomials (Pade) whose
// coefficients are powers of r. kInput for r and images so large that it is more than 1e-3 px
// wrong in a corner, and for every other fault, with file, line, value and what was expected.
Result<ExportedCameras> ParseNvm(std::string_view text, const std::filesystem::path& file);

Result<LightField> ReadNvm(const std::filesystem::path& file, const ExportOptions& options);

// Returns the distortion that inverts r_undistorted = r_distorted (1 + r r_distorted^2).
Distortion InverseOfNvmRadial(double r);

}  // namespace lf

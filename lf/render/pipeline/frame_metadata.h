// SPDX-License-Identifier: Apache-2.0
// The metadata in the file of a frame, which describe its render camera, its rays and its colours.
#pragma once

#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/film/develop/colour_space.h"
#include "lf/film/develop/frame_file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/render/collect/collect.h"
#include "lf/render/state/plate_notes.h"

namespace lf {

// Returns the entry "Software", and entries whose names begin with "lf:". The name of an entry ends
// in the unit of its value, if it has one. No entry is a time of day, so that equal frames have
// equal files.
ImageMetadata FrameMetadata(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                            Estimator estimator, double fps, const std::string& version,
                            const std::optional<FrameShutter>& shutter);

// Returns the entries that EXR files have under the names and types of OpenEXR's standard
// attributes (ImfStandardAttributes.h).
//
//   worldToCamera  converts a world point (x, y, z, 1), as a row vector, to camera axes that are
//                  left-handed: x right, y up, z forward
//   worldToNDC     converts it to (u w, v w, z - g, w), where (u, v) is its place in the frame: (0,
//                  0) is the upper left corner, (1, 1) the lower right one; w = z is its depth and
//                  g the focus distance
//
// screenWindowWidth, screenWindowCenter and pinholeFocalLength state the field of view; the
// aperture is missing for a pinhole, because its f-number is infinite. expTime, the open time in
// seconds, is there only if there is a shutter.
ImageMetadata StandardAttributes(FrameId frame, const RenderCamera& camera, double fps,
                                 ColourSpace colours,
                                 const std::optional<FrameShutter>& shutter = {});

// Returns all entries of the file of a frame: those of FrameMetadata() and, in EXR files,
// StandardAttributes().
ImageMetadata FileMetadata(const PlateNotes& notes, FrameFormat format, ColourSpace colours);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// The inputs of a frame as readable pairs of key and value. A resumed render compares its inputs
// with the inputs that it was begun with. The error message names an input that differs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/film/develop/picture.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/light_field/model/radiance.h"
#include "lf/render/settings/film_settings.h"

namespace lf {

// Pairs (key, value) in the order in which they are written. Keys have the form that
// film/plate/plate_file.h describes; settings have the keys of the table of settings
// (render/settings/setting_table.h).
using RunInputs = std::vector<std::pair<std::string, std::string>>;

// The choices that decide the rays and the pictures of frames, besides cameras and calibration.
struct RunChoices {
  FilmSettings film;  // completed (Resolved() in render/pipeline/resolved_settings.h)
  // "as recorded", or the settings of the lossy codec that changed the pixels of the LF images.
  std::string pixels = "as recorded";
  // The members below decide only how a picture is made from the rays.
  std::string format = "exr";
  PictureOptions look;
};

// The version of the ray model (doc/ray.md). A change of the code that gives other rays for the
// same inputs raises it.
inline constexpr int kRayModelVersion = 4;
inline constexpr const char* kRayModelKey = "ray_model";
// The version of the polynomials that give positions in LF images with lens distortion. A change of
// the code that changes them within their tolerance (SegmentMaker::kTolerance) raises it: frames of
// such light fields then have other bits, and others do not.
inline constexpr int kDistortedPositionsVersion = 2;
// The version of the polynomials that give the positions at which bilinear rays read LF images. A
// change of the code that changes them within their tolerance raises it. Frames of the estimator
// nearest do not depend on it.
inline constexpr int kBilinearPositionsVersion = 2;
// The version of the reading of mosaics by the filter "mosaic". Frames of other filters do not
// depend on it.
inline constexpr int kMosaicReadingVersion = 3;

// Returns the inputs that decide the rays of all frames: the versions of the ray model, the
// settings with the role kRays, and the light field (number of LF images, and hashes of
// calibration, encoding and names). The folder of the light field is no input, because it may move.
// The contents of its image files are not compared.
//   light_field  identity of the whole light field, even if a package is rendered
RunInputs InputsOfRays(const LightFieldIdentity& light_field, const RadianceEncoding& encoding,
                       const RunChoices& choices);

// The shutter of a frame, and a hash of the exact cameras of its instants.
struct FrameShutter {
  Shutter shutter;
  std::string cameras;
};
// Returns nullopt if the path has no shutter.
std::optional<FrameShutter> ShutterOf(const CameraPath& path, FrameId frame);

// Returns the inputs of one frame: its number, readable values of its camera, a hash of the exact
// camera, and the shutter, if there is one.
RunInputs InputsOfCamera(FrameId frame, const RenderCamera& camera,
                         const std::optional<FrameShutter>& shutter = {});
// Returns the inputs of a frame of a path.
RunInputs InputsOfFrame(const CameraPath& path, FrameId frame);

// Returns the inputs that decide only the pictures.
RunInputs InputsOfPicture(const RunChoices& choices);

// The key under which the inputs of a package contain HashOfCameras(). A render without a package
// file does not have this input.
inline constexpr const char* kFilmOfPackage = "picture.film";

// Returns a hash of all cameras of a film and of the number of its first frame. Packages that are
// rendered into one folder must have the same hash.
std::string HashOfCameras(const CameraPath& path);

// Returns a hash of what decides which rays the cameras of a film take: everything but the numbers
// of their elements. A film has the same hash at any resolution.
std::string HashOfLenses(const CameraPath& path);

// The first input that differs, and its values on both sides; "(none)" for a side that lacks the
// key.
struct InputDifference {
  std::string key;
  std::string recorded;
  std::string wanted;

  // Returns a text such as "was made with order area, this call has shuffle" if `one` is "was made
  // with" and `other` is "this call has". If one side lacks the input, its part of the text is "no
  // KEY", such as "no order".
  std::string Text(const std::string& one, const std::string& other) const;
  // Returns what to do to continue the recorded render: give the same inputs and options. Names the
  // number of rebinned rays, because it may follow from {memory} and is then none of the options.
  std::string Remedy() const;
};
// Returns nullopt if both have the same keys and values, in any order. A side that lacks the key
// "interpolation" counts as "interpolation cells", because renders that were begun before there
// were kept pixels lack it.
std::optional<InputDifference> FirstDifference(const RunInputs& recorded, const RunInputs& wanted);

}  // namespace lf

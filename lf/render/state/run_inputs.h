// The inputs of a frame as readable lines. By these, a resumed render checks that it has the inputs
// that it was begun with, or tells which one differs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/film/develop/develop.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/light_field/model/radiance.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/selection/image_order.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {

// Pairs (key, value) in the order in which they are written. Keys have the form of those in
// film/plate/plate_file.h.
using RunInputs = std::vector<std::pair<std::string, std::string>>;

// The options that decide the rays of a frame; the last three decide its picture.
struct RunChoices {
  RayReading reading;
  CollectBackEnd back_end = CollectBackEnd::kFast;
  ImageOrder order = ImageOrder::kShuffle;
  uint64_t seed = 0;
  LensWeights lens_weights = LensWeights::kNone;
  std::optional<size_t> max_image_count;
  std::optional<double> max_angle_rad;
  std::optional<uint32_t> stop_at_samples;  // at most one of the two stop rules is set
  std::optional<double> stop_at_noise;
  // "as recorded", or the settings of the lossy codec that changed the pixels.
  std::string pixels = "as recorded";
  std::string format = "exr";
  uint32_t smooth_below = 0;
  int fill_radius_px = kFillRadius_px;
};

// The version of the ray model of doc/ray.md. It is raised when the same inputs give other rays.
inline constexpr int kRayModelVersion = 3;

// Returns the inputs of the rays of all frames: the ray model's version, the light field (number of
// LF images, and hashes of calibration, encoding and names) and the choices for rays. The folder of
// the light field may move, and is no input; the contents of its image files are not compared.
//   light_field  the whole light field, also for a package
RunInputs InputsOfRays(const LightFieldIdentity& light_field, const RadianceEncoding& encoding,
                       const RunChoices& choices);

// Returns the inputs of one frame: its number, and its camera in words and, exactly, as a hash.
RunInputs InputsOfCamera(FrameId frame, const RenderCamera& camera);

// Returns the inputs that only pictures depend on.
RunInputs InputsOfPicture(const RunChoices& choices);

// The key of HashOfCameras() in the inputs of packages; other renders do not have it.
inline constexpr const char* kFilmOfPackage = "picture.film";

// Returns a hash of all cameras of a film. Packages rendered into one folder must have the same.
std::string HashOfCameras(const CameraPath& path);

// The first key that differs, and both values; "(none)" is the value of a side without the key.
struct InputDifference {
  std::string key;
  std::string recorded;
  std::string wanted;

  // Returns a text such as "was made with order area, this call has shuffle" if `one` is "was made
  // with" and `other` is "this call has". An input that one side lacks is "no order".
  std::string Text(const std::string& one, const std::string& other) const;
};
std::optional<InputDifference> FirstDifference(const RunInputs& recorded, const RunInputs& wanted);

}  // namespace lf

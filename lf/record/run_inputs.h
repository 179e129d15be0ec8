// What a frame is made from, as readable lines: so that an interrupted render goes on from the
// inputs it was begun with, or tells which one differs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/capture/light_field_identity.h"
#include "lf/capture/radiance.h"
#include "lf/collector/collect_batch.h"
#include "lf/core/ids.h"
#include "lf/lens_weights/frame_weights.h"
#include "lf/path/camera_path.h"
#include "lf/selection/image_order.h"
#include "lf/sequence/develop.h"

namespace lf {

// (key, value), in the order written; keys as in plate/plate_file.h.
using RunInputs = std::vector<std::pair<std::string, std::string>>;

// The options that decide about the rays of a frame, and (the last three) about its picture.
struct RunChoices {
  RayReading reading;
  CollectBackEnd back_end = CollectBackEnd::kFast;
  ImageOrder order = ImageOrder::kShuffle;
  uint64_t seed = 0;
  LensWeights lens_weights = LensWeights::kNone;
  std::optional<size_t> max_image_count;
  std::optional<double> max_angle_rad;
  std::optional<uint32_t> stop_at_samples;  // one of these two rules at most
  std::optional<double> stop_at_noise;
  // "as recorded", or how a lossy codec changed them: other pixels give other frames.
  std::string pixels = "as recorded";
  std::string format = "exr";
  uint32_t smooth_below = 0;
  int fill_radius_px = kFillRadius_px;
};

// The version of doc/ray.md: raised when the same inputs give other rays.
inline constexpr int kLawVersion = 3;

// Of all frames: the law, the light field (numbers of images, hashes of calibration, encoding and
// names; not its folder, which may move, nor the pixels) and the choices for rays.
//   light_field  the whole one, also of a package
RunInputs InputsOfRays(const LightFieldIdentity& light_field, const RadianceEncoding& encoding,
                       const RunChoices& choices);

// Of one frame: its number, its camera in words and, exact, as a hash.
RunInputs InputsOfCamera(FrameId frame, const RenderCamera& camera);

// Of its picture alone.
RunInputs InputsOfPicture(const RunChoices& choices);

// The key of HashOfCameras() in the inputs of packages; other renders lack it.
inline constexpr const char* kFilmOfPackage = "picture.film";

// All cameras of a film: what packages rendered into one folder must have in common.
std::string HashOfCameras(const CameraPath& path);

// The first key that differs, and both values; "(none)" where one side lacks it.
struct InputDifference {
  std::string key;
  std::string recorded;
  std::string wanted;

  // Returns such as "was made with order area, this call has shuffle", where `one` is "was
  // made with" and `other` "this call has". Input that one side lacks is "no order".
  std::string Text(const std::string& one, const std::string& other) const;
};
std::optional<InputDifference> FirstDifference(const RunInputs& recorded, const RunInputs& wanted);

}  // namespace lf

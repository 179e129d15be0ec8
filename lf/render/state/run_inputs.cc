// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/run_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "lf/film/develop/display_view.h"
#include "lf/light_field/model/value_hasher.h"
#include "lf/render/settings/setting_table.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {
namespace {

constexpr const char* kNoInput = "(none)";

// Returns a text of the values that a person may want to see, followed by the hash of all values.
std::string EncodingText(const RadianceEncoding& encoding) {
  ValueHasher hasher;
  hasher.Add(static_cast<double>(encoding.bayer));
  hasher.Add(static_cast<double>(encoding.transfer));
  for (const double value : encoding.response) hasher.Add(value);
  hasher.Add(encoding.black_level);
  hasher.Add(encoding.white_level.value_or(-1));
  hasher.Add(encoding.max_radiance);
  if (encoding.overshoot_room != 1) hasher.Add(encoding.overshoot_room);
  hasher.Add(encoding.pedestal);
  std::string alpha;
  if (encoding.AlphaIsLight()) {
    const std::array<double, 3> behind = encoding.Background();
    hasher.Add(static_cast<double>(*encoding.alpha));
    for (const double value : behind) hasher.Add(value);
    if (encoding.keeps_opacity) hasher.Add(1.0);
    const std::string over = encoding.keeps_opacity
                                 ? kNoBackground
                                 : fmt::format("{} {} {}", behind[0], behind[1], behind[2]);
    alpha = fmt::format(" alpha {} over {}", NameOf(*encoding.alpha), over);
  }
  if (encoding.masks_clipped) {
    hasher.Add(std::string("clipped"));
    alpha += " clipped mask";
  }
  constexpr const char* kTransfers[] = {"srgb", "linear", "response"};
  return fmt::format(
      "{}{} black {} white {} max {} pedestal {}{} ({})",
      kTransfers[static_cast<int>(encoding.transfer)],
      encoding.bayer == BayerPattern::kNone ? std::string()
                                            : fmt::format(" {}", NameOf(encoding.bayer)),
      encoding.black_level, encoding.white_level ? fmt::format("{}", *encoding.white_level) : "-",
      encoding.max_radiance, encoding.pedestal, alpha, hasher.Text());
}

// Returns a text of the values that decide the colours when a plate is developed.
std::string ColoursText(const RadianceEncoding& encoding) {
  ValueHasher hasher;
  for (const double gain : encoding.white_balance) hasher.Add(gain);
  hasher.AddMatrix(encoding.linear_srgb_from_camera);
  return fmt::format("white balance {} {} {} ({})", encoding.white_balance[0],
                     encoding.white_balance[1], encoding.white_balance[2], hasher.Text());
}

std::string Text(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

// Adds everything of a camera but its intrinsics.
void AddLens(const RenderCamera& camera, ValueHasher* hasher) {
  hasher->Add(camera.pinhole.cam_from_world);
  hasher->Add(camera.aperture.radius_w);
  hasher->Add(camera.aperture.blades);
  hasher->Add(camera.aperture.rotation_rad);
  if (HasShape(camera)) {
    hasher->Add(camera.aperture.ratio);
    hasher->Add(camera.aperture.roundness);
    hasher->Add(camera.hood.distance_w);
    hasher->Add(camera.hood.radius_w);
  }
  if (camera.transmission) hasher->Add(camera.transmission->Text());
  if (camera.recording_time) {
    hasher->Add(std::string("recording time"));
    hasher->Add(*camera.recording_time);
  }
  if (camera.surface) hasher->Add("surface " + camera.surface->Digest());
  hasher->AddMatrix(camera.focus_plane.normal);
  hasher->Add(camera.focus_plane.offset_w);
}

std::string CameraHash(const RenderCamera& camera) {
  ValueHasher hasher;
  hasher.Add(camera.pinhole.intrinsics);
  AddLens(camera, &hasher);
  return hasher.Text();
}

}  // namespace

RunInputs InputsOfRays(const LightFieldIdentity& light_field, const RadianceEncoding& encoding,
                       const RunChoices& choices) {
  const FilmSettings& film = choices.film;
  RunInputs inputs = {{kRayModelKey, fmt::format("{}", kRayModelVersion)},
                      {"ray_model.distortion", fmt::format("{}", kDistortedPositionsVersion)}};
  for (auto& setting : TextsOf(film, SettingRole::kRays)) inputs.push_back(std::move(setting));
  if (film.lens_weights != LensWeights::kNone)
    inputs.emplace_back("ray_model.lens_weights", fmt::format("{}", kLensWeightsVersion));
  if (film.reading.estimator == Estimator::kBilinear) {
    inputs.emplace_back("ray_model.bilinear", fmt::format("{}", kBilinearPositionsVersion));
    if (film.reading.filter == PixelFilter::kMosaic)
      inputs.emplace_back("ray_model.mosaic", fmt::format("{}", kMosaicReadingVersion));
  }
  inputs.insert(inputs.end(), {{"light_field.images", fmt::format("{}", light_field.image_count)},
                               {"light_field.names", light_field.names},
                               {"light_field.calibration", light_field.calibration},
                               {"light_field.pixels", choices.pixels},
                               {"light_field.encoding", EncodingText(encoding)},
                               {"light_field.colours", ColoursText(encoding)}});
  return inputs;
}

std::optional<FrameShutter> ShutterOf(const CameraPath& path, FrameId frame) {
  if (!path.shutter.exists()) return std::nullopt;
  ValueHasher hasher;
  for (const RenderCamera& camera : path.Instants(frame)) hasher.Add(CameraHash(camera));
  return FrameShutter{path.shutter, hasher.Text()};
}

RunInputs InputsOfFrame(const CameraPath& path, FrameId frame) {
  return InputsOfCamera(frame, path.Camera(frame), ShutterOf(path, frame));
}

RunInputs InputsOfCamera(FrameId frame, const RenderCamera& camera,
                         const std::optional<FrameShutter>& shutter) {
  const PinholeCamera& pinhole = camera.pinhole;
  const Intrinsics& k = pinhole.intrinsics;
  RunInputs inputs = {
      {"frame", fmt::format("{}", frame.value)},
      {"frame.resolution", fmt::format("{} {}", k.width_px, k.height_px)},
      {"frame.fx_px", fmt::format("{}", k.fx_px)},
      {"frame.position", Text(pinhole.CentreWorld())},
      {"frame.forward", Text(pinhole.ForwardWorld())},
      {"frame.up", Text(pinhole.UpWorld())},
      {"frame.aperture_diameter_w", fmt::format("{}", 2 * camera.aperture.radius_w)},
      {"frame.blades", fmt::format("{}", camera.aperture.blades)},
      {"frame.focus_distance_w", fmt::format("{}", camera.focus_distance_w)},
      {"frame.focus_plane",
       fmt::format("{} {}", Text(camera.focus_plane.normal), camera.focus_plane.offset_w)}};
  if (camera.surface) inputs.emplace_back("frame.focal_surface", camera.surface->Digest());
  if (camera.recording_time)
    inputs.emplace_back("frame.recording_time", fmt::format("{}", *camera.recording_time));
  inputs.emplace_back("frame.camera", CameraHash(camera));
  if (shutter)
    inputs.emplace_back("frame.shutter",
                        fmt::format("{} degrees, {} samples ({})", shutter->shutter.angle_deg,
                                    shutter->shutter.samples, shutter->cameras));
  return inputs;
}

RunInputs InputsOfPicture(const RunChoices& choices) {
  RunInputs inputs = {{"picture.format", choices.format}};
  for (auto& setting : TextsOf(choices.film, SettingRole::kPicture))
    inputs.push_back(std::move(setting));
  // Frames of earlier builds, which lack this input, have other names of channels.
  if (const auto format = ParseFrameFormat(choices.format); format && IsExr(*format))
    inputs.emplace_back("picture.channels", choices.look.channels == FrameChannels::kAll
                                                ? fmt::format("all, with {}", kCountChannels[0])
                                                : std::string(NameOf(choices.look.channels)));
  if (choices.film.adds_opacity) inputs.emplace_back("picture.alpha", "on");
  if (choices.look.colours != ColourSpace::kRec709)
    inputs.emplace_back("picture.colour_space", NameOf(choices.look.colours));
  if (choices.look.has_focus_depth) inputs.emplace_back("picture.z", "on");
  if (choices.look.compression != ExrCompression::kZip)
    inputs.emplace_back("picture.exr_compression", NameOf(choices.look.compression));
  if (choices.look.view) inputs.emplace_back("picture.view", choices.look.view->identity());
  return inputs;
}

std::string HashOfCameras(const CameraPath& path) {
  ValueHasher hasher;
  for (const RenderCamera& camera : path.cameras) hasher.Add(CameraHash(camera));
  for (const RenderCamera& camera : path.instants) hasher.Add(CameraHash(camera));
  // Films that are numbered from 1 keep the hash that reports and checkpoints have recorded.
  if (path.first_frame != 1) hasher.Add(fmt::format("first frame {}", path.first_frame));
  return hasher.Text();
}

std::string HashOfLenses(const CameraPath& path) {
  ValueHasher hasher;
  for (const RenderCamera& camera : path.AllInstants()) {
    // Rounded, because a focal length in elements is rounded differently for each resolution.
    const Intrinsics& plate = camera.pinhole.intrinsics;
    hasher.Add(
        fmt::format("{:.6g} {:.6g}", plate.fx_px / plate.width_px, plate.fy_px / plate.height_px));
    AddLens(camera, &hasher);
  }
  return hasher.Text();
}

std::string InputDifference::Text(const std::string& one, const std::string& other) const {
  const auto text_of = [&](const std::string& value) {
    if (value != kNoInput) return fmt::format("{} {}", key, value);
    return key == kFilmOfPackage ? std::string("no packages") : "no " + key;
  };
  const bool is_in_both = recorded != kNoInput && wanted != kNoInput;
  return fmt::format("{} {}, {} {}", one, text_of(recorded), other,
                     is_in_both ? wanted : text_of(wanted));
}

std::string InputDifference::Remedy() const {
  if (key == "max_rays" && recorded != kNoInput)
    return fmt::format("give {{max_rays {}}}, or the same {{memory}}", recorded);
  return "give the same inputs and options";
}

std::optional<InputDifference> FirstDifference(const RunInputs& recorded, const RunInputs& wanted) {
  const auto value_in = [](const RunInputs& inputs, const std::string& key) -> std::string {
    for (const auto& [name, value] : inputs)
      if (name == key) return value;
    return key == "interpolation" ? NameOf(RayInterpolation::kCells) : kNoInput;
  };
  for (const auto& [key, value] : wanted)
    if (const std::string other = value_in(recorded, key); other != value)
      return InputDifference{key, other, value};
  for (const auto& [key, value] : recorded)
    if (const std::string other = value_in(wanted, key); other != value)
      return InputDifference{key, value, other};
  return std::nullopt;
}

}  // namespace lf

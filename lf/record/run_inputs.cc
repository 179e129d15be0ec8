#include "lf/record/run_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "lf/core/hash.h"

namespace lf {
namespace {

// Values one after the other, as bytes. Numbers keep all their bits.
class InputHasher {
 public:
  void Add(double value) {
    const double plain = value == 0 ? 0 : value;  // -0 is no other input
    hasher_.Add({reinterpret_cast<const char*>(&plain), sizeof(plain)});
  }
  void Add(const std::string& text) {
    Add(static_cast<double>(text.size()));
    hasher_.Add(text);
  }
  template <class Matrix>
  void AddMatrix(const Matrix& matrix) {
    for (Eigen::Index row = 0; row < matrix.rows(); ++row)
      for (Eigen::Index column = 0; column < matrix.cols(); ++column) Add(matrix(row, column));
  }
  void Add(const RigidTransform& transform) {
    AddMatrix(transform.rotation);
    AddMatrix(transform.translation);
  }
  void Add(const Intrinsics& k) {
    for (const double value : {k.fx_px, k.fy_px, k.cx_px, k.cy_px, k.skew_px}) Add(value);
    Add(k.width_px);
    Add(k.height_px);
    Add(static_cast<double>(k.distortion.model));
    for (const double parameter : k.distortion.parameters) Add(parameter);
  }
  std::string Text() const { return fmt::format("{:016x}", hasher_.Hash()); }

 private:
  Hasher hasher_;
};

std::string CalibrationHash(const LightField& light_field) {
  InputHasher hasher;
  for (const LfCamera& camera : light_field.cameras) {
    hasher.Add(camera.cam_from_world);
    hasher.Add(static_cast<double>(camera.intrinsics_index));
    hasher.Add(camera.gain);
  }
  for (const Intrinsics& k : light_field.intrinsics) hasher.Add(k);
  return hasher.Text();
}

std::string NamesHash(const LightField& light_field) {
  InputHasher hasher;
  for (const std::string& name : light_field.image_names) hasher.Add(name);
  for (const std::string& name : light_field.mask_names) hasher.Add(name);
  return hasher.Text();
}

// What a reader may want to see, then the hash of all of it.
std::string EncodingText(const RadianceEncoding& encoding) {
  InputHasher hasher;
  hasher.Add(static_cast<double>(encoding.bayer));
  hasher.Add(static_cast<double>(encoding.transfer));
  for (const double value : encoding.response) hasher.Add(value);
  hasher.Add(encoding.black_level);
  hasher.Add(encoding.white_level.value_or(-1));
  hasher.Add(encoding.max_radiance);
  hasher.Add(encoding.pedestal);
  constexpr const char* kTransfers[] = {"srgb", "linear", "response"};
  return fmt::format(
      "{}{} black {} white {} max {} pedestal {} ({})",
      kTransfers[static_cast<int>(encoding.transfer)],
      encoding.bayer == BayerPattern::kNone ? std::string()
                                            : fmt::format(" {}", NameOf(encoding.bayer)),
      encoding.black_level, encoding.white_level ? fmt::format("{}", *encoding.white_level) : "-",
      encoding.max_radiance, encoding.pedestal, hasher.Text());
}

// Developing: what is done to colours.
std::string ColoursText(const RadianceEncoding& encoding) {
  InputHasher hasher;
  for (const double gain : encoding.white_balance) hasher.Add(gain);
  hasher.AddMatrix(encoding.camera_to_srgb);
  return fmt::format("white balance {} {} {} ({})", encoding.white_balance[0],
                     encoding.white_balance[1], encoding.white_balance[2], hasher.Text());
}

std::string Text(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string CameraHash(const RenderCamera& camera) {
  InputHasher hasher;
  hasher.Add(camera.pinhole.intrinsics);
  hasher.Add(camera.pinhole.cam_from_world);
  hasher.Add(camera.aperture.radius_w);
  hasher.Add(camera.aperture.blades);
  hasher.Add(camera.aperture.rotation_rad);
  hasher.AddMatrix(camera.focus_plane.normal);
  hasher.Add(camera.focus_plane.offset_w);
  return hasher.Text();
}

}  // namespace

RunInputs InputsOfRays(const LightField& light_field, const RunChoices& choices) {
  return {
      {"law", fmt::format("{}", kLawVersion)},
      {"estimator", NameOf(choices.reading.estimator)},
      {"filter",
       choices.reading.estimator == Estimator::kBilinear ? NameOf(choices.reading.filter) : "none"},
      {"lens_weights", NameOf(choices.lens_weights)},
      {"back_end", choices.back_end == CollectBackEnd::kFast ? "fast" : "reference"},
      {"seed", fmt::format("{}", choices.seed)},
      {"max_images", choices.max_image_count ? fmt::format("{}", *choices.max_image_count) : "all"},
      {"stop_when",
       choices.stop_at_samples ? fmt::format("samples>={}", *choices.stop_at_samples) : "never"},
      {"light_field.images", fmt::format("{}", light_field.size())},
      {"light_field.names", NamesHash(light_field)},
      {"light_field.calibration", CalibrationHash(light_field)},
      {"light_field.encoding", EncodingText(light_field.encoding)},
      {"light_field.colours", ColoursText(light_field.encoding)}};
}

RunInputs InputsOfCamera(FrameId frame, const RenderCamera& camera) {
  const PinholeCamera& pinhole = camera.pinhole;
  const Intrinsics& k = pinhole.intrinsics;
  return {{"frame", fmt::format("{}", frame.value)},
          {"frame.resolution", fmt::format("{} {}", k.width_px, k.height_px)},
          {"frame.fx_px", fmt::format("{}", k.fx_px)},
          {"frame.position", Text(pinhole.CentreWorld())},
          {"frame.forward", Text(pinhole.ForwardWorld())},
          {"frame.up", Text(pinhole.UpWorld())},
          {"frame.aperture_diameter_w", fmt::format("{}", 2 * camera.aperture.radius_w)},
          {"frame.blades", fmt::format("{}", camera.aperture.blades)},
          {"frame.focus_distance_w", fmt::format("{}", camera.focus_distance_w)},
          {"frame.focus_plane",
           fmt::format("{} {}", Text(camera.focus_plane.normal), camera.focus_plane.offset_w)},
          {"frame.camera", CameraHash(camera)}};
}

RunInputs InputsOfPicture(const RunChoices& choices) {
  return {{"picture.format", choices.format},
          {"picture.smooth_below", fmt::format("{}", choices.smooth_below)}};
}

std::optional<InputDifference> FirstDifference(const RunInputs& recorded, const RunInputs& wanted) {
  const auto value_in = [](const RunInputs& inputs, const std::string& key) -> std::string {
    for (const auto& [name, value] : inputs)
      if (name == key) return value;
    return "(none)";
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

// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/distortion_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr NumberRule kParameter = {"a distortion parameter within +-1e6",
                                   [](double x) { return std::abs(x) <= 1e6; }};
constexpr NumberRule kOmega = {"the lens's field of view in radians, above 0 and below pi",
                               [](double x) { return x >= 0 && x < 3.1415; }};

constexpr const char* kRadialTangentialKeys[] = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
constexpr const char* kBrownKeys[] = {"k1", "k2", "p1", "p2", "k3", "k4"};
constexpr const char* kFisheyeKeys[] = {"k1", "k2", "k3", "k4"};
constexpr const char* kOmegaKey = "lf_fov_omega";
constexpr const char* kDivisionKeys[] = {"k1"};
constexpr const char* kUnifiedKeys[] = {"lf_eucm_alpha", "lf_eucm_beta"};
constexpr const char* kThinPrismKeys[] = {"k1", "k2", "p1", "p2", "k3", "k4", "lf_sx1", "lf_sy1"};
// Key k1 is COLMAP's k0, because in every model here k1 is the factor of theta^2 (or r^2). The
// tangential terms have keys of their own, because COLMAP's p0 and p1 are OpenCV's p2 and p1.
constexpr const char* kRadialTangentialThinPrismKeys[] = {
    "k1", "k2", "k3", "k4", "k5", "k6", "lf_p0", "lf_p1", "lf_s0", "lf_s1", "lf_s2", "lf_s3"};

// The keys of all distortion parameters; DistortionKeys::values has the same order.
constexpr std::array kKeys = {"k1",           "k2",     "k3",     "k4",      "k5",
                              "k6",           "p1",     "p2",     kOmegaKey, "lf_eucm_alpha",
                              "lf_eucm_beta", "lf_sx1", "lf_sy1", "lf_p0",   "lf_p1",
                              "lf_s0",        "lf_s1",  "lf_s2",  "lf_s3"};
static_assert(kKeys.size() == std::tuple_size_v<decltype(DistortionKeys::values)>);

constexpr CameraModelName kModels[] = {
    {"PINHOLE", DistortionModel::kNone, 0},
    {"SIMPLE_PINHOLE", DistortionModel::kNone, 0},
    {"SIMPLE_RADIAL", DistortionModel::kRadialTangential, 1},
    {"RADIAL", DistortionModel::kRadialTangential, 2},
    {"OPENCV", DistortionModel::kRadialTangential, 5},
    {"FULL_OPENCV", DistortionModel::kRadialTangential, 8},
    {"OPENCV_FISHEYE", DistortionModel::kFisheye, 4},
    {"SIMPLE_RADIAL_FISHEYE", DistortionModel::kFisheye, 1},
    {"RADIAL_FISHEYE", DistortionModel::kFisheye, 2},
    {"FOV", DistortionModel::kFov, 1},
    {"SIMPLE_FISHEYE", DistortionModel::kFisheye, 0},
    {"FISHEYE", DistortionModel::kFisheye, 0},
    {"SIMPLE_DIVISION", DistortionModel::kDivision, 1},
    {"DIVISION", DistortionModel::kDivision, 1},
    {"EUCM", DistortionModel::kUnified, 2},
    {"THIN_PRISM_FISHEYE", DistortionModel::kThinPrism, 8},
    {"RAD_TAN_THIN_PRISM_FISHEYE", DistortionModel::kRadialTangentialThinPrism, 12},
    {"BROWN", DistortionModel::kBrown, 6},
};

const CameraModelName& ModelNamed(std::string_view name) {
  const auto* found = std::find_if(std::begin(kModels), std::end(kModels),
                                   [&](const CameraModelName& m) { return m.name == name; });
  LF_CHECK(found != std::end(kModels));
  return *found;
}

std::string ModelNames() {
  std::vector<const char*> names;
  for (const CameraModelName& model : kModels) names.push_back(model.name);
  return fmt::format("one of {}; undistort images of other lenses first", fmt::join(names, ", "));
}

Result<CameraModelName> ResolveModel(const DistortionKeys& frame, const DistortionKeys& top,
                                     const JsonFields& fields) {
  const std::optional<uint8_t> index = frame.camera_model ? frame.camera_model : top.camera_model;
  const std::optional<bool> is_fisheye = frame.is_fisheye ? frame.is_fisheye : top.is_fisheye;
  if (!index) return ModelNamed(is_fisheye.value_or(false) ? "OPENCV_FISHEYE" : "OPENCV");
  const CameraModelName& model = kModels[*index];
  const bool is_of_fisheye = model.model == DistortionModel::kFisheye ||
                             model.model == DistortionModel::kThinPrism ||
                             model.model == DistortionModel::kRadialTangentialThinPrism;
  if (is_fisheye && *is_fisheye != is_of_fisheye)
    return fields.Fault(
        fmt::format("\"is_fisheye\" is {}, \"camera_model\" is \"{}\": they contradict each other, "
                    "remove is_fisheye, or correct camera_model",
                    *is_fisheye, model.name));
  return model;
}

Error SurplusParameter(const CameraModelName& model, std::string_view key, double value,
                       const JsonFields& fields) {
  const bool is_open_cv = std::string_view(model.name) == "OPENCV";
  if (is_open_cv && key == "k4")
    return fields.Fault(fmt::format(
        "\"k4\" is {}, which is ambiguous with the camera model OPENCV: nerfstudio "
        "uses k4 as the coefficient of r^8, OpenCV as a coefficient of the "
        "denominator. For nerfstudio's k4, state \"camera_model\": \"BROWN\", for OpenCV's "
        "\"FULL_OPENCV\" (for a fish-eye lens \"OPENCV_FISHEYE\")",
        value));
  return fields.Fault(
      fmt::format("\"{}\" is {}, but \"camera_model\": \"{}\" has no such parameter: expected 0, "
                  "or remove the key{}",
                  key, value, model.name, is_open_cv ? " (FULL_OPENCV has k1 to k6, p1, p2)" : ""));
}

}  // namespace

std::span<const char* const> ParameterKeys(DistortionModel model) {
  static constexpr const char* kFovKeys[] = {kOmegaKey};
  switch (model) {
    case DistortionModel::kRadialTangential:
      return kRadialTangentialKeys;
    case DistortionModel::kBrown:
      return kBrownKeys;
    case DistortionModel::kFisheye:
      return kFisheyeKeys;
    case DistortionModel::kFov:
      return kFovKeys;
    case DistortionModel::kDivision:
      return kDivisionKeys;
    case DistortionModel::kUnified:
      return kUnifiedKeys;
    case DistortionModel::kThinPrism:
      return kThinPrismKeys;
    case DistortionModel::kRadialTangentialThinPrism:
      return kRadialTangentialThinPrismKeys;
    case DistortionModel::kNone:
      break;
  }
  return {};
}

CameraModelName CameraModelOf(const Distortion& distortion) {
  const DistortionParameters& p = distortion.parameters;
  switch (distortion.model) {
    case DistortionModel::kNone:
      break;
    case DistortionModel::kRadialTangential: {
      if (p[5] != 0 || p[6] != 0 || p[7] != 0) return ModelNamed("FULL_OPENCV");
      CameraModelName open_cv = ModelNamed("OPENCV");
      if (p[4] == 0) open_cv.parameter_count = 4;
      return open_cv;
    }
    case DistortionModel::kFisheye:
      return ModelNamed("OPENCV_FISHEYE");
    case DistortionModel::kFov:
      return ModelNamed("FOV");
    case DistortionModel::kDivision:
      return ModelNamed("DIVISION");
    case DistortionModel::kUnified:
      return ModelNamed("EUCM");
    case DistortionModel::kThinPrism:
      return ModelNamed("THIN_PRISM_FISHEYE");
    case DistortionModel::kRadialTangentialThinPrism:
      return ModelNamed("RAD_TAN_THIN_PRISM_FISHEYE");
    case DistortionModel::kBrown:
      return ModelNamed("BROWN");
  }
  return ModelNamed("PINHOLE");
}

Result<DistortionKeys> ReadDistortionKeys(const JsonFields& fields) {
  DistortionKeys keys;
  LF_ASSIGN_OR_RETURN(const std::optional<std::string> name, fields.Text("camera_model"));
  if (name) {
    const auto* found = std::find_if(std::begin(kModels), std::end(kModels),
                                     [&](const CameraModelName& m) { return m.name == *name; });
    if (found == std::end(kModels)) return fields.Wrong("camera_model", ModelNames());
    keys.camera_model = static_cast<uint8_t>(found - std::begin(kModels));
  }
  LF_ASSIGN_OR_RETURN(keys.is_fisheye, fields.Bool("is_fisheye"));
  for (size_t i = 0; i < kKeys.size(); ++i) {
    const NumberRule& rule = kKeys[i] == std::string_view(kOmegaKey) ? kOmega : kParameter;
    LF_ASSIGN_OR_RETURN(keys.values[i], fields.Number(kKeys[i], rule));
  }
  return keys;
}

Result<Distortion> ResolveDistortion(const DistortionKeys& frame, const DistortionKeys& top,
                                     const JsonFields& fields) {
  LF_ASSIGN_OR_RETURN(const CameraModelName model, ResolveModel(frame, top, fields));
  const std::span<const char* const> keys = ParameterKeys(model.model).first(model.parameter_count);
  Distortion distortion;
  distortion.model = model.model;
  for (size_t i = 0; i < kKeys.size(); ++i) {
    const double value = frame.values[i].value_or(top.values[i].value_or(0));
    const auto found = std::find(keys.begin(), keys.end(), std::string_view(kKeys[i]));
    if (found != keys.end())
      distortion.parameters[found - keys.begin()] = value;
    else if (value != 0)
      return SurplusParameter(model, kKeys[i], value, fields);
  }
  if (model.model == DistortionModel::kFov && distortion.parameters[0] == 0)
    return fields.Fault(
        fmt::format("\"camera_model\" is \"FOV\", but \"{}\" is missing or 0: expected {}",
                    kOmegaKey, kOmega.expected));
  if (!IsDistortion(distortion))
    return fields.Fault(
        fmt::format("\"camera_model\" is \"{}\" with lf_eucm_alpha {} and lf_eucm_beta {}: "
                    "expected alpha from 0 to 1 and beta above 0",
                    model.name, distortion.parameters[0], distortion.parameters[1]));
  if (model.model == DistortionModel::kUnified && distortion.parameters[0] == 0)
    return Distortion{};
  const auto is_zero = [](double x) { return x == 0; };
  if ((model.model == DistortionModel::kRadialTangential ||
       model.model == DistortionModel::kBrown || model.model == DistortionModel::kDivision) &&
      std::all_of(distortion.parameters.begin(), distortion.parameters.end(), is_zero))
    return Distortion{};
  return distortion;
}

}  // namespace lf

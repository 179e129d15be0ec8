// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/tables/calibration_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <string_view>

#include "lf/storage/tables/stored_numbers.h"

namespace lf {
namespace {

// Name of each DistortionModel in the table of intrinsics, in the order of the enumeration.
constexpr const char* kModelNames[] = {
    "none",     "radial_tangential", "fisheye",    "fov",
    "division", "unified",           "thin_prism", "radial_tangential_thin_prism",
    "brown"};
// Name of each Transfer in the setting "transfer", in the order of the enumeration.
constexpr const char* kTransferNames[] = {"srgb", "linear", "response"};

Result<Intrinsics> ReadIntrinsicsRow(const Settings& settings, const Statement& row) {
  Intrinsics k;
  LF_ASSIGN_OR_RETURN(const int64_t width, row.Integer(0, 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(const int64_t height, row.Integer(1, 1, kMostSide_px));
  k.width_px = static_cast<int>(width);
  k.height_px = static_cast<int>(height);
  LF_ASSIGN_OR_RETURN(k.fx_px, row.Real(2));
  LF_ASSIGN_OR_RETURN(k.fy_px, row.Real(3));
  LF_ASSIGN_OR_RETURN(k.cx_px, row.Real(4));
  LF_ASSIGN_OR_RETURN(k.cy_px, row.Real(5));
  LF_ASSIGN_OR_RETURN(k.skew_px, row.Real(6));
  LF_ASSIGN_OR_RETURN(const std::string model, row.Text(7));
  LF_ASSIGN_OR_RETURN(const std::string parameters, row.Text(8));
  const auto* const name = std::find(std::begin(kModelNames), std::end(kModelNames), model);
  const auto numbers = ParseNumbers(parameters);
  if (name == std::end(kModelNames) || !numbers)
    return settings.Damaged(fmt::format(
        "a lens distortion is '{} {}', expected a known model and its numbers", model, parameters));
  k.distortion.model = static_cast<DistortionModel>(name - std::begin(kModelNames));
  // The parameters of the vignetting, if the lens has one, follow those of the distortion.
  const size_t of_distortion = StoredParameterCount(k.distortion.model);
  const size_t of_both = of_distortion + k.vignetting.v.size();
  if (numbers->size() != of_distortion && numbers->size() != of_both)
    return settings.Damaged(
        fmt::format("a lens distortion is '{} {}', expected {} or {} parameters", model, parameters,
                    of_distortion, of_both));
  const auto rest = numbers->begin() + static_cast<std::ptrdiff_t>(of_distortion);
  std::copy(numbers->begin(), rest, k.distortion.parameters.begin());
  std::copy(rest, numbers->end(), k.vignetting.v.begin());
  if (!IsCamera(k) || !IsStoredDistortion(k.distortion) || !IsFalloff(k))
    return settings.Damaged(fmt::format(
        "intrinsics are out of range: {} x {} pixels, focal lengths {} and {}, principal point {} "
        "{}, skew {}, lens distortion '{} {}'",
        k.width_px, k.height_px, k.fx_px, k.fy_px, k.cx_px, k.cy_px, k.skew_px, model, parameters));
  return k;
}

// Reads the settings "alpha" and "background", which older files lack.
Result<void> ReadAlpha(const Settings& settings, RadianceEncoding* encoding) {
  encoding->alpha = AlphaMeaningOf(settings.Text("alpha"));
  if (!encoding->alpha && !settings.Text("alpha").empty())
    return settings.Wrong("alpha", "mask, straight or premultiplied");
  if (settings.Text("background").empty()) return {};
  if (settings.Text("background") == kNoBackground) {
    encoding->background.emplace();
    encoding->keeps_opacity = true;
    return {};
  }
  LF_ASSIGN_OR_RETURN(const std::vector<double> background, settings.Numbers("background", 3, 3));
  encoding->background.emplace();
  for (size_t c = 0; c < 3; ++c) {
    if (!IsWithin(background[c], 0, kMostNumber))
      return settings.Wrong("background", "three radiances of at least 0");
    (*encoding->background)[c] = background[c];
  }
  return {};
}

}  // namespace

SettingList SettingsOfPixels(const LightField& light_field) {
  const RadianceEncoding& encoding = light_field.encoding;
  const Mat3& m = encoding.linear_srgb_from_camera;
  const std::optional<DepthRange>& depths = light_field.depth_range;
  return {{"unit_m", fmt::format("{}", light_field.unit_m)},
          {"depth_range", depths ? fmt::format("{} {}", depths->near_w, depths->far_w) : ""},
          {"bayer", NameOf(encoding.bayer)},
          {"transfer", kTransferNames[static_cast<int>(encoding.transfer)]},
          {"response", fmt::format("{}", fmt::join(encoding.response, " "))},
          {"black_level", fmt::format("{}", encoding.black_level)},
          {"white_level", encoding.white_level ? fmt::format("{}", *encoding.white_level) : ""},
          {"max_radiance", fmt::format("{}", encoding.max_radiance)},
          {"pedestal", fmt::format("{}", encoding.pedestal)},
          {"alpha", encoding.alpha ? NameOf(*encoding.alpha) : ""},
          {"clipped", encoding.masks_clipped ? "mask" : ""},
          {"footprint", encoding.footprint ? NameOf(*encoding.footprint) : ""},
          {"background", !encoding.background ? ""
                         : encoding.keeps_opacity
                             ? kNoBackground
                             : fmt::format("{}", fmt::join(*encoding.background, " "))},
          {"white_balance", fmt::format("{}", fmt::join(encoding.white_balance, " "))},
          {"camera_to_srgb", fmt::format("{} {} {} {} {} {} {} {} {}", m(0, 0), m(0, 1), m(0, 2),
                                         m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2))}};
}

Result<void> ReadPixelSettings(const Settings& settings, LightField* light_field) {
  LF_ASSIGN_OR_RETURN(light_field->unit_m, settings.Number("unit_m", 1e-9, 1e9));
  if (!settings.Text("depth_range").empty()) {
    LF_ASSIGN_OR_RETURN(const std::vector<double> range, settings.Numbers("depth_range", 2, 2));
    light_field->depth_range = DepthRange{range[0], range[1]};
  }
  RadianceEncoding& encoding = light_field->encoding;
  const std::optional<BayerPattern> bayer = BayerPatternOf(settings.Text("bayer"));
  if (!bayer && !settings.Text("bayer").empty()) return settings.Wrong("bayer", "such as RGGB");
  encoding.bayer = bayer.value_or(BayerPattern::kNone);
  LF_ASSIGN_OR_RETURN(const int transfer, settings.Word("transfer", kTransferNames));
  encoding.transfer = static_cast<Transfer>(transfer);
  const bool has_response = encoding.transfer == Transfer::kResponse;
  LF_ASSIGN_OR_RETURN(encoding.response,
                      settings.Numbers("response", has_response ? 2 : 0, has_response ? 65536 : 0));
  LF_ASSIGN_OR_RETURN(encoding.black_level,
                      settings.Number("black_level", -kMostNumber, kMostNumber));
  if (!settings.Text("white_level").empty()) {
    LF_ASSIGN_OR_RETURN(encoding.white_level,
                        settings.Number("white_level", encoding.black_level, kMostNumber));
  }
  LF_ASSIGN_OR_RETURN(encoding.max_radiance, settings.Number("max_radiance", 1e-9, kMostNumber));
  LF_ASSIGN_OR_RETURN(encoding.pedestal, settings.Number("pedestal", 0, kMostPedestal));
  LF_RETURN_IF_ERROR(ReadAlpha(settings, &encoding));
  encoding.masks_clipped = settings.Text("clipped") == "mask";
  if (!encoding.masks_clipped && !settings.Text("clipped").empty())
    return settings.Wrong("clipped", "mask");
  // Older files lack the setting "footprint".
  encoding.footprint = PixelFootprintOf(settings.Text("footprint"));
  if (!encoding.footprint && !settings.Text("footprint").empty())
    return settings.Wrong("footprint", "areas or points");
  LF_ASSIGN_OR_RETURN(const std::vector<double> balance, settings.Numbers("white_balance", 3, 3));
  std::copy(balance.begin(), balance.end(), encoding.white_balance.begin());
  LF_ASSIGN_OR_RETURN(const std::vector<double> matrix, settings.Numbers("camera_to_srgb", 9, 9));
  encoding.linear_srgb_from_camera =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.data());
  return {};
}

Result<void> WriteIntrinsics(const std::vector<Intrinsics>& intrinsics, Database* database) {
  LF_ASSIGN_OR_RETURN(
      Statement insert,
      database->Prepare("insert into intrinsics values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"));
  for (size_t i = 0; i < intrinsics.size(); ++i) {
    const Intrinsics& k = intrinsics[i];
    insert.Bind(0, static_cast<int64_t>(i)).Bind(1, int64_t{k.width_px});
    insert.Bind(2, int64_t{k.height_px}).Bind(3, k.fx_px).Bind(4, k.fy_px).Bind(5, k.cx_px);
    insert.Bind(6, k.cy_px).Bind(7, k.skew_px);
    insert.Bind(8, std::string_view(kModelNames[static_cast<int>(k.distortion.model)]));
    const auto stored =
        std::span(k.distortion.parameters).first(StoredParameterCount(k.distortion.model));
    std::string parameters = fmt::format("{}", fmt::join(stored, " "));
    if (!k.vignetting.is_none()) parameters += fmt::format(" {}", fmt::join(k.vignetting.v, " "));
    LF_RETURN_IF_ERROR(insert.Bind(9, std::string_view(parameters)).Run());
  }
  return {};
}

Result<std::vector<Intrinsics>> ReadIntrinsics(const Settings& settings, Database* database) {
  std::vector<Intrinsics> intrinsics;
  LF_RETURN_IF_ERROR(ForEachRow(
      *database,
      "select width, height, fx, fy, cx, cy, skew, distortion, parameters from intrinsics "
      "order by id",
      [&](const Statement& row) -> Result<void> {
        LF_ASSIGN_OR_RETURN(const Intrinsics k, ReadIntrinsicsRow(settings, row));
        intrinsics.push_back(k);
        return {};
      }));
  return intrinsics;
}

void BindCamera(const LightField& light_field, LfImageId id, int parameter, Statement* statement) {
  const LfCamera& camera = light_field.cameras[id.value];
  const Vec3 centre = light_field.Camera(id).CentreWorld();
  const auto pose = NumbersOfPose(camera.cam_from_world);
  statement->Bind(parameter, int64_t{camera.intrinsics_index});
  const std::string gains = fmt::format("{}", fmt::join(camera.gain.of_channels, " "));
  if (camera.gain.are_equal())
    statement->Bind(parameter + 1, double{camera.gain[0]});
  else
    statement->Bind(parameter + 1, std::string_view(gains));
  statement->Bind(parameter + 2, centre.x());
  statement->Bind(parameter + 3, centre.y()).Bind(parameter + 4, centre.z());
  statement->BindBlob(parameter + 5, BytesOf(std::span<const double>(pose)));
}

namespace {

// Reads the column of gains, which holds one number if all channels have the same gain, otherwise a
// text of three numbers.
Result<ChannelGains> ReadGains(const Settings& settings, const Statement& row, int column,
                               const std::string& name) {
  ChannelGains gains;
  std::vector<double> numbers;
  std::string text;
  if (const Result<double> one = row.Real(column)) {
    numbers.assign(3, *one);
    text = fmt::format("{}", *one);
  } else {
    LF_ASSIGN_OR_RETURN(text, row.Text(column));
    numbers = ParseNumbers(text).value_or(std::vector<double>());
  }
  const bool are_gains =
      numbers.size() == 3 && std::all_of(numbers.begin(), numbers.end(),
                                         [](double gain) { return IsWithin(gain, 1e-6, 1e6); });
  if (!are_gains)
    return settings.Damaged(fmt::format(
        "LF image '{}' has the gain '{}', expected one or three numbers from 1e-6 to 1e6", name,
        text));
  for (size_t c = 0; c < 3; ++c) gains[c] = static_cast<float>(numbers[c]);
  return gains;
}

}  // namespace

Result<LfCamera> ReadCamera(const Settings& settings, const Statement& row, int column,
                            const std::string& name, size_t intrinsics_count) {
  LfCamera camera;
  const auto last = static_cast<int64_t>(intrinsics_count) - 1;
  LF_ASSIGN_OR_RETURN(const int64_t intrinsics, row.Integer(column, 0, last));
  LF_ASSIGN_OR_RETURN(camera.gain, ReadGains(settings, row, column + 1, name));
  LF_ASSIGN_OR_RETURN(const std::string_view pose, row.Blob(column + 2));
  const std::vector<double> numbers = NumbersOf<double>(pose);
  if (numbers.size() != kPoseNumbers)
    return settings.Damaged(fmt::format("the pose of LF image {} has {} bytes, expected {}", name,
                                        pose.size(), kPoseNumbers * sizeof(double)));
  camera.cam_from_world = PoseOfNumbers(std::span<const double>(numbers).first<kPoseNumbers>());
  if (!IsPose(camera.cam_from_world))
    return settings.Damaged(
        fmt::format("the pose of LF image {} is no rotation and translation", name));
  if (name.empty()) return settings.Damaged("an LF image has no name");
  camera.intrinsics_index = static_cast<uint32_t>(intrinsics);
  return camera;
}

}  // namespace lf

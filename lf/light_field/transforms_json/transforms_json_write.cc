// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/light_field/transforms_json/distortion_keys.h"
#include "lf/light_field/transforms_json/json_text.h"
#include "lf/light_field/transforms_json/lf_keys.h"
#include "lf/light_field/transforms_json/opengl_pose.h"
#include "lf/light_field/transforms_json/transforms_json.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Writes camera_model and its parameters. Parameters that only `top` has are written as 0, because
// a reader would otherwise take them from `top`.
void AddDistortion(const Distortion& distortion, const Distortion& top, const char* separator,
                   JsonText* out) {
  const auto parameters = [](const Distortion& d, const CameraModelName& model) {
    std::vector<std::pair<std::string_view, double>> list;
    for (size_t i = 0; i < model.parameter_count; ++i)
      list.emplace_back(ParameterKeys(model.model)[i], d.parameters[i]);
    return list;
  };
  const CameraModelName model = CameraModelOf(distortion);
  auto list = parameters(distortion, model);
  for (const auto& of_top : parameters(top, CameraModelOf(top)))
    if (std::none_of(list.begin(), list.end(),
                     [&](const auto& parameter) { return parameter.first == of_top.first; }))
      list.emplace_back(of_top.first, 0);
  out->Add("\"camera_model\": \"{}\",{}", model.name, separator);
  for (const auto& [key, value] : list) {
    out->Add("\"{}\": ", key);
    out->AddNumber(value);
    out->Add(",{}", separator);
  }
}

// Writes the intrinsics `k` of the top level or of a frame. `top` are the intrinsics at the top
// level. lf_skew and lf_vignetting are left out if they are 0 in `k` and in `top`.
void AddIntrinsics(const Intrinsics& k, const Intrinsics& top, const char* separator,
                   JsonText* out) {
  AddDistortion(k.distortion, top.distortion, separator, out);
  if (k.skew_px != 0 || top.skew_px != 0) {
    out->Add("\"lf_skew\": ");
    out->AddNumber(k.skew_px);
    out->Add(",{}", separator);
  }
  const std::pair<const char*, double> numbers[] = {
      {"fl_x", k.fx_px}, {"fl_y", k.fy_px}, {"cx", k.cx_px}, {"cy", k.cy_px}};
  for (const auto& [key, value] : numbers) {
    out->Add("\"{}\": ", key);
    out->AddNumber(value);
    out->Add(",{}", separator);
  }
  if (!k.vignetting.is_none() || !top.vignetting.is_none()) {
    out->Add("\"lf_vignetting\": ");
    out->AddNumbers(k.vignetting.v);
    out->Add(",{}", separator);
  }
  out->Add("\"w\": {},{}\"h\": {}", k.width_px, separator, k.height_px);
}

void AddEncoding(const RadianceEncoding& encoding, JsonText* out) {
  const auto add_number = [out](const char* key, double value) {
    out->Add("\"{}\": ", key);
    out->AddNumber(value);
    out->Add(",\n");
  };
  if (encoding.bayer != BayerPattern::kNone)
    out->Add("\"lf_bayer\": \"{}\",\n", NameOf(encoding.bayer));
  if (encoding.transfer == Transfer::kResponse) {
    out->Add("\"lf_response\": ");
    out->AddNumbers(encoding.response);
    out->Add(",\n");
  } else {
    out->Add("\"lf_transfer\": \"{}\",\n",
             encoding.transfer == Transfer::kSrgb ? "sRGB" : "linear");
  }
  add_number("lf_black_level", encoding.black_level);
  if (encoding.white_level) add_number("lf_white_level", *encoding.white_level);
  add_number("lf_max_radiance", encoding.max_radiance);
  add_number("lf_pedestal", encoding.pedestal);
  if (encoding.alpha) out->Add("\"lf_alpha\": \"{}\",\n", NameOf(*encoding.alpha));
  if (encoding.footprint) out->Add("\"lf_pixels\": \"{}\",\n", NameOf(*encoding.footprint));
  if (encoding.masks_clipped) out->Add("\"lf_clipped\": \"mask\",\n");
  if (encoding.background && encoding.keeps_opacity) {
    out->Add("\"lf_background\": \"{}\",\n", kNoBackground);
  } else if (encoding.background) {
    out->Add("\"lf_background\": ");
    out->AddNumbers(*encoding.background);
    out->Add(",\n");
  }
  out->Add("\"lf_white_balance\": ");
  out->AddNumbers(encoding.white_balance);
  out->Add(",\n\"lf_camera_to_srgb\": ");
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = encoding.linear_srgb_from_camera;
  out->AddMatrix({rows.data(), 9}, 3);
  out->Add(",\n");
}

void AddPose(const RigidTransform& cam_from_world, JsonText* out) {
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = Eigen::Matrix4d::Identity();
  const Mat34 pose = OpenGlOfCamFromWorld(cam_from_world);
  rows.topRows<3>() = pose;
  out->Add("\"transform_matrix\": ");
  out->AddMatrix({rows.data(), 16}, 4);
  // The conversion to a centre and back changes the last bit of most translations; lf_translation
  // states these exactly.
  const Result<RigidTransform> read_back = CamFromWorldOfOpenGl(pose);
  if (read_back && read_back->translation == cam_from_world.translation) return;
  out->Add(", \"lf_translation\": ");
  out->AddNumbers({cam_from_world.translation.data(), 3});
}

// Writes lf_gain: one number if all channels have the same gain, as in most light fields, and
// nothing if this gain is 1.
void AddGains(const LfCamera& camera, JsonText* out) {
  const std::array<double, 3> gains = {camera.gain[0], camera.gain[1], camera.gain[2]};
  if (!camera.gain.are_equal()) {
    out->Add(", \"lf_gain\": ");
    out->AddNumbers(gains);
  } else if (gains[0] != 1) {
    out->Add(", \"lf_gain\": {}", gains[0]);
  }
}

Result<void> AddFrame(const LightField& light_field, size_t index, JsonText* out) {
  const std::string& name = light_field.image_names[index];
  if (!fs::path(name).has_extension())
    return OutputError(
        fmt::format("the image name \"{}\" has no extension, so that \"{}.png\" would be read "
                    "instead: rename the file",
                    name, name));
  const LfCamera& camera = light_field.cameras[index];
  out->Add("{{\"file_path\": ");
  LF_RETURN_IF_ERROR(out->AddString(name));
  out->Add(", ");
  AddPose(camera.cam_from_world, out);
  const uint32_t top_index = light_field.cameras[0].intrinsics_index;
  if (camera.intrinsics_index != top_index) {
    out->Add(", ");
    AddIntrinsics(light_field.intrinsics[camera.intrinsics_index],
                  light_field.intrinsics[top_index], " ", out);
  }
  AddGains(camera, out);
  if (!light_field.times.empty()) {
    out->Add(", \"time\": ");
    out->AddNumber(light_field.times[index]);
  }
  if (!light_field.mask_names.empty() && !light_field.mask_names[index].empty()) {
    out->Add(", \"lf_mask\": ");
    LF_RETURN_IF_ERROR(out->AddString(light_field.mask_names[index]));
  }
  out->Add("}}");
  return {};
}

Result<std::string> TransformsJsonText(const LightField& light_field) {
  JsonText out;
  out.Add("{{\n");
  const Intrinsics& top = light_field.intrinsics[light_field.cameras[0].intrinsics_index];
  AddIntrinsics(top, top, "\n", &out);
  out.Add(",\n");
  AddEncoding(light_field.encoding, &out);
  if (light_field.depth_range) {
    out.Add("\"lf_depth_range\": ");
    out.AddNumbers(std::array{light_field.depth_range->near_w, light_field.depth_range->far_w});
    out.Add(",\n");
  }
  out.Add("\"lf_unit_m\": {},\n\"frames\": [\n", light_field.unit_m);
  for (size_t i = 0; i < light_field.size(); ++i) {
    LF_RETURN_IF_ERROR(AddFrame(light_field, i, &out));
    out.Add("{}", i + 1 < light_field.size() ? ",\n" : "\n");
  }
  out.Add("]\n}}\n");
  return out.text();
}

// Returns the 64-bit FNV-1a hash of the text, which shows whether a file was edited after it was
// written.
uint64_t ChecksumOf(std::string_view text) {
  uint64_t sum = 0xcbf29ce484222325;
  for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return sum;
}

// Returns the first lines of a file that `writer` wrote. `rest` is the text behind them.
std::string SignedOpening(std::string_view writer, std::string_view rest) {
  return fmt::format("{{\n\"lf_written_by\": \"{} {:016x}\",\n", writer, ChecksumOf(rest));
}

constexpr std::string_view kOpening = "{\n";

}  // namespace

Result<void> WriteTransformsJson(const LightField& light_field, const fs::path& path,
                                 std::string_view writer) {
  LF_CHECK(light_field.size() > 0 && light_field.image_names.size() == light_field.size());
  LF_CHECK(!HasVirtual(light_field));  // the file has no key for the mark
  Result<std::string> text = TransformsJsonText(light_field);
  if (!text) return OutputError(fmt::format("{}: {}", path.string(), text.error().message));
  if (!writer.empty()) {
    const std::string opening =
        SignedOpening(writer, std::string_view(*text).substr(kOpening.size()));
    text->replace(0, kOpening.size(), opening);
  }
  return WriteFileAtomically(path, *text);
}

Result<bool> IsAsWritten(const fs::path& path, std::string_view writer) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path));
  const size_t size = SignedOpening(writer, "").size();  // the size does not depend on the text
  if (text.size() < size) return false;
  return std::string_view(text).substr(0, size) ==
         SignedOpening(writer, std::string_view(text).substr(size));
}

}  // namespace lf

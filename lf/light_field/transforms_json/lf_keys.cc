// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/lf_keys.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lf/core/log.h"
#include "lf/light_field/model/brackets.h"

namespace lf {
namespace {

constexpr NumberRule kStoredValue = {"a stored value from 0 to 65535",
                                     [](double x) { return x >= 0 && x <= 65535; }};
constexpr NumberRule kBalance = {"above 0 and at most 1000",
                                 [](double x) { return x > 0 && x <= 1000; }};
constexpr NumberRule kMatrixEntry = {"within +-1000", [](double x) { return std::abs(x) <= 1000; }};
constexpr NumberRule kRadiance = {"within +-1e6", [](double x) { return std::abs(x) <= 1e6; }};
constexpr NumberRule kLight = {"radiances from 0 to 1e6",
                               [](double x) { return x >= 0 && x <= 1e6; }};
constexpr double kMostMaxRadiance = 1e6;
constexpr NumberRule kMaxRadiance = {"a radiance from 1e-6 to 1e6",
                                     [](double x) { return x >= 1e-6 && x <= kMostMaxRadiance; }};
constexpr NumberRule kPedestal = {"a whole number from 0 to 32767", [](double x) {
                                    return x >= 0 && x <= kMostPedestal && x == std::floor(x);
                                  }};

Result<BayerPattern> ReadBayer(const JsonFields& top, BayerPattern otherwise) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::string> name, top.Text("lf_bayer"));
  if (!name) return otherwise;
  const std::optional<BayerPattern> bayer = BayerPatternOf(*name);
  if (!bayer)
    return top.Wrong("lf_bayer", "RGGB, BGGR, GRBG or GBRG, the upper left 2x2 pixels row by row");
  return *bayer;
}

// Reads lf_transfer and lf_response.
Result<void> ReadTransfer(const JsonFields& top, RadianceEncoding* encoding) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::string> name, top.Text("lf_transfer"));
  LF_ASSIGN_OR_RETURN(std::optional<std::vector<double>> response,
                      top.Numbers("lf_response", 2, 65536, kRadiance));
  if (name && *name != "sRGB" && *name != "linear")
    return top.Wrong("lf_transfer", "\"sRGB\" or \"linear\", or lf_response instead");
  if (name && response)
    return top.Fault("\"lf_transfer\" and \"lf_response\" contradict each other: give one of them");
  if (response) {
    if (!std::is_sorted(response->begin(), response->end()) ||
        response->front() == response->back())
      return top.Wrong("lf_response", "radiances that rise with the stored value");
    encoding->transfer = Transfer::kResponse;
    encoding->response = *std::move(response);
  } else if (name) {
    encoding->transfer = *name == "sRGB" ? Transfer::kSrgb : Transfer::kLinear;
  } else if (encoding->bayer != BayerPattern::kNone) {
    encoding->transfer = Transfer::kLinear;
  }
  return {};
}

Result<void> ReadLevels(const JsonFields& top, RadianceEncoding* encoding) {
  LF_ASSIGN_OR_RETURN(const std::optional<double> black,
                      top.Number("lf_black_level", kStoredValue));
  LF_ASSIGN_OR_RETURN(const std::optional<double> white,
                      top.Number("lf_white_level", kStoredValue));
  if (black) encoding->black_level = *black;
  if (white) encoding->white_level = white;
  if (!LevelsFit(*encoding, 16))
    return top.Fault(
        fmt::format("\"lf_black_level\" is {}: expected less than lf_white_level, which is {}",
                    encoding->black_level, encoding->white_level.value_or(65535)));
  return {};
}

Result<void> ReadColour(const JsonFields& top, RadianceEncoding* encoding) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> balance,
                      top.Numbers("lf_white_balance", 3, 3, kBalance));
  if (balance) std::copy(balance->begin(), balance->end(), encoding->white_balance.begin());
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> matrix,
                      top.Matrix("lf_camera_to_srgb", 3, 3, 3, kMatrixEntry));
  if (!matrix) return {};
  encoding->linear_srgb_from_camera =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix->data());
  if (!(std::abs(encoding->linear_srgb_from_camera.determinant()) > 1e-9))
    return top.Wrong("lf_camera_to_srgb", "an invertible matrix");
  return {};
}

Result<void> ReadAlpha(const JsonFields& top, RadianceEncoding* encoding) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::string> name, top.Text("lf_alpha"));
  if (name) encoding->alpha = AlphaMeaningOf(*name);
  if (name && !encoding->alpha)
    return top.Wrong("lf_alpha", "\"mask\", \"straight\" or \"premultiplied\"");
  if (!top.Has("lf_background")) return {};
  if (encoding->alpha == AlphaMeaning::kMask)
    return top.Fault(
        "\"lf_background\" cannot be used with lf_alpha \"mask\", whose pixels are either used or "
        "left out: remove lf_background, or state lf_alpha \"straight\" or \"premultiplied\"");
  encoding->background.emplace();
  if (!top.ListSize("lf_background")) {
    const Result<std::optional<std::string>> word = top.Text("lf_background");
    if (!word || *word != kNoBackground)
      return top.Wrong("lf_background", "three radiances, or \"none\"");
    encoding->keeps_opacity = true;
    return {};
  }
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> background,
                      top.Numbers("lf_background", 3, 3, kLight));
  if (!background) return {};
  std::copy(background->begin(), background->end(), encoding->background->begin());
  return {};
}

Result<void> ReadClipped(const JsonFields& top, RadianceEncoding* encoding) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::string> name, top.Text("lf_clipped"));
  if (name && *name != "mask" && *name != "keep")
    return top.Wrong("lf_clipped", "\"mask\" or \"keep\"");
  encoding->masks_clipped = name == "mask";
  return {};
}

Result<void> ReadFootprint(const JsonFields& top, RadianceEncoding* encoding) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::string> name, top.Text("lf_pixels"));
  if (name) encoding->footprint = PixelFootprintOf(*name);
  if (name && !encoding->footprint) return top.Wrong("lf_pixels", "\"areas\" or \"points\"");
  return {};
}

// Returns the encoding whose values the keys then replace: if a key of the Bayer pattern, levels or
// colours is missing and the first image is a camera raw file, the encoding of this file, otherwise
// the default encoding.
Result<RadianceEncoding> DefaultEncoding(const JsonFields& top, const LightField& light_field,
                                         const RawFactsSource& raw_facts) {
  const auto stated = [&](const auto&... keys) { return (... && top.Has(keys)); };
  const bool levels_stated = stated("lf_black_level", "lf_white_level");
  const bool colours_stated = stated("lf_white_balance", "lf_camera_to_srgb");
  if (!raw_facts || (stated("lf_bayer") && levels_stated && colours_stated))
    return RadianceEncoding();
  LF_ASSIGN_OR_RETURN(const std::optional<RawFacts> facts, raw_facts(light_field));
  if (!facts) return RadianceEncoding();
  WarnOfUnknown(light_field, *facts, levels_stated, colours_stated);
  return EncodingOfRaw(*facts);
}

// Returns max_radiance for a file that does not state it. Warns if it clips recorded light.
double DefaultMaxRadianceOf(const JsonFields& top, const LightField& light_field,
                            const RadianceEncoding& encoding) {
  const double white = std::min(BrightestWhite(light_field, encoding), kMostMaxRadiance);
  if (white > kFloatMaxRadiance)
    LogWarning(
        "{}",
        top.Fault(fmt::format("gains (lf_gain, lf_vignetting) make white as bright as {}, but "
                              "light above {} is clipped, because \"lf_max_radiance\" is missing: "
                              "add \"lf_max_radiance\": {} to keep all light, or another limit",
                              white, kFloatMaxRadiance, white))
            .message);
  return std::max(DefaultMaxRadiance(light_field.image_names), std::min(white, kFloatMaxRadiance));
}

}  // namespace

Result<RadianceEncoding> ReadEncoding(const JsonFields& top, const LightField& light_field,
                                      const RawFactsSource& raw_facts) {
  LF_ASSIGN_OR_RETURN(RadianceEncoding encoding, DefaultEncoding(top, light_field, raw_facts));
  LF_ASSIGN_OR_RETURN(encoding.bayer, ReadBayer(top, encoding.bayer));
  LF_RETURN_IF_ERROR(ReadTransfer(top, &encoding));
  LF_RETURN_IF_ERROR(ReadLevels(top, &encoding));
  LF_RETURN_IF_ERROR(ReadColour(top, &encoding));
  LF_RETURN_IF_ERROR(ReadAlpha(top, &encoding));
  LF_RETURN_IF_ERROR(ReadClipped(top, &encoding));
  LF_RETURN_IF_ERROR(ReadFootprint(top, &encoding));
  LF_ASSIGN_OR_RETURN(const std::optional<double> max_radiance,
                      top.Number("lf_max_radiance", kMaxRadiance));
  LF_ASSIGN_OR_RETURN(const std::optional<double> pedestal, top.Number("lf_pedestal", kPedestal));
  encoding.max_radiance =
      max_radiance ? *max_radiance : DefaultMaxRadianceOf(top, light_field, encoding);
  encoding.pedestal = pedestal.value_or(encoding.black_level > 0 ? kRawPedestal : 0);
  return encoding;
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/radiance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "lf/core/check.h"
#include "lf/core/value_named.h"
#include "lf/pixels/files/picture_view.h"

namespace lf {
namespace {

constexpr const char* kBayerNames[] = {"", "RGGB", "BGGR", "GRBG", "GBRG"};
// The names are in the order of AlphaMeaning.
constexpr const char* kAlphaNames[] = {"mask", "straight", "premultiplied"};

// The names are in the order of PixelFootprint.
constexpr const char* kFootprintNames[] = {"areas", "points"};

double LargestStorable(int bits) { return bits == 8 ? 255 : 65535; }

double WhiteLevel(const RadianceEncoding& encoding, int bits) {
  return encoding.white_level.value_or(LargestStorable(bits));
}

// Returns the radiance of a stored value, given as its position x: 0 at the black level and 1 at
// the white level.
double RadianceOfResponse(const std::vector<double>& response, double x) {
  if (x >= 1) return response.back();
  const double position = x * static_cast<double>(response.size() - 1);
  const size_t segment = static_cast<size_t>(std::max(0.0, position));
  const double slope = response[segment + 1] - response[segment];
  return response[segment] + slope * (position - static_cast<double>(segment));
}

double RadianceOf(const RadianceEncoding& encoding, double x) {
  switch (encoding.transfer) {
    case Transfer::kSrgb:
      return LinearFromSrgb(x);
    case Transfer::kLinear:
      return x;
    case Transfer::kResponse:
      return RadianceOfResponse(encoding.response, x);
  }
  return x;
}

}  // namespace

void MakeRoomForUndershoot(RadianceEncoding* encoding) {
  encoding->pedestal = std::max(encoding->pedestal, kUndershootPedestal);
}

void MakeRoomBesideEdges(std::span<const std::string> image_names, RadianceEncoding* encoding) {
  encoding->pedestal = std::max(encoding->pedestal, kRoomPedestal);
  const bool has_room_above = DefaultMaxRadiance(image_names) > 1 && encoding->max_radiance >= 4;
  if (!has_room_above) encoding->overshoot_room = 2;
}

const char* NameOf(BayerPattern bayer) { return kBayerNames[static_cast<int>(bayer)]; }

std::optional<BayerPattern> BayerPatternOf(const std::string& name) {
  return ValueNamed(
      name, {BayerPattern::kRggb, BayerPattern::kBggr, BayerPattern::kGrbg, BayerPattern::kGbrg});
}

const char* NameOf(AlphaMeaning alpha) { return kAlphaNames[static_cast<int>(alpha)]; }

std::optional<AlphaMeaning> AlphaMeaningOf(const std::string& name) {
  return ValueNamed(name,
                    {AlphaMeaning::kMask, AlphaMeaning::kStraight, AlphaMeaning::kPremultiplied});
}

const char* NameOf(PixelFootprint footprint) {
  return kFootprintNames[static_cast<int>(footprint)];
}

std::optional<PixelFootprint> PixelFootprintOf(const std::string& name) {
  return ValueNamed(name, {PixelFootprint::kArea, PixelFootprint::kPoint});
}

std::string TextOfAlpha(AlphaMeaning alpha, const std::array<double, 3>& background,
                        bool keeps_opacity) {
  if (alpha == AlphaMeaning::kMask) return "a mask";
  const auto all = [&](double value) {
    return background == std::array<double, 3>{value, value, value};
  };
  return fmt::format("{} light over {}", NameOf(alpha),
                     keeps_opacity ? "nothing"
                     : all(0)      ? "black"
                     : all(1)      ? "white"
                              : fmt::format("{:.4g}, {:.4g}, {:.4g}", background[0], background[1],
                                            background[2]));
}

double LinearFromSrgb(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

double SrgbFromLinear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double DefaultMaxRadiance(std::span<const std::string> image_names) {
  const auto is_float_file = [](const std::string& name) {
    std::string extension = FileOfImage(name).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".exr" || extension == ".hdr" || extension == ".pfm";
  };
  return std::any_of(image_names.begin(), image_names.end(), is_float_file) ? kFloatMaxRadiance : 1;
}

bool LevelsFit(const RadianceEncoding& encoding, int bits) {
  const double white_level = WhiteLevel(encoding, bits);
  return encoding.black_level < white_level && white_level <= LargestStorable(bits);
}

double ClippedFrom(const RadianceEncoding& encoding, int bits) {
  constexpr double kClippedShare = 0.99;
  const double black = encoding.black_level;
  return black + kClippedShare * (WhiteLevel(encoding, bits) - black);
}

std::vector<double> LightTable(const RadianceEncoding& encoding, int bits) {
  LF_CHECK(bits == 8 || bits == 16);
  LF_CHECK(LevelsFit(encoding, bits));
  LF_CHECK(encoding.transfer != Transfer::kResponse || encoding.response.size() >= 2);
  const double range = WhiteLevel(encoding, bits) - encoding.black_level;
  std::vector<double> table(size_t{1} << bits);
  for (size_t stored = 0; stored < table.size(); ++stored)
    table[stored] =
        RadianceOf(encoding, (static_cast<double>(stored) - encoding.black_level) / range);
  return table;
}

std::vector<uint16_t> RadianceTable(const RadianceEncoding& encoding, int bits, double gain) {
  const std::vector<double> light = LightTable(encoding, bits);
  std::vector<uint16_t> table(light.size());
  for (size_t stored = 0; stored < table.size(); ++stored)
    table[stored] = QuantizeRadiance(encoding, light[stored], gain);
  return table;
}

uint16_t QuantizeRadiance(const RadianceEncoding& encoding, double radiance, double gain) {
  const double light = std::isnan(radiance) ? 0 : radiance;
  const double kept = std::min(light * gain, encoding.max_radiance);
  const double v = std::round(kept * encoding.Scale()) + encoding.pedestal;
  return static_cast<uint16_t>(std::clamp(v, 0.0, 65535.0));
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Converts stored numbers to light, as the table "What is added" of doc/ray.md says.
//
// Radiance is linear light, 1 = display white. Collection kernels add it as a 16-bit integer
//   v = clip(round(min(radiance * gain, max_radiance) * scale) + pedestal, 0, 65535)
// `gain` is lf_gain of the channel, divided by the falloff of the lens at the pixel's centre if the
// camera has lf_vignetting (camera/vignetting.h). One scale and one pedestal hold for the whole
// light field, so that sums of different images can be added. Values below black are noise that
// must average to black; the pedestal preserves them.
//
// This is the only place where recorded light is clipped. Filters and programs that need more room
// in the 16 bits, because they overshoot, change the scale and the pedestal but not max_radiance:
// all of them keep the same light.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/image.h"

namespace lf {

enum class Transfer : uint8_t {
  kSrgb,      // the curve of sRGB (IEC 61966-2-1)
  kLinear,    // radiance = (stored - black) / (white - black)
  kResponse,  // a measured curve: linear radiance at evenly spaced stored values
};

// The meaning of the alpha of LF images.
enum class AlphaMeaning : uint8_t {
  kMask,  // pixels with alpha below one half send no ray; alpha does not change colours
  // Alpha is the share of the light from behind that the object covers; the colours are those of
  // the object.
  kStraight,
  kPremultiplied,  // like kStraight, but the radiance of the colours is already times alpha
};

// The light that an LF pixel shows.
enum class PixelFootprint : uint8_t {
  kArea,   // the mean light of the pixel's area, as in a photograph
  kPoint,  // the light at the pixel's centre, as in a rendered image without anti-aliasing
};

// How the pixels of a light field are stored (keys lf_*, doc/formats/transforms_json.md).
// Float files hold radiance itself: transfer and levels do not apply to them.
struct RadianceEncoding {
  BayerPattern bayer = BayerPattern::kNone;
  Transfer transfer = Transfer::kSrgb;
  // For Transfer::kResponse: radiances of two or more stored values, evenly spaced from black_level
  // to white_level.
  std::vector<double> response;
  double black_level = 0;             // stored value of no light
  std::optional<double> white_level;  // stored value of radiance 1; default: the largest storable
  double max_radiance = 1;            // brighter light (after gain) is clipped at it
  double overshoot_room = 1;          // v = 65535 is the radiance max_radiance * overshoot_room
  double pedestal = 0;  // 16-bit value v of no light; if above 0, values below black are kept
  std::optional<AlphaMeaning> alpha;  // meaning of the alpha channel; default: kMask
  // Radiance of R, G and B behind LF pixels that alpha does not cover completely; default: black.
  std::optional<std::array<double, 3>> background;
  // True if nothing is behind the LF pixels: `background` is black, and frames have an opacity
  // channel.
  bool keeps_opacity = false;
  // True if LF images of one pose with different exposures form one picture. Each pixel is taken
  // from the brightest LF image in which it is not clipped (light_field/model/brackets.h).
  bool masks_clipped = false;
  std::optional<PixelFootprint> footprint;  // unset if unknown (storage/load/measure_footprint.h)
  std::array<double, 3> white_balance = {1, 1, 1};  // factors of R, G, B, applied on developing
  Mat3 linear_srgb_from_camera = Mat3::Identity();  // maps white balanced camera RGB to linear sRGB

  // Returns the number of steps of the 16-bit value v per unit of radiance.
  double Scale() const { return (65535 - pedestal) / (max_radiance * overshoot_room); }
  // Returns true if alpha is an opacity, so that LF pixels are composed with the background
  // (storage/load/opacities.h).
  bool AlphaIsLight() const { return alpha.value_or(AlphaMeaning::kMask) != AlphaMeaning::kMask; }
  // Returns true if LF images have opacities to be collected (LfPixels::opacity).
  bool HasOpacity() const { return AlphaIsLight() && keeps_opacity; }
  std::array<double, 3> Background() const { return background.value_or(std::array{0., 0., 0.}); }

  friend bool operator==(const RadianceEncoding&, const RadianceEncoding&) = default;
};

// Largest allowed pedestal. It leaves at least half of the 16-bit range to light.
inline constexpr double kMostPedestal = 32767;

// Raises a lower pedestal to kUndershootPedestal, which leaves room for a fifteenth of max_radiance
// below black. Bicubic interpolation and demosaicking undershoot beside bright lights; if the
// values were clipped at black, dark surroundings of small lights would turn grey.
inline constexpr double kUndershootPedestal = 4096;
void MakeRoomForUndershoot(RadianceEncoding* encoding);

// Makes more room than MakeRoomForUndershoot(), also above white, because prefilters undershoot and
// overshoot more than bicubic interpolation. Raises a lower pedestal to kRoomPedestal, a quarter of
// the range. Sets overshoot_room to 2, unless LF images are float files with a max_radiance of at
// least 4, because these hardly have values near max_radiance.
inline constexpr double kRoomPedestal = 16384;
void MakeRoomBesideEdges(std::span<const std::string> image_names, RadianceEncoding* encoding);

// Converts a Bayer pattern to and from the words of lf_bayer, "RGGB" ...; kNone is written "".
// Returns nullopt for words that are no pattern.
const char* NameOf(BayerPattern bayer);
std::optional<BayerPattern> BayerPatternOf(const std::string& name);

// Converts a meaning of alpha to and from the words of lf_alpha, "mask", "straight" and
// "premultiplied". Returns nullopt for other words.
const char* NameOf(AlphaMeaning alpha);
std::optional<AlphaMeaning> AlphaMeaningOf(const std::string& name);

// Converts a footprint to and from the words of lf_pixels, "areas" and "points". Returns nullopt
// for other words.
const char* NameOf(PixelFootprint footprint);
std::optional<PixelFootprint> PixelFootprintOf(const std::string& name);

// The word that a user writes instead of a background to set RadianceEncoding::keeps_opacity.
inline constexpr const char* kNoBackground = "none";

// Returns a text that describes alpha to people: "a mask", "straight light over black",
// "premultiplied light over 1, 0.5, 0", "straight light over nothing".
//   background, keeps_opacity  as in RadianceEncoding; unused for a mask
std::string TextOfAlpha(AlphaMeaning alpha, const std::array<double, 3>& background,
                        bool keeps_opacity);

// Convert an sRGB value in [0, 1] to linear light, and back.
double LinearFromSrgb(double srgb);
double SrgbFromLinear(double linear);

// Returns max_radiance for LF images with the gain 1 and no falloff. 16 if an image is a float file
// (its name ends in .exr, .hdr or .pfm): highlights up to 16 times display white are kept, and
// black to white still has 4096 steps. Otherwise 1, which white of integer files is.
inline constexpr double kFloatMaxRadiance = 16;
double DefaultMaxRadiance(std::span<const std::string> image_names);

// Returns true if files with `bits` bits can hold the levels: black < white <= the largest storable
// value.
bool LevelsFit(const RadianceEncoding& encoding, int bits);

// Returns the smallest stored value that counts as clipped. It lies below white by a hundredth of
// the range from black to white, because JPEG, noise and demosaicking do not keep the largest value
// exactly. bits: 8 or 16; LevelsFit(encoding, bits) must be true. Float files have no such value.
double ClippedFrom(const RadianceEncoding& encoding, int bits);

// Returns the 16-bit radiance v for every stored value of 8 or 16-bit files: 256 or 65536 entries.
// Halves round away from zero, which keeps noise around black symmetric. Outside the levels, sRGB
// and linear are extrapolated; a response curve continues with its first slope below black and
// holds its last value above white. bits: 8 or 16; LevelsFit(encoding, bits) must be true.
std::vector<uint16_t> RadianceTable(const RadianceEncoding& encoding, int bits, double gain);

// Returns, for every stored value, the linear radiance before gain and falloff; RadianceTable()
// multiplies it by the gain and rounds it. bits: as for RadianceTable().
std::vector<double> LightTable(const RadianceEncoding& encoding, int bits);

// Returns the 16-bit radiance v for a radiance of a float file. NaN counts as no light and becomes
// the pedestal.
uint16_t QuantizeRadiance(const RadianceEncoding& encoding, double radiance, double gain);

}  // namespace lf

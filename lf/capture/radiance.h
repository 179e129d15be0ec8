// From stored numbers to light: the table of doc/ray.md, "What is added".
//
// Radiance is linear light, 1 = display white. A kernel sees it as a 16-bit integer
//   v = clip(round(radiance * gain * scale) + pedestal, 0, 65535)
// where `gain` is lf_gain of the channel, divided by the falloff of the lens at the pixel's centre
// where the camera has lf_vignetting (camera/vignetting.h),
// with one scale and one pedestal for the whole light field, so that sums of any images add.
// Values below black are noise that must average to black: the pedestal keeps them.
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
  kSrgb,      // IEC 61966-2-1
  kLinear,    // (stored - black) / (white - black)
  kResponse,  // a measured curve: linear radiance at evenly spaced stored values
};

// AlphaMeaning says what the alpha of LF images tells of their pixels.
enum class AlphaMeaning : uint8_t {
  kMask,           // pixels whose alpha is below one half send no ray; colours are as stored
  kStraight,       // how much of the light behind is covered; colours are those of what covers it
  kPremultiplied,  // the same; the radiance of colours is multiplied with alpha already
};

// How the pixels of a light field are stored (keys lf_*, doc/formats/transforms_json.md).
// Float files hold radiance itself: transfer and levels do not apply to them.
struct RadianceEncoding {
  BayerPattern bayer = BayerPattern::kNone;
  Transfer transfer = Transfer::kSrgb;
  std::vector<double> response;       // kResponse: radiance at black .. white, evenly spaced, >= 2
  double black_level = 0;             // stored value of no light
  std::optional<double> white_level;  // stored value of radiance 1; default: the largest storable
  double max_radiance = 1;            // radiance (after gain) that v = 65535 stands for
  double pedestal = 0;                // v of no light: 1024 for raw data, 0 otherwise
  std::optional<AlphaMeaning> alpha;  // default: kMask
  // Radiance of R, G and B behind what alpha does not cover; default: black.
  std::optional<std::array<double, 3>> background;
  // Nothing is behind: `background` is black, and frames have opacity as a channel of their own.
  bool keeps_opacity = false;
  // LF images of one pose with different exposures are one picture, of which each pixel is taken
  // from the brightest that is not clipped there (capture/brackets.h).
  bool masks_clipped = false;
  std::array<double, 3> white_balance = {1, 1, 1};  // applied on developing
  Mat3 camera_to_srgb = Mat3::Identity();           // linear sRGB = M * white balanced camera RGB

  // v per unit of radiance.
  double Scale() const { return (65535 - pedestal) / max_radiance; }
  // Returns whether pixels are composed with the background (store/opacities.h).
  bool AlphaIsLight() const { return alpha.value_or(AlphaMeaning::kMask) != AlphaMeaning::kMask; }
  // Returns whether LF images have opacities to be collected (LfPixels::opacity).
  bool HasOpacity() const { return AlphaIsLight() && keeps_opacity; }
  std::array<double, 3> Background() const { return background.value_or(std::array{0., 0., 0.}); }
};

// Largest pedestal. At least half of the range is left to light.
inline constexpr double kMostPedestal = 32767;

// Bicubic interpolation and demosaicking undershoot beside bright lights, as they overshoot on
// them: clipped at no light, dark surroundings of small lights would turn grey. Raises the pedestal
// to kUndershootPedestal, which leaves room for a fifteenth of max_radiance below black.
inline constexpr double kUndershootPedestal = 4096;
void MakeRoomForUndershoot(RadianceEncoding* encoding);

// "RGGB", ... as in lf_bayer, and back; "" for kNone, and none for other words.
const char* NameOf(BayerPattern bayer);
std::optional<BayerPattern> BayerPatternOf(const std::string& name);

// "mask", "straight", "premultiplied", as in lf_alpha, and back; none for other words.
const char* NameOf(AlphaMeaning alpha);
std::optional<AlphaMeaning> AlphaMeaningOf(const std::string& name);

// The word for RadianceEncoding::keeps_opacity where others name a background.
inline constexpr const char* kNoBackground = "none";

// For people: "a mask", "straight light over black", "premultiplied light over 1, 0.5, 0",
// "straight light over nothing".
//   background, keeps_opacity  as RadianceEncoding has them; not of a mask
std::string TextOfAlpha(AlphaMeaning alpha, const std::array<double, 3>& background,
                        bool keeps_opacity);

// Linear light of an sRGB value in [0, 1], and back.
double LinearFromSrgb(double srgb);
double SrgbFromLinear(double linear);

// max_radiance of a light field that does not state it: 16 when an image is a float file (its name
// ends in .exr or .hdr), so that highlights up to 16 times display white are kept while black to
// white still has 4096 steps; else 1, which integer files cannot exceed.
double DefaultMaxRadiance(std::span<const std::string> image_names);

// Whether files of so many bits can hold the levels: black < white <= the largest storable value.
bool LevelsFit(const RadianceEncoding& encoding, int bits);

// Stored values from this on are clipped: the upper hundredth of black to white, because JPEG
// files, noise and demosaicking do not keep the largest value exactly. bits: 8 or 16, and
// LevelsFit(). Floats have no such value.
double ClippedFrom(const RadianceEncoding& encoding, int bits);

// v for every stored value of 8 or 16 bit files: 256 or 65536 entries. Halves round away from zero
// (noise around black stays symmetric). Beyond the levels sRGB and linear go on; a response curve
// goes on with its first slope below black and holds its last value above white.
// bits: 8 or 16, and LevelsFit().
std::vector<uint16_t> RadianceTable(const RadianceEncoding& encoding, int bits, double gain);

// The radiance, before gain and falloff, that RadianceTable() makes v of.
std::vector<double> LightTable(const RadianceEncoding& encoding, int bits);

// v of a float file's radiance. NaN gives the pedestal.
uint16_t QuantizeRadiance(const RadianceEncoding& encoding, double radiance, double gain);

}  // namespace lf

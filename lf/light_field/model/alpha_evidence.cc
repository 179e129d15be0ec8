// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/alpha_evidence.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "lf/light_field/model/channel_use.h"
#include "lf/pixels/files/image_file.h"

namespace lf {
namespace {

constexpr size_t kLookedAt = 3;  // number of LF images whose pixels are examined
// Each of the kLookedAt LF images is the first one with a readable header among this many
// successive LF images.
constexpr size_t kAskedFrom = 5;

// Two images count as having the same transparent pixels if at most this share of these pixels is
// transparent in only one image.
constexpr double kSameShare = 0.02;

// Facts about one LF image that tell the meaning of its alpha.
struct ImageEvidence {
  std::string image_name;
  int width = 0;
  std::vector<bool> is_transparent;  // true for each pixel with alpha 0, row by row
  size_t transparent_count = 0;
  bool is_one_colour = true;  // all transparent pixels have one colour
  bool is_float = false;
  std::array<double, 3> background = {};  // radiance of that colour; valid if is_one_colour
};

// Returns the radiance, from 0 to max_radiance, of a value that an image file stores; 0 if the file
// has too few bits for the levels of `encoding`.
template <class T>
double RadianceOfStored(const RadianceEncoding& encoding, T value) {
  if constexpr (std::is_floating_point_v<T>) {
    return value > 0 ? std::min<double>(value, encoding.max_radiance) : 0;  // NaN becomes 0
  } else {
    const int bits = int{8 * sizeof(T)};
    if (!LevelsFit(encoding, bits)) return 0;
    const double v = RadianceTable(encoding, bits, 1)[value];
    return std::max(0.0, (v - encoding.pedestal) / encoding.Scale());
  }
}

template <class T>
ImageEvidence EvidenceOf(const RadianceEncoding& encoding, const Image<T>& stored,
                         const ChannelUse& use) {
  ImageEvidence evidence;
  evidence.width = stored.width();
  evidence.is_float = std::is_floating_point_v<T>;
  evidence.is_transparent.reserve(static_cast<size_t>(stored.width()) * stored.height());
  std::array<T, 3> beneath{};
  for (int y = 0; y < stored.height(); ++y) {
    const T* pixel = stored.row(y);
    for (int x = 0; x < stored.width(); ++x, pixel += stored.channels()) {
      const bool is_opaque = pixel[*use.alpha] > 0;
      evidence.is_transparent.push_back(!is_opaque);
      if (is_opaque) continue;
      std::array<T, 3> colour;
      for (size_t c = 0; c < 3; ++c) colour[c] = pixel[use.colours == 3 ? c : 0];
      if (evidence.transparent_count++ > 0 && colour != beneath) evidence.is_one_colour = false;
      beneath = colour;
    }
  }
  for (size_t c = 0; c < 3; ++c) evidence.background[c] = RadianceOfStored(encoding, beneath[c]);
  return evidence;
}

bool HaveSameTransparentPixels(const ImageEvidence& a, const ImageEvidence& b) {
  if (a.width != b.width || a.is_transparent.size() != b.is_transparent.size()) return false;
  size_t differing_count = 0;
  for (size_t i = 0; i < a.is_transparent.size(); ++i)
    differing_count += a.is_transparent[i] != b.is_transparent[i];
  return static_cast<double>(differing_count) <=
         kSameShare * static_cast<double>(std::max(a.transparent_count, b.transparent_count));
}

// Returns the first LF image with a readable header among the kAskedFrom images from `first` on.
std::optional<LfImageId> ReadableFrom(const LightField& light_field, size_t first,
                                      ImageFileInfo* info) {
  for (size_t i = first; i < std::min(first + kAskedFrom, light_field.size()); ++i) {
    const LfImageId id{static_cast<uint32_t>(i)};
    std::error_code error;
    if (!std::filesystem::exists(light_field.ImagePath(id), error)) continue;
    const Result<ImageFileInfo> read = ReadImageInfo(light_field.ImagePath(id));
    if (!read) continue;
    *info = *read;
    return id;
  }
  return std::nullopt;
}

// Returns the evidence of those examined LF images that have transparent pixels.
std::vector<ImageEvidence> EvidenceOfSome(const LightField& light_field) {
  std::vector<size_t> firsts;
  for (size_t i = 0; i < kLookedAt; ++i)
    firsts.push_back(i * (light_field.size() - 1) / (kLookedAt - 1));
  firsts.erase(std::unique(firsts.begin(), firsts.end()), firsts.end());
  std::vector<ImageEvidence> images;
  std::optional<LfImageId> last;
  for (const size_t first : firsts) {
    ImageFileInfo info;
    const std::optional<LfImageId> id = ReadableFrom(light_field, first, &info);
    if (!id || id == last || !UseOf(info).alpha) continue;
    last = id;
    const Result<StoredImage> image = ReadImage(light_field.ImagePath(*id));
    if (!image) continue;
    ImageEvidence evidence = std::visit(
        [&](const auto& stored) { return EvidenceOf(light_field.encoding, stored, UseOf(info)); },
        *image);
    evidence.image_name = light_field.image_names[id->value];
    if (evidence.transparent_count > 0) images.push_back(std::move(evidence));
  }
  return images;
}

}  // namespace

std::optional<AlphaEvidence> FindAlphaEvidence(const LightField& light_field) {
  const std::vector<ImageEvidence> images = EvidenceOfSome(light_field);
  if (images.empty()) return std::nullopt;
  for (const ImageEvidence& evidence : images)
    if (!evidence.is_one_colour) return AlphaEvidence{AlphaMeaning::kMask, {}, evidence.image_name};
  const ImageEvidence& first = images[0];
  if (images.size() > 1 &&
      std::all_of(images.begin() + 1, images.end(), [&](const ImageEvidence& evidence) {
        return HaveSameTransparentPixels(first, evidence);
      }))
    return AlphaEvidence{AlphaMeaning::kMask, {}, first.image_name};
  const bool is_rendered = first.is_float && first.background == std::array<double, 3>{};
  return AlphaEvidence{is_rendered ? AlphaMeaning::kPremultiplied : AlphaMeaning::kStraight,
                       first.background, first.image_name};
}

}  // namespace lf

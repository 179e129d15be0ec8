// SPDX-License-Identifier: Apache-2.0
// Reads one LF image from its files, as stored. FolderStore and ReadRecordedImage() share it.
// Internal to this folder.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "lf/core/check.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/channel_use.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/radiance.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// Reads at least the pixels `wanted` of an LF image from its file, converts their colours, and
// returns what the channels of the file hold. The file may be rotated against the picture that the
// calibration describes; `wanted` and part->rect, the rectangle that was read, count pixels of that
// picture. `wanted` must contain a pixel of the picture. kInput, naming the file: it cannot be
// read, or does not fit the calibration or the encoding.
Result<ChannelUse> ReadStoredPixels(const LightField& light_field, LfImageId id,
                                    const PixelRect& wanted, ImagePart* part);

// Reads the pixels from the bytes of the LF image's file, as ReadStoredPixels() reads them from the
// file. Messages call it `name`.
Result<ChannelUse> ReadStoredPixelsOf(std::string_view bytes, const std::string& name,
                                      const LightField& light_field, LfImageId id,
                                      const PixelRect& wanted, ImagePart* part);

// Converts pixels as stored from the colour profile of their file to sRGB (ConvertToSrgb() of
// pixels/files/colour_profile.h), unless the encoding says that they are mosaics or no sRGB values.
// ReadStoredPixels() and ReadStoredPixelsOf() have done so.
void ConvertColours(const RadianceEncoding& encoding, ImagePart* part);

// Reads at least the pixels `wanted` of the image's mask file, as ReadStoredPixels() reads the
// picture. Returns false if the image has no mask file.
Result<bool> ReadMaskFile(const LightField& light_field, LfImageId id, const PixelRect& wanted,
                          ImagePart* part);

// Calls mask(x, y), where (x, y) is a pixel of the LF image, for each pixel of `rect` whose stored
// value in `channel` does not satisfy is_kept(value).
template <class T, class IsKept, class Mask>
void ForEachUnkept(const Image<T>& stored, const PixelRect& stored_rect, int channel,
                   const IsKept& is_kept, const PixelRect& rect, const Mask& mask) {
  LF_CHECK(Intersection(rect, stored_rect) == rect);
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    const T* value = stored.row(y - stored_rect.y_begin) +
                     static_cast<size_t>(rect.x_begin - stored_rect.x_begin) * stored.channels() +
                     channel;
    for (int x = rect.x_begin; x < rect.x_end; ++x, value += stored.channels())
      if (!is_kept(*value)) mask(x, y);
  }
}

// Calls mask(x, y) for the pixels of `rect`, which lies in part.rect, whose alpha is below one
// half.
//   alpha  index of the channel that holds alpha
template <class Mask>
void ForEachTransparent(const ImagePart& part, int alpha, const PixelRect& rect, const Mask& mask) {
  std::visit(
      [&]<class T>(const Image<T>& stored) {
        constexpr double kOpaque = std::is_floating_point_v<T> ? 1 : std::numeric_limits<T>::max();
        ForEachUnkept(
            stored, part.rect, alpha, [](T value) { return value >= kOpaque / 2; }, rect, mask);
      },
      part.image);
}

// Calls mask(x, y) for the pixels of `rect`, which lies in part.rect, that are clipped in one of
// the first `colours` channels. Floats are never clipped.
template <class Mask>
void ForEachClipped(const ImagePart& part, int colours, const RadianceEncoding& encoding,
                    const PixelRect& rect, const Mask& mask) {
  std::visit(
      [&]<class T>(const Image<T>& stored) {
        if constexpr (!std::is_floating_point_v<T>) {
          const double clipped_from = ClippedFrom(encoding, int{8 * sizeof(T)});
          const auto is_kept = [&](T value) { return value < clipped_from; };
          for (int colour = 0; colour < colours; ++colour)
            ForEachUnkept(stored, part.rect, colour, is_kept, rect, mask);
        }
      },
      part.image);
}

// Returns the reach of the darker one of two LF images in a bracket (light_field/model/brackets.h),
// in pixels along x and y: the darker one sends rays only within this distance of pixels that the
// brighter one clips. The distance covers the four pixels that an interpolation reads and, for
// mosaics, the mosaic pixels from which these are computed. Within it, a pixel that the brighter LF
// image does not clip sends two rays, one from each LF image.
inline int ReachOfDarker(BayerPattern bayer) { return bayer == BayerPattern::kNone ? 1 : 4; }

// Calls mask(x, y) for the pixels of `rect` that the next brighter LF image of the same pose shows,
// which means that it clips no pixel within ReachOfDarker() of them. Reads the brighter LF image,
// and calls mask() for no pixel if that image cannot be read.
void ForEachSeenBrighter(const LightField& light_field, LfImageId id, const PixelRect& rect,
                         const std::function<void(int x, int y)>& mask);

// Calls mask(x, y) for all masked pixels of `rect`. A pixel is masked if alpha is a mask and masks
// it, if the pixel is clipped or a brighter LF image shows it (in brackets,
// light_field/model/brackets.h), or if the LF image has a mask file that masks it. mask() may be
// called several times for one pixel. kInput: the mask file cannot be read.
template <class Mask>
Result<void> ForEachMasked(const LightField& light_field, LfImageId id, const ImagePart& part,
                           const ChannelUse& use, const PixelRect& rect, const Mask& mask) {
  if (rect.empty()) return {};
  if (use.alpha && !light_field.encoding.AlphaIsLight())
    ForEachTransparent(part, *use.alpha, rect, mask);
  if (light_field.cameras[id.value].masks_clipped)
    ForEachClipped(part, use.colours, light_field.encoding, rect, mask);
  if (light_field.cameras[id.value].brighter != LfCamera::kNone)
    ForEachSeenBrighter(light_field, id, rect, mask);
  ImagePart file;
  LF_ASSIGN_OR_RETURN(const bool has_file, ReadMaskFile(light_field, id, rect, &file));
  if (!has_file) return {};
  std::visit(
      [&]<class T>(const Image<T>& stored) {
        ForEachUnkept(
            stored, file.rect, 0, [](T value) { return value != 0; }, rect, mask);
      },
      file.image);
  return {};
}

// Returns kInput if integers of `bits` bits cannot hold the black and white level of the encoding.
//   path  path of the image, for the message
Result<void> CheckLevels(const RadianceEncoding& encoding, int bits, const std::string& path);

}  // namespace lf

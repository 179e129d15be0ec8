// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/compress_source.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "lf/light_field/model/brackets.h"
#include "lf/light_field/model/distinct_intrinsics.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace {

PixelRect WholeImage(const LightField& light_field, const LfCamera& camera) {
  const Intrinsics& intrinsics = light_field.intrinsics[camera.intrinsics_index];
  return {0, 0, intrinsics.width_px, intrinsics.height_px};
}

// First occurrence of an LF image in the packages, and bounds of the pixels that all packages need
// of it.
struct Needed {
  size_t package = 0;
  size_t index = 0;
  PixelRect rect;
};

// Refuses packed stores, because lossy compression would be applied twice, and virtual LF images,
// which only the densified store has that was made with them.
Result<void> CheckNotPacked(const LightField& light_field) {
  if (!HoldsPackedStore(light_field) && !HasVirtual(light_field)) return {};
  return UsageError(fmt::format(
      "{}: is a packed store, which cannot be compressed again: give the light field that it was "
      "made from",
      light_field.folder.string()));
}

}  // namespace

Result<CompressSource> SourceOfAll(LightField light_field) {
  LF_RETURN_IF_ERROR(CheckNotPacked(light_field));
  CompressSource source;
  for (const LfCamera& camera : light_field.cameras)
    source.rects.push_back(WholeImage(light_field, camera));
  source.whole = IdentityOf(light_field);
  source.light_field = std::move(light_field);
  return source;
}

Result<CompressSource> SourceOfPackages(std::span<const Package> packages, bool needed_pixels) {
  std::map<uint32_t, Needed> needed;
  for (size_t p = 0; p < packages.size(); ++p) {
    const Package& package = packages[p];
    if (package.whole != packages.front().whole)
      return UsageError(fmt::format(
          "packages {} and {} were made from different light fields: compress them into two "
          "stores",
          packages.front().name, package.name));
    for (size_t i = 0; i < package.images.size(); ++i) {
      const PackageImage& image = package.images[i];
      if (image.ray_count == 0) continue;  // a neighbour, of which no pixel is read
      const auto [at, is_new] = needed.try_emplace(image.id, Needed{p, i, image.rect});
      if (!is_new) at->second.rect = Bounds(at->second.rect, image.rect);
    }
  }
  if (needed.empty())
    return UsageError(
        "the packages need no LF image, so that there is nothing to compress: give packages whose "
        "frames see LF images");

  LF_RETURN_IF_ERROR(CheckNotPacked(packages.front().light_field));
  CompressSource source;
  const LightField& first = packages.front().light_field;
  LightField& light_field = source.light_field;
  light_field.folder = first.folder;
  light_field.encoding = first.encoding;
  light_field.unit_m = first.unit_m;
  light_field.depth_range = first.depth_range;
  source.whole = packages.front().whole;
  DistinctIntrinsics intrinsics;
  for (const auto& [id, image] : needed) {
    const LightField& from = packages[image.package].light_field;
    LfCamera camera = from.cameras[image.index];
    source.rects.push_back(needed_pixels ? image.rect : WholeImage(from, camera));
    camera.intrinsics_index = intrinsics.IndexOf(from.intrinsics[camera.intrinsics_index]);
    light_field.cameras.push_back(camera);
    light_field.image_names.push_back(from.image_names[image.index]);
    light_field.mask_names.push_back(from.mask_names.empty() ? std::string()
                                                             : from.mask_names[image.index]);
    source.whole_ids.push_back(id);
  }
  light_field.intrinsics = intrinsics.Take();
  if (light_field.encoding.masks_clipped) ApplyBrackets(&light_field);
  return source;
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/compress_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "lf/light_field/model/reduction.h"
#include "lf/storage/load/measure_footprint.h"
#include "lf/storage/load/open_store.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace {

PixelRect WholeImage(const LightField& light_field, size_t i) {
  const Intrinsics& k = light_field.intrinsics[light_field.cameras[i].intrinsics_index];
  return {0, 0, k.width_px, k.height_px};
}

// Refuses packed stores, because lossy compression would be applied twice, and virtual LF images,
// which only the densified store has that was made with them.
Result<void> CheckNotPacked(const LightField& light_field) {
  if (!HoldsPackedStore(light_field) && !HasVirtual(light_field)) return {};
  return UsageError(fmt::format(
      "{}: is a packed store, which cannot be compressed again: give the light field that it was "
      "made from",
      light_field.folder.string()));
}

Result<CompressSource> SourceOf(LightField light_field, std::vector<PixelRect> rects) {
  LF_RETURN_IF_ERROR(CheckNotReduced(light_field, "a packed store"));
  CompressSource source;
  source.whole = IdentityOf(light_field);
  source.rects = std::move(rects);
  source.light_field = std::move(light_field);
  RadianceEncoding& encoding = source.light_field.encoding;
  if (encoding.footprint) return source;
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<LfImageStore> store,
                      OpenStore(source.light_field, Mosaics::kToRgb));
  LF_ASSIGN_OR_RETURN(encoding.footprint, MeasureFootprint(source.light_field, *store));
  return source;
}

}  // namespace

std::vector<LfImageId> CompressSource::CompressedIds() const {
  std::vector<LfImageId> ids;
  for (uint32_t i = 0; i < rects.size(); ++i)
    if (!rects[i].empty()) ids.push_back(LfImageId{i});
  return ids;
}

Result<CompressSource> SourceOfAll(LightField light_field) {
  LF_RETURN_IF_ERROR(CheckNotPacked(light_field));
  std::vector<PixelRect> rects;
  for (size_t i = 0; i < light_field.size(); ++i) rects.push_back(WholeImage(light_field, i));
  return SourceOf(std::move(light_field), std::move(rects));
}

Result<CompressSource> SourceOfPackages(LightField light_field, std::span<const Package> packages,
                                        bool needed_pixels) {
  const Package& first = packages.front();
  LF_RETURN_IF_ERROR(CheckNotPacked(first.light_field));
  for (const Package& package : packages)
    if (package.whole != first.whole)
      return UsageError(fmt::format(
          "packages {} and {} were made from different light fields: compress them into two "
          "stores",
          first.name, package.name));
  if (IdentityOf(light_field) != first.whole)
    return InputError(
        fmt::format("package {} was made from another light field than the one of {} LF images in "
                    "{}: give the light field that it was made from with {{lightfield}}",
                    first.name, light_field.size(), light_field.folder.string()));
  std::vector<PixelRect> rects(light_field.size());
  for (const Package& package : packages)
    for (const PackageImage& image : package.images) {
      if (image.ray_count == 0) continue;  // a neighbour, of which no pixel is read
      if (image.id >= rects.size())
        return InputError(fmt::format(
            "package {}: needs LF image {}, but its light field has {}: the package is damaged; "
            "make it again",
            package.name, image.id, rects.size()));
      PixelRect& rect = rects[image.id];
      rect = needed_pixels ? Bounds(rect, image.rect) : WholeImage(light_field, image.id);
    }
  if (std::all_of(rects.begin(), rects.end(), [](const PixelRect& rect) { return rect.empty(); }))
    return UsageError(
        "the packages need no LF image, so that there is nothing to compress: give packages whose "
        "frames see LF images");
  light_field.encoding = first.light_field.encoding;
  return SourceOf(std::move(light_field), std::move(rects));
}

}  // namespace lf

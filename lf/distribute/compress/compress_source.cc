// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/compress_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "lf/distribute/compress/demosaicked_images.h"
#include "lf/light_field/model/reduction.h"
#include "lf/storage/load/measure_footprint.h"
#include "lf/storage/load/open_store.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/reference_table.h"

namespace lf {
namespace {

PixelRect WholeImage(const LightField& light_field, size_t i) {
  const Intrinsics& k = light_field.intrinsics[light_field.cameras[i].intrinsics_index];
  return {0, 0, k.width_px, k.height_px};
}

// Adds the LF images from which others of the packed store are predicted, directly or through
// others.
void AddReferences(const ReferenceTable& references, CompressSource* source) {
  if (references.empty()) return;
  for (const LfImageId id : source->CompressedIds())
    for (const uint32_t needed : references.NeededBy(id.value))
      source->rects[needed] = WholeImage(source->light_field, needed);
}

// Sets identity and numbers of the LF images of a packed store, and removes the rectangles of those
// that it has left out. kUsage: its encoded images cannot be copied.
Result<void> DescribeStore(CompressSource* source) {
  const LightField& light_field = source->light_field;
  const std::string name = light_field.folder.string();
  LF_ASSIGN_OR_RETURN(PackedStoreFacts facts, ReadPackedStore(light_field.folder));
  if (facts.densified)
    return UsageError(fmt::format(
        "{}: is a densified store, which cannot be compressed again: give the light field that it "
        "was made from",
        name));
  LF_ASSIGN_OR_RETURN(const std::vector<PackedCode> codes,
                      FindCodes(light_field.folder, light_field));
  for (size_t i = 0; i < codes.size(); ++i) {
    if (codes[i].is_left_out) source->rects[i] = {};
    const bool is_part = codes[i].bytes > 0 && codes[i].rect != WholeImage(light_field, i);
    if (is_part || facts.LacksCameras())
      return UsageError(
          fmt::format("{}: has only what some packages need, and cannot be compressed again: give "
                      "the light field that it was made from",
                      name));
  }
  LF_ASSIGN_OR_RETURN(const ReferenceTable references, ReadReferences(light_field.folder));
  AddReferences(references, source);
  source->whole = facts.whole;
  source->whole_ids = std::move(facts.whole_ids);
  source->films = std::move(facts.films);
  return {};
}

// Returns the identity by which packages know the light field.
Result<LightFieldIdentity> WholeIdentityOf(const LightField& light_field) {
  if (HoldsPackedStore(light_field)) return ReadWholeIdentity(light_field.folder);
  return IdentityOf(light_field);
}

Result<CompressSource> SourceOf(LightField light_field, std::vector<PixelRect> rects) {
  LF_RETURN_IF_ERROR(CheckNotReduced(light_field, "a packed store"));
  CompressSource source;
  source.whole = IdentityOf(light_field);
  source.rects = std::move(rects);
  source.light_field = std::move(light_field);
  if (source.IsCopied()) LF_RETURN_IF_ERROR(DescribeStore(&source));
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

Result<RecordedImage> ReadToCompress(const CompressSource& source, LfImageId id) {
  if (source.demosaicked) return source.demosaicked->Read(id, source.rects[id.value]);
  const PixelRect rect = RectToRecord(source.light_field, id, source.rects[id.value]);
  return ReadRecordedImage(source.light_field, id, rect);
}

Result<CompressSource> SourceOfAll(LightField light_field) {
  std::vector<PixelRect> rects;
  for (size_t i = 0; i < light_field.size(); ++i) rects.push_back(WholeImage(light_field, i));
  return SourceOf(std::move(light_field), std::move(rects));
}

Result<CompressSource> SourceOfPackages(LightField light_field, std::span<const Package> packages,
                                        bool needed_pixels) {
  const Package& first = packages.front();
  if (needed_pixels && HoldsPackedStore(light_field))
    return UsageError(fmt::format(
        "{{needed_pixels}} cannot be used with the packed store {}, whose encoded images "
        "are copied as they are: leave it out",
        light_field.folder.string()));
  for (const Package& package : packages)
    if (package.whole != first.whole)
      return UsageError(fmt::format(
          "packages {} and {} were made from different light fields: compress them into two "
          "stores",
          first.name, package.name));
  LF_ASSIGN_OR_RETURN(const LightFieldIdentity whole, WholeIdentityOf(light_field));
  if (whole != first.whole)
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
  if (!HoldsPackedStore(light_field)) light_field.encoding = first.light_field.encoding;
  return SourceOf(std::move(light_field), std::move(rects));
}

}  // namespace lf

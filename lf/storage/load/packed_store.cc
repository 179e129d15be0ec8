// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/packed_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "lf/camera/resolution.h"
#include "lf/core/check.h"
#include "lf/storage/load/check_code.h"
#include "lf/storage/load/image_reading.h"
#include "lf/storage/load/load_mosaics.h"
#include "lf/storage/load/opacities.h"
#include "lf/storage/load/ordered_half.h"
#include "lf/storage/load/recorded_image.h"
#include "lf/storage/load/reduced_reading.h"

namespace lf {
namespace {

constexpr uint8_t kMaskedBelow = 128;

// Returns `rect` moved by (x, y). Converts between coordinates of a whole LF image and of the part
// that is encoded.
PixelRect Moved(const PixelRect& rect, int x, int y) {
  return {rect.x_begin + x, rect.y_begin + y, rect.x_end + x, rect.y_end + y};
}

std::string TextOf(const PixelRect& rect) {
  return fmt::format("[{}, {}) x [{}, {})", rect.x_begin, rect.x_end, rect.y_begin, rect.y_end);
}

// Returns kInput if the store does not list the LF image, or lists it without encoded pixels.
Result<void> CheckListed(const PackedCode& code, const LightField& light_field, LfImageId id) {
  if (!code.is_listed() || code.is_left_out)
    return InputError(fmt::format(
        "{}: is not in the packed store{}: make the store again with lfcompressor, from the whole "
        "light field or from all packages that are rendered",
        light_field.ImagePath(id).string(),
        code.is_left_out ? ", because no package needed it when the store was made" : ""));
  if (code.bytes == 0)
    return InputError(fmt::format(
        "{}: is not in the packed store, because it was missing or broken when the store was made: "
        "replace the image file, and make the store again with lfcompressor",
        light_field.ImagePath(id).string()));
  return {};
}

// Returns kInput if a part of the store lacks bytes of the LF image that are needed.
//   unneeded_parts  number of the finest parts that are not needed
Result<void> CheckParts(const PackedCode& code, int unneeded_parts, const LightField& light_field,
                        LfImageId id) {
  if (code.missing_parts <= unneeded_parts) return {};
  return InputError(
      fmt::format("{}: is not completely in the files beside the packed store, of which some are "
                  "missing or were "
                  "not copied to their end: copy all files of the store again",
                  light_field.ImagePath(id).string()));
}

// Makes pixels R, G, B of the four colours of a reduced mosaic (DecodeReduced()).
void ColoursOfMosaic(BayerPattern bayer, CodecPixels* pixels) {
  std::visit(
      [&]<class Pixel>(Image<Pixel>& mosaic) {
        Image<Pixel> rgb(mosaic.width(), mosaic.height(), 3);
        for (int y = 0; y < rgb.height(); ++y)
          for (int x = 0; x < rgb.width(); ++x) {
            uint32_t greens = 1;  // rounds half of the sum of two greens
            for (int i = 0; i < 4; ++i) {
              const Pixel value = mosaic.at(x, y, i);
              const int channel = BayerChannel(bayer, i % 2, i / 2);
              if (channel == 1)
                greens += value;
              else
                rgb.at(x, y, channel) = value;
            }
            rgb.at(x, y, 1) = static_cast<Pixel>(greens / 2);
          }
        mosaic = std::move(rgb);
      },
      *pixels);
}

// Moves the decoded pixels, together with their memory, into `part`, and converts kDisplay16 to
// stored values by `curve`, and kHalf to floats.
//   coded  pixels of the LF image that are encoded
void MakePart(StoredValues values, const PixelRect& coded, const std::optional<DisplayCurve>& curve,
              DecodedPart* decoded, Image<float>* floats, ImagePart* part) {
  part->rect = Moved(decoded->rect, coded.x_begin, coded.y_begin);
  if (values == StoredValues::kUint8) {
    part->image = std::move(std::get<Image<uint8_t>>(decoded->pixels));
  } else if (values != StoredValues::kHalf) {
    auto& words = std::get<Image<uint16_t>>(decoded->pixels);
    if (values == StoredValues::kDisplay16)
      for (uint16_t& word : words.pixels()) word = curve->Stored(word);
    part->image = std::move(words);
  } else {
    const auto& ordered = std::get<Image<uint16_t>>(decoded->pixels);
    floats->Resize(ordered.width(), ordered.height(), ordered.channels());
    for (size_t i = 0; i < ordered.pixels().size(); ++i)
      floats->pixels()[i] = FloatOfOrdered(ordered.pixels()[i]);
    part->image = std::move(*floats);
  }
}

// Moves the memory from `part` back to `decoded` or `floats`, so that it is reused for the next
// image.
void TakeBack(ImagePart* part, DecodedPart* decoded, Image<float>* floats) {
  if (auto* bytes = std::get_if<Image<uint8_t>>(&part->image))
    decoded->pixels = std::move(*bytes);
  else if (auto* words = std::get_if<Image<uint16_t>>(&part->image))
    decoded->pixels = std::move(*words);
  else
    *floats = std::move(std::get<Image<float>>(part->image));
}

}  // namespace

PackedStore::PackedStore(const LightField& light_field, Mosaics mosaics,
                         std::vector<PackedCode> codes)
    : light_field_(light_field),
      tables_(light_field.encoding, ChannelGains()),
      mosaics_(mosaics),
      codes_(std::move(codes)) {}

Result<std::unique_ptr<PackedStore>> PackedStore::Open(const LightField& light_field,
                                                       Mosaics mosaics, StoreContent content,
                                                       int reduction) {
  LF_ASSIGN_OR_RETURN(std::vector<PackedCode> codes, FindCodes(light_field.folder, light_field));
  std::unique_ptr<PackedStore> store(new PackedStore(light_field, mosaics, std::move(codes)));
  store->unneeded_parts_ = store->FrontsLeftOut(reduction);
  if (std::any_of(store->codes_.begin(), store->codes_.end(),
                  [](const PackedCode& code) { return code.values == StoredValues::kDisplay16; })) {
    LF_ASSIGN_OR_RETURN(const DisplayLevels levels, ReadDisplayLevels(light_field.folder));
    store->curve_.emplace(levels.black, levels.white);
  }
  LF_ASSIGN_OR_RETURN(store->references_,
                      ReferenceCache::Open(light_field.folder, light_field.encoding.bayer));
  if (content == StoreContent::kPixelsAndDepths) {
    LF_ASSIGN_OR_RETURN(store->densified_, ReadDensifiedPlan(light_field.folder));
  }
  return store;
}

// Returns the number of fronts that are longer than the one with which LF images are reduced by
// `divisor`; 0 if whole images are needed. The first level of a mosaic halves it already.
int PackedStore::FrontsLeftOut(int divisor) const {
  const int halvings = std::countr_zero(static_cast<unsigned>(divisor));
  const bool is_mosaic = light_field_.encoding.bayer != BayerPattern::kNone;
  return is_mosaic && halvings > 0 ? halvings - 1 : halvings;
}

bool PackedStore::IsPartial() const {
  for (uint32_t i = 0; i < codes_.size(); ++i) {
    const Intrinsics& k = light_field_.intrinsics[light_field_.cameras[i].intrinsics_index];
    if (!Keeps(LfImageId{i}, {0, 0, k.width_px, k.height_px})) return true;
  }
  return false;
}

bool PackedStore::Keeps(LfImageId id, const PixelRect& rect) const {
  const Intrinsics& k = light_field_.intrinsics[light_field_.cameras[id.value].intrinsics_index];
  const PixelRect read = mosaics_ == Mosaics::kToRgb ? RectToRecord(light_field_, id, rect) : rect;
  return codes_[id.value].Keeps(Intersection(read, {0, 0, k.width_px, k.height_px}));
}

Result<void> PackedStore::Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const {
  LF_CHECK(id.value < light_field_.size());
  LF_RETURN_IF_ERROR(CheckListed(codes_[id.value], light_field_, id));
  LF_RETURN_IF_ERROR(CheckParts(codes_[id.value], 0, light_field_, id));
  LF_ASSIGN_OR_RETURN(std::unique_ptr<Loading> loading, TakeLoading());
  Result<void> loaded = LoadMosaicsAs(
      mosaics_, light_field_, id, rect,
      [&](const PixelRect& recorded, LfPixels* into) {
        return LoadRecorded(loading.get(), id, recorded, into);
      },
      &loading->mosaic, pixels);
  if (loaded && densified_)
    loaded = light_field_.cameras[id.value].is_virtual
                 ? LoadTrust(loading.get(), id, pixels)
                 : LoadDepths(loading.get(), id, &pixels->depths);
  GiveBack(std::move(loading));
  return loaded;
}

Result<int> PackedStore::LoadReduced(LfImageId id, int divisor, const Intrinsics& k,
                                     LfPixels* pixels) const {
  LF_CHECK(id.value < light_field_.size());
  LF_RETURN_IF_ERROR(CheckListed(codes_[id.value], light_field_, id));
  LF_ASSIGN_OR_RETURN(std::unique_ptr<Loading> loading, TakeLoading());
  const Result<int> reduced = LoadReducedBy(loading.get(), id, divisor, pixels);
  GiveBack(std::move(loading));
  if (!reduced || *reduced > 1) return reduced;
  return LfImageStore::LoadReduced(id, divisor, k, pixels);
}

// Returns 1, without loading pixels, if the LF image cannot be reduced.
Result<int> PackedStore::LoadReducedBy(Loading* loading, LfImageId id, int divisor,
                                       LfPixels* pixels) const {
  const PackedCode& code = codes_[id.value];
  const LfCamera& camera = light_field_.cameras[id.value];
  const Intrinsics& k = light_field_.intrinsics[camera.intrinsics_index];
  const bool is_mosaic = light_field_.encoding.bayer != BayerPattern::kNone;
  // Means of ordered half floats are far from those of light beside edges.
  if (divisor % 2 != 0 || densified_ || code.values == StoredValues::kHalf ||
      (is_mosaic && mosaics_ == Mosaics::kAsRecorded) ||
      code.rect != PixelRect{0, 0, k.width_px, k.height_px})
    return 1;
  const std::string name = light_field_.ImagePath(id).string();
  const auto named = [&name](const Error& error) {
    return Error{error.kind, fmt::format("{}: {}", name, error.message)};
  };
  if (code.values == StoredValues::kFile) {
    const auto bytes = loading->reader.Read(code);
    if (!bytes) return named(bytes.error());
    if (!bytes->mask.empty()) return 1;
    const auto read = [&](const WantedReduction& wanted, ImagePart* part) {
      return ReadReducedJpegBytes(bytes->code, name, wanted, part);
    };
    return LoadReducedFile(read, name, light_field_, id, divisor, tables_, &loading->part, pixels);
  }
  LF_RETURN_IF_ERROR(CheckLevels(light_field_.encoding, BitsOf(code.values), name));
  const int left_out = FrontsLeftOut(divisor);
  if (left_out == 0) return 1;
  LF_RETURN_IF_ERROR(CheckParts(code, left_out, light_field_, id));
  const auto front = loading->reader.ReadFront(code, static_cast<size_t>(left_out));
  if (!front) return named(front.error());
  if (!*front) return 1;
  const std::string_view bytes = (*front)->code;
  if (const auto ok = CheckColours(bytes, code, light_field_.encoding.bayer); !ok)
    return named(ok.error());
  const int left_out_here = static_cast<int>((*front)->left_out) + (is_mosaic ? 1 : 0);
  const int reduction = std::min(1 << left_out_here, LargestReduction(*ReadCodeInfo(bytes)));
  if (reduction == 1) return 1;
  if (const auto ok = DecodeReduced(bytes, reduction, &loading->decoded.pixels); !ok)
    return named(ok.error());
  const Intrinsics reduced = WithLargerPixels(k, reduction);
  loading->decoded.rect = {0, 0, reduced.width_px, reduced.height_px};
  RadianceEncoding encoding = light_field_.encoding;
  if (is_mosaic) {
    ColoursOfMosaic(encoding.bayer, &loading->decoded.pixels);
    encoding.bayer = BayerPattern::kNone;
  }
  pixels->Reset(loading->decoded.rect, BayerPattern::kNone);
  Convert(loading, code.values, {}, encoding, camera, reduced, pixels);
  // An encoded image with fronts has no mask.
  if (encoding.HasOpacity()) SetOpaque(pixels);
  return reduction;
}

// Converts the decoded values to the radiance of pixels->rect.
//   coded     pixels of the LF image that are encoded
//   encoding  of the values: without a Bayer pattern if they are RGB made of a mosaic
//   k         intrinsics of the pixels, for the falloff
void PackedStore::Convert(Loading* loading, StoredValues values, const PixelRect& coded,
                          const RadianceEncoding& encoding, const LfCamera& camera,
                          const Intrinsics& k, LfPixels* pixels) const {
  MakePart(values, coded, curve_, &loading->decoded, &loading->floats, &loading->part);
  const int channels =
      std::visit([](const auto& image) { return image.channels(); }, loading->part.image);
  ConvertRadiance(loading->part, channels, tables_, encoding, camera, k, pixels);
  TakeBack(&loading->part, &loading->decoded, &loading->floats);
}

Result<PackedPlaneReader*> PackedStore::PlanesOf(Loading* loading) const {
  if (!loading->planes) {
    LF_ASSIGN_OR_RETURN(loading->planes, PackedPlaneReader::Open(light_field_.folder));
  }
  return &*loading->planes;
}

// Loads the trust in pixels that are loaded.
Result<void> PackedStore::LoadTrust(Loading* loading, LfImageId id, LfPixels* pixels) const {
  if (pixels->rect.empty()) return {};
  LF_ASSIGN_OR_RETURN(PackedPlaneReader* const planes, PlanesOf(loading));
  const LfImageId in_store = {codes_[id.value].id};
  LF_ASSIGN_OR_RETURN(const bool has_plane, planes->Has(in_store, PlaneKind::kTrust));
  if (!has_plane) return {};
  LF_ASSIGN_OR_RETURN(pixels->trust, planes->ReadTrust(in_store, pixels->rect));
  return {};
}

Result<void> PackedStore::LoadDepths(Loading* loading, LfImageId id, LfDepths* depths) const {
  LF_ASSIGN_OR_RETURN(PackedPlaneReader* const planes, PlanesOf(loading));
  const LfImageId in_store = {codes_[id.value].id};
  LF_ASSIGN_OR_RETURN(const bool has_plane, planes->Has(in_store, PlaneKind::kDisparity));
  if (!has_plane) return {};
  LF_ASSIGN_OR_RETURN(depths->numbers, planes->Read(in_store, PlaneKind::kDisparity));
  depths->least = densified_->plane_least;
  depths->greatest = densified_->plane_greatest;
  depths->divisor = densified_->plane_divisor;
  return {};
}

Result<void> PackedStore::LoadRecorded(Loading* loading, LfImageId id, const PixelRect& rect,
                                       LfPixels* pixels) const {
  const PackedCode& code = codes_[id.value];
  const LfCamera& camera = light_field_.cameras[id.value];
  const Intrinsics& k = light_field_.intrinsics[camera.intrinsics_index];
  const RadianceEncoding& encoding = light_field_.encoding;
  const std::string name = light_field_.ImagePath(id).string();
  const auto named = [&name](const Error& error) {
    return Error{error.kind, fmt::format("{}: {}", name, error.message)};
  };
  const PixelRect whole = {0, 0, k.width_px, k.height_px};
  const PixelRect inside = Intersection(rect, whole);
  if (Intersection(code.rect, whole) != code.rect)
    return InputError(
        fmt::format("{}: has the pixels {} (x, y) in the packed store, but {} x {} pixels in its "
                    "calibration: the store is damaged; copy or make it again",
                    name, TextOf(code.rect), k.width_px, k.height_px));
  if (!inside.empty() && Intersection(inside, code.rect) != inside)
    return InputError(
        fmt::format("{}: its pixels {} (x, y) are needed, but only {} are in the packed store: "
                    "make the store again with lfcompressor from all packages that are rendered",
                    name, TextOf(inside), TextOf(code.rect)));
  const bool is_file = code.values == StoredValues::kFile;
  if (!is_file && code.values != StoredValues::kHalf)
    LF_RETURN_IF_ERROR(CheckLevels(encoding, BitsOf(code.values), name));
  const auto bytes = loading->reader.Read(code);
  if (!bytes) return named(bytes.error());
  const bool is_mosaic = encoding.bayer != BayerPattern::kNone;
  if (!is_file)
    if (const auto ok = CheckColours(bytes->code, code, encoding.bayer); !ok)
      return named(ok.error());
  pixels->Reset(inside, encoding.bayer);
  if (inside.empty()) return {};

  const PixelRect wanted = Moved(inside, -code.rect.x_begin, -code.rect.y_begin);
  if (is_file) {
    LF_ASSIGN_OR_RETURN(const ChannelUse use, ReadStoredPixelsOf(bytes->code, name, light_field_,
                                                                 id, inside, &loading->part));
    ConvertRadiance(loading->part, use.colours, tables_, encoding, camera, k, pixels);
  } else {
    const auto ok = references_ && references_->Concerns(code.id)
                        ? references_->Decode(code.id, bytes->code, wanted, &loading->decoded)
                        : DecodeImage(bytes->code, wanted, &loading->decoded);
    if (!ok) return named(ok.error());
    Convert(loading, code.values, code.rect, encoding, camera, k, pixels);
  }

  if (bytes->mask.empty()) {
    if (encoding.HasOpacity()) SetOpaque(pixels);
    return {};
  }
  const bool is_light = encoding.AlphaIsLight() && !is_mosaic;
  const int mask_bits = is_light ? 16 : 8;
  if (const auto info = ReadCodeInfo(bytes->mask); info && info->bits != mask_bits)
    return InputError(
        fmt::format("{}: alpha is stored in the packed store as {}, but needed as {}: compress the "
                    "light field again with the {{image_alpha}} of this run",
                    name, is_light ? "a mask" : "opacity", is_light ? "opacity" : "a mask"));
  if (const auto ok = CheckCode(bytes->mask, mask_bits, PixelLayout::kGrey, false, code.rect); !ok)
    return named(ok.error());
  if (const auto ok = DecodeImage(bytes->mask, wanted, &loading->mask); !ok)
    return named(ok.error());
  const PixelRect mask_rect = Moved(loading->mask.rect, code.rect.x_begin, code.rect.y_begin);
  if (is_light) {
    ComposeWithBackground(std::get<Image<uint16_t>>(loading->mask.pixels), mask_rect, encoding,
                          pixels);
    return {};
  }
  ForEachUnkept(
      std::get<Image<uint8_t>>(loading->mask.pixels), mask_rect, 0,
      [](uint8_t value) { return value >= kMaskedBelow; }, inside,
      [&](int x, int y) { pixels->Mask(x - inside.x_begin, y - inside.y_begin); });
  return {};
}

Result<std::unique_ptr<PackedStore::Loading>> PackedStore::TakeLoading() const {
  {
    const std::lock_guard lock(mutex_);
    if (!loadings_.empty()) {
      std::unique_ptr<Loading> loading = std::move(loadings_.back());
      loadings_.pop_back();
      return loading;
    }
  }
  LF_ASSIGN_OR_RETURN(PackedCodeReader reader, PackedCodeReader::Open(light_field_.folder));
  return std::unique_ptr<Loading>(new Loading{std::move(reader), {}, {}, {}, {}, {}});
}

void PackedStore::GiveBack(std::unique_ptr<Loading> loading) const {
  const std::lock_guard lock(mutex_);
  loadings_.push_back(std::move(loading));
}

}  // namespace lf

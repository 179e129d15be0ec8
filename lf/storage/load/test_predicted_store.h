// SPDX-License-Identifier: Apache-2.0
// A small packed store of predicted LF images, for tests.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lf/core/check.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/pixels/codec/predicted_image.h"
#include "lf/pixels/codec/test_predictions.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {

struct PredictedStoreKind {
  PixelLayout layout = PixelLayout::kRgb;
  StoredValues values = StoredValues::kUint8;
  int width = 70, height = 50;
  uint64_t shard_bytes = 0;
  bool has_masks = false;  // true: odd LF images have a mask
};

// Reference images of each LF image. They are encoded in the order kPredictedOrder.
inline const std::vector<std::vector<uint32_t>> kReferencesOfImages = {{3, 5}, {4, 3, 5, 0}, {}, {},
                                                                       {0},    {},           {1}};
inline constexpr uint32_t kPredictedOrder[] = {3, 5, 0, 4, 1, 2, 6};
inline constexpr uint32_t kPredictedImages = 7;

// The LF images of the store, in encoded form and as they are decoded by hand.
struct PredictedImages {
  PredictedStoreKind kind;
  LightField light_field;  // its folder is not set
  std::vector<CodedImage> coded;
  std::vector<DecodedPart> decoded;

  PackedStorePlan Plan() const {
    PackedStorePlan plan;
    plan.whole = IdentityOf(light_field);
    plan.codec = "default, levels 4, threshold 3, predicted";
    plan.shard_bytes = kind.shard_bytes;
    plan.is_predicted = true;
    if (kind.values == StoredValues::kDisplay16) plan.display_levels = DisplayLevels{0, 65535};
    return plan;
  }
  std::vector<GroupedImage> Group(std::span<const uint32_t> ids = kPredictedOrder) const {
    std::vector<GroupedImage> group;
    for (const uint32_t id : ids) group.push_back({{id}, coded[id]});
    return group;
  }
  void Write(const std::filesystem::path& path) const {
    PackedStoreWriter writer = PackedStoreWriter::Create(path, light_field, Plan()).value();
    const std::vector<GroupedImage> group = Group();
    const Result<void> added = writer.AddGroup(group);
    ASSERT_TRUE(added) << added.error().message;
    const Result<void> finished = writer.Finish();
    ASSERT_TRUE(finished) << finished.error().message;
  }
  // Writes a store of the same pixels without predicted LF images.
  void WriteAlone(const std::filesystem::path& path) const {
    PackedStorePlan plan = Plan();
    plan.is_predicted = false;
    PackedStoreWriter writer = PackedStoreWriter::Create(path, light_field, plan).value();
    for (uint32_t id = 0; id < coded.size(); ++id) {
      CodedImage image = coded[id];
      image.references = {};
      image.code = EncodeImage(decoded[id].pixels, kind.layout, {CodecProfile::kLossless});
      ASSERT_TRUE(writer.Add({id}, image));
    }
    ASSERT_TRUE(writer.Finish());
  }
};

inline PredictedImages MakePredictedImages(const PredictedStoreKind& kind) {
  PredictedImages images;
  images.kind = kind;
  LightField& field = images.light_field;
  Intrinsics k;
  k.fx_px = k.fy_px = kind.width;
  k.cx_px = kind.width / 2.0;
  k.cy_px = kind.height / 2.0;
  k.width_px = kind.width;
  k.height_px = kind.height;
  field.intrinsics = {k};
  if (kind.layout == PixelLayout::kMosaic) field.encoding.bayer = BayerPattern::kRggb;
  images.coded.resize(kPredictedImages);
  images.decoded.resize(kPredictedImages);
  const bool is_8_bit = kind.values == StoredValues::kUint8;
  const CodecSettings settings = {CodecProfile::kDefault, 4, is_8_bit ? 3.0 : 700.0};
  const auto x_of = [](uint32_t id) { return 0.06 * id; };
  const auto y_of = [](uint32_t id) { return 0.04 * (id * 3 % 7); };
  for (uint32_t id = 0; id < kPredictedImages; ++id) {
    field.image_names.push_back("image" + std::to_string(id) + ".png");
    field.cameras.emplace_back().cam_from_world.translation = Vec3(-x_of(id), -y_of(id), 0);
  }
  for (const uint32_t id : kPredictedOrder) {
    CodedImage& coded = images.coded[id];
    coded.values = kind.values;
    coded.rect = {0, 0, kind.width, kind.height};
    coded.source_bytes = 1000 + id;
    CodecPixels pixels;
    if (is_8_bit)
      pixels = DrawnView<uint8_t>(x_of(id), y_of(id), kind.width, kind.height, kind.layout);
    else
      pixels = DrawnView<uint16_t>(x_of(id), y_of(id), kind.width, kind.height, kind.layout);
    std::vector<Reference> references;
    std::vector<const DecodedPart*> parts;
    for (const uint32_t other : kReferencesOfImages[id]) {
      coded.references.push_back({other});
      parts.push_back(&images.decoded[other]);
      references.push_back({&parts.back()->pixels, DrawnWarp(x_of(other) - x_of(id),
                                                             y_of(other) - y_of(id), kind.layout)});
    }
    coded.code = references.empty()
                     ? EncodeImage(pixels, kind.layout, settings)
                     : EncodePredicted(pixels, kind.layout, settings, references, {});
    LF_CHECK(DecodePredicted(coded.code, parts, coded.rect, &images.decoded[id]).has_value());
    if (kind.has_masks && id % 2 == 1) {
      Image<uint8_t> mask(kind.width, kind.height, 1, 255);
      for (int x = 0; x < kind.width; ++x) mask.at(x, static_cast<int>(id)) = 0;
      coded.mask = EncodeImage(mask, PixelLayout::kGrey, {CodecProfile::kLossless});
    }
  }
  return images;
}

// Returns an error of the first difference of the pixels `rect` from an LF image decoded by hand.
inline ::testing::AssertionResult HasPixelsOf(const DecodedPart& whole, const DecodedPart& part,
                                              const PixelRect& rect) {
  if (Intersection(part.rect, rect) != rect)
    return ::testing::AssertionFailure() << "lacks pixels that are wanted";
  if (whole.pixels.index() != part.pixels.index())
    return ::testing::AssertionFailure() << "has another type";
  return std::visit(
      [&]<class Pixel>(const Image<Pixel>& all) -> ::testing::AssertionResult {
        const auto& some = std::get<Image<Pixel>>(part.pixels);
        if (some.channels() != all.channels())
          return ::testing::AssertionFailure() << "has another number of channels";
        for (int y = rect.y_begin; y < rect.y_end; ++y)
          for (int x = rect.x_begin; x < rect.x_end; ++x)
            for (int c = 0; c < all.channels(); ++c)
              if (all.at(x, y, c) != some.at(x - part.rect.x_begin, y - part.rect.y_begin, c))
                return ::testing::AssertionFailure() << "differs at " << x << ", " << y;
        return ::testing::AssertionSuccess();
      },
      whole.pixels);
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/predicted_image.h"

#include <gtest/gtest.h>

#include <random>

#include "lf/pixels/codec/decode_by.h"
#include "lf/pixels/codec/test_predictions.h"

namespace lf {
namespace {

constexpr std::array kLayouts = {PixelLayout::kGrey, PixelLayout::kMosaic, PixelLayout::kRgb};

CodecSettings SettingsFor(CodecProfile profile, double threshold = 3) {
  CodecSettings settings;
  settings.profile = profile;
  settings.threshold = threshold;
  return settings;
}

// A part of an image, as a decoder of tiles would have it.
DecodedPart PartOfImage(const CodecPixels& pixels, const PixelRect& rect) {
  return std::visit(
      [&]<class Pixel>(const Image<Pixel>& image) -> DecodedPart {
        const PixelRect inside = Intersection(rect, {0, 0, image.width(), image.height()});
        Image<Pixel> part(inside.width(), inside.height(), image.channels());
        for (int y = 0; y < part.height(); ++y)
          std::copy_n(image.row(inside.y_begin + y) + inside.x_begin * image.channels(),
                      part.width() * image.channels(), part.row(y));
        return {std::move(part), inside};
      },
      pixels);
}

template <class Pixel>
CodecPixels NoisePicture(std::mt19937& random, int width, int height, PixelLayout layout) {
  Image<Pixel> image(width, height, layout == PixelLayout::kRgb ? 3 : 1);
  for (Pixel& value : image.pixels()) value = static_cast<Pixel>(random());
  return image;
}

bool HasPixels(const DecodedPart& part, const CodecPixels& expected) {
  return std::visit(
      [&]<class Pixel>(const Image<Pixel>& image) {
        const auto* const other = std::get_if<Image<Pixel>>(&part.pixels);
        return other != nullptr && other->width() == image.width() &&
               other->height() == image.height() && other->channels() == image.channels() &&
               other->pixels() == image.pixels();
      },
      expected);
}

struct AnyGroup {
  PixelLayout layout;
  CodecPixels target;
  std::vector<DecodedPart> decoded;
  std::vector<Reference> references;
  std::vector<const DecodedPart*> parts;
};

// Returns a noisy image and noisy reference images of any sizes with any shifts.
AnyGroup NoiseGroup(std::mt19937& random, int most_size) {
  const auto size = [&] { return static_cast<int>(1 + random() % most_size); };
  AnyGroup group;
  group.layout = kLayouts[random() % 3];
  const bool is_deep = random() % 3 == 0;
  const auto picture = [&](int width, int height) {
    return is_deep ? NoisePicture<uint16_t>(random, width, height, group.layout)
                   : NoisePicture<uint8_t>(random, width, height, group.layout);
  };
  group.target = picture(size(), size());
  const size_t count = 1 + random() % 4;
  for (size_t r = 0; r < count; ++r) {
    const int width = size(), height = size();
    group.decoded.push_back({picture(width, height), {0, 0, width, height}});
  }
  for (const DecodedPart& part : group.decoded) {
    PlaneWarp warp = IdentityWarp();
    for (int row = 0; row < 2; ++row) {
      warp.far[row][0] += static_cast<int>(random() % (1 << 24)) - (1 << 23);
      warp.step[row] = static_cast<int>(random() % (1 << 27)) - (1 << 26);
    }
    group.references.push_back({&part.pixels, warp});
    group.parts.push_back(&part);
  }
  return group;
}

TEST(PredictedImage, LosslessIsExact) {
  std::mt19937 random(1);
  for (int i = 0; i < 60; ++i) {
    const AnyGroup group = NoiseGroup(random, 70);
    CodecSettings settings = SettingsFor(CodecProfile::kLossless);
    settings.levels = 1 + i % 5;
    const std::string code =
        EncodePredicted(group.target, group.layout, settings, group.references, {8 << (i % 3)});
    DecodedPart part;
    ASSERT_TRUE(DecodePredicted(code, group.parts, {0, 0, 1000, 1000}, &part));
    ASSERT_TRUE(HasPixels(part, group.target)) << i;
  }
}

TEST(PredictedImage, TheReferenceImplementationDecodesTheSame) {
  std::mt19937 random(2);
  for (int i = 0; i < 60; ++i) {
    const AnyGroup group = NoiseGroup(random, 70);
    const CodecSettings settings =
        SettingsFor(i % 2 == 0 ? CodecProfile::kDefault : CodecProfile::kLossless, i);
    const std::string code =
        EncodePredicted(group.target, group.layout, settings, group.references);
    const PixelRect all = {0, 0, 1000, 1000};
    DecodedPart fast, slow;
    ASSERT_TRUE(DecodePredictedBy(Transform::kSimd, code, group.parts, all, &fast));
    ASSERT_TRUE(DecodePredictedBy(Transform::kReference, code, group.parts, all, &slow));
    ASSERT_TRUE(HasPixels(fast, slow.pixels)) << i;
  }
}

// Whole rectangles of tiles are equal, from no more than the stated parts of the reference images.
TEST(PredictedImage, ARectangleIsACropOfTheWhole) {
  std::mt19937 random(3);
  for (const PixelLayout layout : kLayouts) {
    const int width = 1201, height = 1101;
    const CodecSettings settings = SettingsFor(CodecProfile::kDefault);
    const DrawnGroup group = MakeDrawnGroup<uint8_t>(2, width, height, layout, settings);
    const std::string code = EncodePredicted(group.target, layout, settings, group.references());
    DecodedPart whole, part;
    ASSERT_TRUE(DecodePredicted(code, group.parts(), {0, 0, width, height}, &whole));
    for (int i = 0; i < 6; ++i) {
      const int x = static_cast<int>(random() % width), y = static_cast<int>(random() % height);
      const PixelRect wanted = {x, y, static_cast<int>(x + 1 + random() % (width - x)),
                                static_cast<int>(y + 1 + random() % (height - y))};
      const auto needed = NeededOfReferences(code, wanted);
      ASSERT_TRUE(needed);
      std::vector<DecodedPart> cut;
      for (size_t r = 0; r < needed->size(); ++r)
        cut.push_back(PartOfImage(group.decoded[r].pixels, (*needed)[r]));
      const std::vector<const DecodedPart*> parts = {&cut[0], &cut[1]};
      ASSERT_TRUE(DecodePredicted(code, parts, wanted, &part));
      ASSERT_EQ(Intersection(wanted, part.rect), wanted);
      ASSERT_TRUE(HasPixels(part, PartOfImage(whole.pixels, part.rect).pixels));
    }
    // A tile needs little more than its own pixels, moved by at most 40 * 0.25 pixels.
    const auto needed = NeededOfReferences(code, {3, 3, 4, 4});
    ASSERT_TRUE(needed);
    EXPECT_LE((*needed)[0].x_end, 1024 + 64);
    EXPECT_LE((*needed)[0].y_end, 1024 + 64);
    // Without a column of them, it is not decoded.
    PixelRect less = (*needed)[0];
    less.x_end -= 2;
    const DecodedPart short_part = PartOfImage(group.decoded[0].pixels, less);
    const std::vector<const DecodedPart*> parts = {&short_part, &group.decoded[1]};
    const Result<void> decoded = DecodePredicted(code, parts, {3, 3, 4, 4}, &part);
    ASSERT_FALSE(decoded);
    EXPECT_NE(decoded.error().message.find("of a reference image"), std::string::npos);
  }
}

// Parallax is found: an image of two planes takes far fewer bytes than alone, at the same quality.
TEST(PredictedImage, PlanesTakeFewBytes) {
  for (const PixelLayout layout : kLayouts)
    for (const double threshold : {0.0, 3.0}) {
      const CodecSettings settings =
          SettingsFor(threshold == 0 ? CodecProfile::kLossless : CodecProfile::kDefault, threshold);
      const DrawnGroup group = MakeDrawnGroup<uint8_t>(3, 320, 240, layout, settings);
      const size_t alone = EncodeImage(group.target, layout, settings).size();
      const std::string predicted =
          EncodePredicted(group.target, layout, settings, group.references());
      EXPECT_LT(predicted.size(), (threshold == 0 ? 0.65 : 0.4) * alone)
          << static_cast<int>(layout) << " " << threshold;
    }
}

// Smaller blocks follow the edge of the near plane better.
TEST(PredictedImage, SmallerBlocksTakeFewerBytes) {
  const CodecSettings settings = SettingsFor(CodecProfile::kLossless);
  const DrawnGroup group = MakeDrawnGroup<uint8_t>(2, 320, 240, PixelLayout::kGrey, settings);
  const auto bytes = [&](int block_px) {
    return EncodePredicted(group.target, PixelLayout::kGrey, settings, group.references(),
                           {block_px})
        .size();
  };
  EXPECT_LT(bytes(8), bytes(16));
  EXPECT_LT(bytes(16), bytes(32));
}

TEST(PredictedImage, DepthsOf16BitsAreFound) {
  const CodecSettings settings = SettingsFor(CodecProfile::kDefault, 800);
  const DrawnGroup group = MakeDrawnGroup<uint16_t>(2, 320, 240, PixelLayout::kRgb, settings);
  const size_t alone = EncodeImage(group.target, PixelLayout::kRgb, settings).size();
  const std::string predicted =
      EncodePredicted(group.target, PixelLayout::kRgb, settings, group.references());
  EXPECT_LT(predicted.size(), 0.5 * alone);
}

// The error is that of an image that is encoded alone, so that errors do not add up in a chain.
TEST(PredictedImage, TheErrorIsThatOfTheThreshold) {
  const CodecSettings settings = SettingsFor(CodecProfile::kDefault, 4);
  const DrawnGroup group = MakeDrawnGroup<uint8_t>(2, 320, 240, PixelLayout::kRgb, settings);
  DecodedPart alone, predicted;
  ASSERT_TRUE(DecodeImage(EncodeImage(group.target, PixelLayout::kRgb, settings), &alone));
  const std::string code =
      EncodePredicted(group.target, PixelLayout::kRgb, settings, group.references());
  ASSERT_TRUE(DecodePredicted(code, group.parts(), {0, 0, 320, 240}, &predicted));
  const auto error = [&](const DecodedPart& part) {
    const auto& target = std::get<Image<uint8_t>>(group.target).pixels();
    const auto& pixels = std::get<Image<uint8_t>>(part.pixels).pixels();
    double sum = 0;
    for (size_t i = 0; i < target.size(); ++i) sum += std::pow(target[i] - pixels[i], 2);
    return sum / static_cast<double>(target.size());
  };
  EXPECT_LT(error(predicted), 1.1 * error(alone));
}

// Noise cannot be predicted. It takes a few more bytes than alone, and the means say so.
TEST(PredictedImage, NoiseGainsNothing) {
  std::mt19937 random(4);
  const PixelLayout layout = PixelLayout::kRgb;
  std::vector<CodecPixels> noise;
  for (int i = 0; i < 3; ++i) noise.push_back(NoisePicture<uint8_t>(random, 128, 96, layout));
  const std::vector<Reference> references = {{&noise[1], DrawnWarp(0.2, 0, layout)},
                                             {&noise[2], DrawnWarp(0, 0.2, layout)}};
  const CodecSettings settings = SettingsFor(CodecProfile::kDefault);
  const std::string predicted = EncodePredicted(noise[0], layout, settings, references);
  const size_t alone = EncodeImage(noise[0], layout, settings).size();
  EXPECT_GT(predicted.size(), alone);
  EXPECT_LT(predicted.size(), 1.3 * alone);
}

TEST(PredictedImage, EqualImagesGiveEqualBytes) {
  const CodecSettings settings = SettingsFor(CodecProfile::kDefault);
  const DrawnGroup group = MakeDrawnGroup<uint8_t>(4, 100, 90, PixelLayout::kMosaic, settings);
  const auto encode = [&] {
    return EncodePredicted(group.target, PixelLayout::kMosaic, settings, group.references());
  };
  EXPECT_EQ(encode(), encode());
}

TEST(PredictedImage, IsNotDecodedAlone) {
  const CodecSettings settings = SettingsFor(CodecProfile::kDefault);
  const DrawnGroup group = MakeDrawnGroup<uint8_t>(2, 100, 90, PixelLayout::kGrey, settings);
  const std::string code =
      EncodePredicted(group.target, PixelLayout::kGrey, settings, group.references());
  const auto info = ReadCodeInfo(code);
  ASSERT_TRUE(info);
  EXPECT_EQ(info->reference_count, 2);
  EXPECT_EQ(LargestReduction(*info), 1);
  DecodedPart part;
  EXPECT_EQ(DecodeImage(code, &part).error().message,
            "is an encoded LF image that is predicted from 2 others and needs their pixels");
  const std::vector<const DecodedPart*> one = {&group.decoded[0]};
  EXPECT_EQ(DecodePredicted(code, one, {0, 0, 100, 90}, &part).error().message,
            "is an encoded LF image whose prediction needs 2 reference images, not 1; copy "
            "or make the packed store again");
  const DecodedPart deep = {Image<uint16_t>(100, 90), {0, 0, 100, 90}};
  const std::vector<const DecodedPart*> other = {&group.decoded[0], &deep};
  EXPECT_EQ(DecodePredicted(code, other, {0, 0, 100, 90}, &part).error().message,
            "is an encoded LF image whose prediction needs the pixels of a reference image of its "
            "own kind; copy or make the packed store again");
}

TEST(PredictedImage, ImagesAloneAreDecodedAsUsual) {
  const CodecPixels pixels = DrawnView<uint8_t>(0, 0, 90, 70, PixelLayout::kRgb);
  const std::string code =
      EncodeImage(pixels, PixelLayout::kRgb, SettingsFor(CodecProfile::kLossless));
  DecodedPart part;
  ASSERT_TRUE(DecodePredicted(code, {}, {0, 0, 90, 70}, &part));
  EXPECT_TRUE(HasPixels(part, pixels));
  EXPECT_EQ(NeededOfReferences(code, {0, 0, 90, 70})->size(), 0U);
}

// Damaged bytes give an error or any picture.
TEST(PredictedImage, DamageIsNoCrash) {
  std::mt19937 random(5);
  const CodecSettings settings = SettingsFor(CodecProfile::kDefault);
  const DrawnGroup group = MakeDrawnGroup<uint8_t>(2, 40, 30, PixelLayout::kMosaic, settings);
  const std::string code =
      EncodePredicted(group.target, PixelLayout::kMosaic, settings, group.references());
  const auto decode = [&](const std::string& damaged) {
    const auto info = ReadCodeInfo(damaged);
    if (!info) return false;
    // A store decodes only images of the size that its calibration states.
    if (info->width != 40 || info->height != 30) return false;
    const PixelRect wanted = {0, 0, 40, 30};
    (void)NeededOfReferences(damaged, wanted);
    DecodedPart part;
    return DecodePredicted(damaged, group.parts(), wanted, &part).has_value();
  };
  ASSERT_TRUE(decode(code));
  for (size_t size = 0; size < code.size(); ++size) EXPECT_FALSE(decode(code.substr(0, size)));
  EXPECT_FALSE(decode(code + '\0'));
  int decoded = 0;
  for (size_t at = 0; at < code.size(); ++at)
    for (const int change : {1, 2, 64, 128, 255}) {
      std::string damaged = code;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      decoded += decode(damaged) ? 1 : 0;
    }
  for (int i = 0; i < 2000; ++i) {
    std::string damaged = code;
    for (int k = 0; k < 3; ++k) damaged[random() % code.size()] = static_cast<char>(random());
    decoded += decode(damaged) ? 1 : 0;
  }
  EXPECT_GT(decoded, 0);
}

}  // namespace
}  // namespace lf

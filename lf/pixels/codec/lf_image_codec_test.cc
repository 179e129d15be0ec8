// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/lf_image_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lf/pixels/codec/decode_by.h"

namespace lf {
namespace {

template <class Pixel>
constexpr int kMost = std::numeric_limits<Pixel>::max();

// Returns a picture of a random kind: smooth, slightly noisy, noise, flat, a checkerboard, or black
// with single white pixels.
template <class Pixel>
Image<Pixel> Picture(std::mt19937& random, int width, int height, int channels) {
  Image<Pixel> image(width, height, channels);
  std::uniform_real_distribution<double> unit(0, 1);
  const int kind = static_cast<int>(random() % 6);
  const double fx = unit(random) / 5, fy = unit(random) / 5, noise = unit(random) * 0.1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) {
        double v = 0.5 + 0.3 * std::sin(fx * x + c) * std::cos(fy * y);
        if (kind == 1) v += noise * (unit(random) - 0.5);
        if (kind == 2) v = unit(random);
        if (kind == 3) v = 0.25;
        if (kind == 4) v = (x + y) % 2;
        if (kind == 5) v = random() % 50 == 0 ? 1 : 0;
        image.at(x, y, c) = static_cast<Pixel>(std::lround(std::clamp(v, 0.0, 1.0) * kMost<Pixel>));
      }
  return image;
}

CodecPixels AnyPicture(std::mt19937& random, int width, int height, PixelLayout layout) {
  const int channels = layout == PixelLayout::kRgb ? 3 : 1;
  if (random() % 3 == 0) return Picture<uint16_t>(random, width, height, channels);
  return Picture<uint8_t>(random, width, height, channels);
}

struct Size {
  int width, height;
};
Size AnySize(std::mt19937& random) {
  switch (random() % 20) {
    case 0:
      return {static_cast<int>(1 + random() % 4), static_cast<int>(1 + random() % 4)};
    case 1:
      return {1, static_cast<int>(1 + random() % 300)};
    case 2:
      return {static_cast<int>(1 + random() % 300), 1};
    case 3:  // several tiles
      return {static_cast<int>(1025 + random() % 200), static_cast<int>(1 + random() % 30)};
    case 4:
      return {static_cast<int>(1 + random() % 30), static_cast<int>(1025 + random() % 200)};
    default:
      return {static_cast<int>(1 + random() % 120), static_cast<int>(1 + random() % 120)};
  }
}

PixelLayout AnyLayout(std::mt19937& random) { return static_cast<PixelLayout>(random() % 3); }

CodecSettings AnySettings(std::mt19937& random) {
  CodecSettings settings;
  settings.profile = static_cast<CodecProfile>(random() % 3);
  settings.entropy = static_cast<Entropy>(random() % 2);
  settings.levels = static_cast<int>(1 + random() % 5);
  settings.threshold = static_cast<double>(random() % 100) / 8;
  if (random() % 2 == 0) settings.quantizer = static_cast<int>(2 + random() % 65535);
  return settings;
}

bool Same(const CodecPixels& a, const CodecPixels& b) {
  return std::visit(
      [&]<class Pixel>(const Image<Pixel>& left) {
        const auto* right = std::get_if<Image<Pixel>>(&b);
        return right != nullptr && left.width() == right->width() &&
               left.height() == right->height() && left.channels() == right->channels() &&
               left.pixels() == right->pixels();
      },
      a);
}

CodecPixels Cut(const CodecPixels& pixels, const PixelRect& rect) {
  return std::visit(
      [&]<class Pixel>(const Image<Pixel>& image) -> CodecPixels {
        Image<Pixel> part(rect.width(), rect.height(), image.channels());
        for (int y = 0; y < part.height(); ++y)
          for (int x = 0; x < part.width(); ++x)
            for (int c = 0; c < part.channels(); ++c)
              part.at(x, y, c) = image.at(rect.x_begin + x, rect.y_begin + y, c);
        return part;
      },
      pixels);
}

double Psnr(const CodecPixels& a, const CodecPixels& b) {
  return std::visit(
      [&]<class Pixel>(const Image<Pixel>& left) {
        const auto& right = std::get<Image<Pixel>>(b);
        double sum = 0;
        for (size_t i = 0; i < left.pixels().size(); ++i)
          sum += std::pow(static_cast<double>(left.pixels()[i]) - right.pixels()[i], 2);
        return 10 * std::log10(std::pow(kMost<Pixel>, 2) * left.pixels().size() / sum);
      },
      a);
}

std::string Named(Size size, PixelLayout layout, const CodecSettings& settings) {
  return std::to_string(size.width) + "x" + std::to_string(size.height) + ", layout " +
         std::to_string(static_cast<int>(layout)) + ", profile " +
         std::to_string(static_cast<int>(settings.profile)) + ", levels " +
         std::to_string(settings.levels) + ", threshold " + std::to_string(settings.threshold) +
         ", quantizer " + std::to_string(settings.quantizer);
}

TEST(LfImageCodec, LosslessIsExact) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Size size = AnySize(random);
    const PixelLayout layout = AnyLayout(random);
    const CodecPixels pixels = AnyPicture(random, size.width, size.height, layout);
    CodecSettings settings;
    settings.profile = CodecProfile::kLossless;
    settings.levels = 1 + i % 5;
    DecodedPart part;
    const std::string code = EncodeImage(pixels, layout, settings);
    ASSERT_TRUE(DecodeImage(code, &part)) << Named(size, layout, settings);
    ASSERT_EQ(part.rect, (PixelRect{0, 0, size.width, size.height}));
    ASSERT_TRUE(Same(part.pixels, pixels)) << Named(size, layout, settings);
  }
}

TEST(LfImageCodec, EncodingEndsAtEachTileAndPacketIfInterrupted) {
  std::mt19937 random(7);
  const CodecPixels pixels = AnyPicture(random, 1025, 1030, PixelLayout::kGrey);  // four tiles
  for (const CodecProfile profile :
       {CodecProfile::kThesis, CodecProfile::kDefault, CodecProfile::kLossless}) {
    CodecSettings settings;
    settings.profile = profile;
    settings.levels = 2;
    const auto encoded = [&](const std::function<bool()>& is_interrupted) {
      return EncodeImage(pixels, PixelLayout::kGrey, settings, is_interrupted);
    };
    int asked = 0;
    const Result<std::string> whole = encoded([&] { return ++asked < 0; });
    ASSERT_TRUE(whole);
    EXPECT_EQ(*whole, EncodeImage(pixels, PixelLayout::kGrey, settings));
    EXPECT_EQ(asked, 4 + 3 * 4);  // tiles, and packets of three resolutions
    for (int moment = 1; moment <= asked; ++moment) {
      int now = 0;
      const Result<std::string> part = encoded([&] { return ++now >= moment; });
      ASSERT_FALSE(part) << moment;
      EXPECT_EQ(part.error().kind, ErrorKind::kInterrupted);
      EXPECT_EQ(now, moment);
    }
  }
}

// Encodes the example of doc/formats/lf_image.md.
TEST(LfImageCodec, TheExampleOfThePage) {
  Image<uint8_t> image(2, 2);
  image.at(0, 0) = 10;
  image.at(1, 0) = 12;
  image.at(0, 1) = 14;
  image.at(1, 1) = 20;
  std::string code = EncodeImage(image, PixelLayout::kGrey, {CodecProfile::kLossless, 1, 0, 256});
  std::string hex;
  for (const char byte : code) {
    constexpr const char* kDigits = "0123456789abcdef";
    hex += kDigits[static_cast<uint8_t>(byte) >> 4];
    hex += kDigits[static_cast<uint8_t>(byte) & 15];
  }
  EXPECT_EQ(hex,
            "4c46494d01020008"
            "0202010a"
            "0200010101"
            "0d0e"
            "010a28b52ffd0000090000e300"
            "020b28b52ffd0000110000c80800");
}

TEST(LfImageCodec, TheReferenceDecodesTheSame) {
  std::mt19937 random(2);
  for (int i = 0; i < 300; ++i) {
    const Size size = AnySize(random);
    const PixelLayout layout = AnyLayout(random);
    const CodecSettings settings = AnySettings(random);
    const CodecPixels pixels = AnyPicture(random, size.width, size.height, layout);
    const std::string code = EncodeImage(pixels, layout, settings);
    ASSERT_EQ(code, EncodeImage(pixels, layout, settings));
    DecodedPart fast, slow;
    const PixelRect all = {0, 0, size.width, size.height};
    ASSERT_TRUE(DecodeImageBy(Transform::kSimd, code, all, &fast));
    ASSERT_TRUE(DecodeImageBy(Transform::kReference, code, all, &slow));
    ASSERT_TRUE(Same(fast.pixels, slow.pixels)) << Named(size, layout, settings);
  }
}

TEST(LfImageCodec, ARectangleIsACropOfTheWhole) {
  std::mt19937 random(3);
  for (const PixelLayout layout : {PixelLayout::kGrey, PixelLayout::kMosaic, PixelLayout::kRgb})
    for (const CodecProfile profile :
         {CodecProfile::kThesis, CodecProfile::kDefault, CodecProfile::kLossless}) {
      const int width = 2300, height = 1100;
      const CodecPixels pixels = AnyPicture(random, width, height, layout);
      CodecSettings settings;
      settings.profile = profile;
      const std::string code = EncodeImage(pixels, layout, settings);
      DecodedPart whole, part;
      ASSERT_TRUE(DecodeImage(code, &whole));
      for (int i = 0; i < 12; ++i) {
        const int x = static_cast<int>(random() % width), y = static_cast<int>(random() % height);
        const PixelRect wanted = {x, y, static_cast<int>(x + 1 + random() % (width - x)),
                                  static_cast<int>(y + 1 + random() % (height - y))};
        ASSERT_TRUE(DecodeImage(code, wanted, &part));
        ASSERT_EQ(Intersection(wanted, part.rect), wanted);
        ASSERT_TRUE(Same(part.pixels, Cut(whole.pixels, part.rect)));
      }
      // Only the tiles that contain the wanted pixels are decoded.
      ASSERT_TRUE(DecodeImage(code, {1100, 3, 1101, 4}, &part));
      EXPECT_EQ(part.rect, (PixelRect{1024, 0, 2048, 1024}));
    }
}

// The error follows from the threshold, which sets the quantiser's step. The picture is noise, so
// that the result does not depend on a picture's content.
TEST(LfImageCodec, TheThresholdBoundsTheError) {
  std::mt19937 random(4);
  for (const PixelLayout layout : {PixelLayout::kGrey, PixelLayout::kMosaic, PixelLayout::kRgb})
    for (const double threshold : {2.0, 4.0, 10.0}) {
      Image<uint8_t> image(256, 256, layout == PixelLayout::kRgb ? 3 : 1);
      for (uint8_t& v : image.pixels()) v = static_cast<uint8_t>(random());
      CodecSettings settings;
      settings.threshold = threshold;
      DecodedPart part;
      ASSERT_TRUE(DecodeImage(EncodeImage(image, layout, settings), &part));
      // The quantiser gives each coefficient a mean squared error of step^2 / 12, and rounding to
      // pixels adds 1 / 12. The dead zone, subbands that are not quite orthogonal, and rounding
      // between levels increase the error.
      const double step = 1.5 * threshold;
      const double ideal = 10 * std::log10(255 * 255 / (step * step / 12 + 1.0 / 12));
      EXPECT_GT(Psnr(part.pixels, image), ideal - 2.5) << threshold;
      EXPECT_LT(Psnr(part.pixels, image), ideal + 1.5) << threshold;
    }
}

// Columns that alternate between two values have one detail: their difference. The difference
// becomes 0 if it is below two thirds of a step; if it is just kept, it is decoded as a whole step.
TEST(LfImageCodec, DetailsBelowTwoThirdsOfAStepAreDropped) {
  CodecSettings settings;
  settings.levels = 1;
  settings.threshold = 20;
  const auto decoded_difference = [&](int difference) {
    Image<uint8_t> image(64, 64);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        image.at(x, y) = static_cast<uint8_t>(x % 2 == 0 ? 90 : 90 + difference);
    DecodedPart part;
    EXPECT_TRUE(DecodeImage(EncodeImage(image, PixelLayout::kGrey, settings), &part));
    const auto& decoded = std::get<Image<uint8_t>>(part.pixels);
    return decoded.at(33, 32) - decoded.at(32, 32);
  };
  int least = 1;
  while (least < 100 && decoded_difference(least) == 0) ++least;
  const int step = decoded_difference(least);
  EXPECT_GE(step, 20);
  EXPECT_NEAR(static_cast<double>(least) / step, 2.0 / 3, 0.06);
}

// Errors of both signs are equally frequent, so that the mean of many LF images is the mean of the
// scene.
TEST(LfImageCodec, BrightAndDarkPicturesKeepTheirMean) {
  std::mt19937 random(8);
  for (const int darkest : {25, 150})
    for (const int levels : {1, 2}) {  // with fewer levels, steps are coarser
      Image<uint8_t> image(256, 256);
      for (uint8_t& v : image.pixels()) v = static_cast<uint8_t>(darkest + random() % 80);
      CodecSettings settings;
      settings.levels = levels;
      settings.threshold = 10;
      DecodedPart part;
      ASSERT_TRUE(DecodeImage(EncodeImage(image, PixelLayout::kGrey, settings), &part));
      const auto& decoded = std::get<Image<uint8_t>>(part.pixels).pixels();
      double sum = 0;
      for (size_t i = 0; i < decoded.size(); ++i) sum += int{decoded[i]} - int{image.pixels()[i]};
      EXPECT_NEAR(sum / static_cast<double>(decoded.size()), 0, 0.1)
          << darkest << ", levels " << levels;
    }
}

// A 16-bit version of the picture has the same relative error with 256 times the threshold, except
// for rounding.
TEST(LfImageCodec, SixteenBitsAreTheSamePicture) {
  std::mt19937 random(5);
  for (const CodecProfile profile : {CodecProfile::kThesis, CodecProfile::kDefault}) {
    Image<uint8_t> image(200, 150);
    Image<uint16_t> deep(200, 150);
    for (int y = 0; y < 150; ++y)
      for (int x = 0; x < 200; ++x) {
        const double v = 128 + 90 * std::sin(x / 9.0) * std::cos(y / 7.0);
        image.at(x, y) = static_cast<uint8_t>(std::lround(v) + random() % 8);
        deep.at(x, y) = static_cast<uint16_t>(image.at(x, y) * 256);
      }
    CodecSettings settings;
    settings.profile = profile;
    DecodedPart part, deep_part;
    ASSERT_TRUE(DecodeImage(EncodeImage(image, PixelLayout::kMosaic, settings), &part));
    settings.threshold *= 256;
    ASSERT_TRUE(DecodeImage(EncodeImage(deep, PixelLayout::kMosaic, settings), &deep_part));
    EXPECT_NEAR(Psnr(part.pixels, image), Psnr(deep_part.pixels, deep), 1);
  }
}

// Returns the mean of each square of `reduction` x `reduction` pixels; of each colour of a mosaic.
template <class Pixel>
Image<double> MeansOf(const Image<Pixel>& image, PixelLayout layout, int reduction) {
  const bool is_mosaic = layout == PixelLayout::kMosaic;
  const int channels = is_mosaic ? 4 : image.channels(), step = is_mosaic ? 2 : 1;
  Image<double> means(image.width() / reduction, image.height() / reduction, channels);
  for (int y = 0; y < means.height(); ++y)
    for (int x = 0; x < means.width(); ++x)
      for (int c = 0; c < channels; ++c) {
        double sum = 0;
        for (int v = is_mosaic ? c / 2 : 0; v < reduction; v += step)
          for (int u = is_mosaic ? c % 2 : 0; u < reduction; u += step)
            sum += image.at(x * reduction + u, y * reduction + v, is_mosaic ? 0 : c);
        means.at(x, y, c) = sum * step * step / (reduction * reduction);
      }
  return means;
}

// A picture of slow changes, whose last columns and rows are the same: those are the means of
// samples that the encoded image lacks.
template <class Pixel>
Image<Pixel> SlowPicture(int width, int height, PixelLayout layout) {
  Image<Pixel> image(width, height, layout == PixelLayout::kRgb ? 3 : 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < image.channels(); ++c) {
        const int colour = layout == PixelLayout::kMosaic ? x % 2 + 2 * (y % 2) : c;
        const double v = 0.4 + 0.08 * colour + 0.15 * std::cos(3.14159265 * x / width) +
                         0.1 * std::cos(3.14159265 * y / height);
        image.at(x, y, c) = static_cast<Pixel>(std::lround(v * kMost<Pixel>));
      }
  return image;
}

// A reduced picture is the mean of squares if the picture changes slowly, whatever the size, the
// layout, the reduction and the number of tiles. A last column or row may miss the samples
// behind it.
TEST(LfImageCodec, AReducedPictureHasTheMeansOfSquares) {
  for (const auto layout : {PixelLayout::kGrey, PixelLayout::kRgb, PixelLayout::kMosaic})
    for (const Size size : {Size{320, 240}, Size{333, 251}, Size{1100, 90}})
      for (const auto profile : {CodecProfile::kDefault, CodecProfile::kLossless})
        for (const int levels : {1, 2, 4}) {
          const auto image = SlowPicture<uint8_t>(size.width, size.height, layout);
          const auto deep = SlowPicture<uint16_t>(size.width, size.height, layout);
          CodecSettings settings{profile, levels, 1, 256};
          const std::string code = EncodeImage(image, layout, settings);
          const std::string deep_code = EncodeImage(deep, layout, settings);
          const CodeInfo info = *ReadCodeInfo(code);
          const int largest = LargestReduction(info);
          EXPECT_EQ(largest, 1 << (levels + (layout == PixelLayout::kMosaic ? 1 : 0)));
          for (int reduction = 2; reduction <= largest; reduction *= 2) {
            CodecPixels reduced, deep_reduced;
            ASSERT_TRUE(DecodeReduced(code, reduction, &reduced));
            ASSERT_TRUE(DecodeReduced(deep_code, reduction, &deep_reduced));
            const auto& small = std::get<Image<uint8_t>>(reduced);
            const auto& deep_small = std::get<Image<uint16_t>>(deep_reduced);
            const Image<double> means = MeansOf(image, layout, reduction);
            const Image<double> deep_means = MeansOf(deep, layout, reduction);
            ASSERT_EQ(small.width(), means.width());
            ASSERT_EQ(small.height(), means.height());
            ASSERT_EQ(small.channels(), means.channels());
            double worst = 0, deep_worst = 0, sum = 0;
            for (size_t i = 0; i < means.pixels().size(); ++i) {
              worst = std::max(worst, std::abs(small.pixels()[i] - means.pixels()[i]));
              sum += small.pixels()[i] - means.pixels()[i];
              deep_worst =
                  std::max(deep_worst, std::abs(deep_small.pixels()[i] - deep_means.pixels()[i]));
            }
            const std::string where =
                Named(size, layout, settings) + " / " + std::to_string(reduction);
            // Without fraction bits, each level of 8-bit values rounds.
            EXPECT_LE(worst, profile == CodecProfile::kLossless ? 7 : 2) << where;
            EXPECT_NEAR(sum / static_cast<double>(means.pixels().size()), 0,
                        layout == PixelLayout::kMosaic ? 2.5 : 1)
                << where;
            EXPECT_LE(deep_worst, 1.2 * 256) << where;
          }
        }
}

// The front of an encoded image is enough, and one byte less is an error. The reference transforms
// give the same, for pictures of all kinds.
TEST(LfImageCodec, AReducedPictureNeedsOnlyTheFront) {
  std::mt19937 random(9);
  for (int i = 0; i < 200; ++i) {
    const Size size = AnySize(random);
    const PixelLayout layout = AnyLayout(random);
    const std::string code = EncodeImage(AnyPicture(random, size.width, size.height, layout),
                                         layout, AnySettings(random));
    const CodeInfo info = *ReadCodeInfo(code);
    const auto ends = ResolutionEnds(code);
    ASSERT_TRUE(ends);
    EXPECT_EQ(ends->size(), static_cast<size_t>(info.levels + 1));
    EXPECT_EQ(ends->back(), code.size());
    EXPECT_TRUE(std::is_sorted(ends->begin(), ends->end()));
    for (int reduction = 2; reduction <= LargestReduction(info); reduction *= 2) {
      const uint64_t end = (*ends)[ResolutionFor(info, reduction)];
      CodecPixels of_front, of_all, of_reference;
      const std::string_view front = std::string_view(code).substr(0, end);
      ASSERT_TRUE(DecodeReduced(front, reduction, &of_front));
      ASSERT_TRUE(DecodeReduced(code, reduction, &of_all));
      ASSERT_TRUE(DecodeReducedBy(Transform::kReference, front, reduction, &of_reference));
      EXPECT_TRUE(Same(of_front, of_all) && Same(of_front, of_reference));
      EXPECT_FALSE(DecodeReduced(front.substr(0, end - 1), reduction, &of_front));
    }
  }
}

TEST(LfImageCodec, TheThesisProfileIsNotReduced) {
  const Image<uint8_t> image(40, 30);
  const std::string code =
      EncodeImage(image, PixelLayout::kGrey, {CodecProfile::kThesis, 2, 0, 256});
  EXPECT_EQ(LargestReduction(*ReadCodeInfo(code)), 1);
}

// With the finest quantiser and threshold 0, only rounding causes errors, which are too small to
// change an 8-bit pixel.
TEST(LfImageCodec, TheThesisProfileIsNearlyExactWithoutThreshold) {
  std::mt19937 random(6);
  for (int i = 0; i < 100; ++i) {
    const Size size = AnySize(random);
    const PixelLayout layout = AnyLayout(random);
    const Image<uint8_t> image =
        Picture<uint8_t>(random, size.width, size.height, layout == PixelLayout::kRgb ? 3 : 1);
    CodecSettings settings{CodecProfile::kThesis, 1 + i % 5, 0, 65536};
    DecodedPart part;
    ASSERT_TRUE(DecodeImage(EncodeImage(image, layout, settings), &part));
    ASSERT_TRUE(Same(part.pixels, image)) << Named(size, layout, settings);
  }
}

TEST(LfImageCodec, SettingsOutOfRangeAreUsageErrors) {
  const auto message = [](const CodecSettings& settings) {
    const Result<void> checked = CheckSettings(settings);
    return checked ? std::string("fine") : checked.error().message;
  };
  EXPECT_EQ(message({}), "fine");
  EXPECT_EQ(message({CodecProfile::kDefault, 6, 3, 256}), "{levels 6}: expected 1 to 5");
  EXPECT_EQ(message({CodecProfile::kDefault, 3, -1, 256}), "{threshold -1}: expected 0 to 65535");
  EXPECT_EQ(message({CodecProfile::kThesis, 1, 3, 1}),
            "{quantizer 1}: expected 8bit, or 2 to 65536 values per coefficient");
}

TEST(LfImageCodec, DamageIsAnErrorOrAnotherPicture) {
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    const Size size = {static_cast<int>(1 + random() % 90), static_cast<int>(1 + random() % 90)};
    const PixelLayout layout = AnyLayout(random);
    const CodecPixels pixels = AnyPicture(random, size.width, size.height, layout);
    std::string code = EncodeImage(pixels, layout, AnySettings(random));
    if (random() % 4 == 0)
      code.resize(random() % code.size());
    else
      for (int k = 0; k < 3; ++k) code[random() % code.size()] = static_cast<char>(random());
    const Result<CodeInfo> info = ReadCodeInfo(code);
    if (!info || info->width > 4096 || info->height > 4096) {
      ++refused;
      continue;
    }
    DecodedPart part;
    if (!DecodeImage(code, &part)) ++refused;
  }
  EXPECT_GT(refused, 1000);
}

TEST(LfImageCodec, ABlobThatClaimsTooMuchIsRefused) {
  // The head states: magic, version 1, lossless grey of 8 bits, 2^20 x 2^11 pixels.
  std::string code("LFIM\x01\x02\x00\x08\x80\x80\x40\x80\x10\x03\x0a\x02\x00", 17);
  code.resize(1024, '\x01');
  const Result<CodeInfo> info = ReadCodeInfo(code);
  ASSERT_FALSE(info);
  EXPECT_EQ(info.error().message,
            "is a damaged encoded LF image: its size of 1048576 x 2048 is not between 1 and 2^30 "
            "pixels; copy or make the packed store again");
}

TEST(LfImageCodec, AWrongHeadIsNamedWithItsValue) {
  const auto expect = [](std::string_view head, const std::string& part) {
    const Result<CodeInfo> info = ReadCodeInfo("LFIM" + std::string(head));
    ASSERT_FALSE(info) << part;
    EXPECT_EQ(info.error().message,
              "is a damaged encoded LF image: " + part + "; copy or make the packed store again");
  };
  using namespace std::string_view_literals;
  expect("\0"sv, "its version is 0, expected 1 to 2");
  expect("\x01"sv, "its profile cannot be read");
  expect("\x01\x07"sv, "its profile is 7, expected 0 to 2");
  expect("\x01\x02\x00\x0c"sv, "its depth in bits is 12, expected 8 or 16");
  expect("\x01\x02\x00\x10\x01\x01\x03\x0a\x02"sv,
         "its size of a coefficient in bytes is 2, expected 4");
}

}  // namespace
}  // namespace lf

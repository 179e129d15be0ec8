// SPDX-License-Identifier: Apache-2.0
#include "lf/view/lf_picture.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

// A store whose LF images are uniformly red, except for the upper left quarter, which is masked.
class RedStore : public LfImageStore {
 public:
  explicit RedStore(const LightField& field) : field_(field) {}
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    if (id.value > 0) return InputError("gone.png: not found");
    pixels->Reset(rect, BayerPattern::kNone);
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x) {
        const double v = field_.encoding.Scale() * 0.5 + field_.encoding.pedestal;
        for (int c = 0; c < 3; ++c)
          pixels->radiance.at(x, y, c) =
              static_cast<uint16_t>(c == 0 ? v : field_.encoding.pedestal);
        pixels->radiance.at(x, y, LfPixels::kRayLane) = 1;
        if (x < rect.width() / 2 && y < rect.height() / 2) pixels->Mask(x, y);
      }
    return {};
  }

 private:
  const LightField& field_;
};

// Reduces LF images by up to 4. Only the last pixel is bright; whole LF images cannot be loaded.
class ReducedStore : public LfImageStore {
 public:
  explicit ReducedStore(const LightField& field) : field_(field) {}
  Result<void> Load(LfImageId, const PixelRect&, LfPixels*) const override {
    return InputError("loaded whole");
  }
  Result<int> LoadReduced(LfImageId id, int divisor, const Intrinsics& k,
                          LfPixels* pixels) const override {
    const int reduction = divisor % 4 == 0 ? 4 : divisor % 2 == 0 ? 2 : 1;
    if (reduction == 1) return LfImageStore::LoadReduced(id, divisor, k, pixels);
    pixels->Reset({0, 0, k.width_px / reduction, k.height_px / reduction}, BayerPattern::kNone);
    for (int y = 0; y < pixels->rect.height(); ++y)
      for (int x = 0; x < pixels->rect.width(); ++x) {
        const bool is_last = x == pixels->rect.width() - 1 && y == pixels->rect.height() - 1;
        for (int c = 0; c < 3; ++c)
          pixels->radiance.at(x, y, c) = static_cast<uint16_t>(
              field_.encoding.pedestal + (is_last ? field_.encoding.Scale() : 0));
        pixels->radiance.at(x, y, LfPixels::kRayLane) = 1;
      }
    return reduction;
  }

 private:
  const LightField& field_;
};

LightField TwoImages() {
  LightField field;
  field.intrinsics = {{10, 10, 20, 10, 0, 40, 20}};
  field.cameras.resize(2);
  field.image_names = {"a.png", "gone.png"};
  field.encoding.pedestal = 4096;
  field.encoding.white_balance = {2, 1, 1};
  return field;
}

TEST(LfPicture, IsShrunkenAndDeveloped) {
  const LightField field = TwoImages();
  const auto picture = LfPicture(field, RedStore(field), {0}, 10);
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(picture->width(), 10);
  EXPECT_EQ(picture->height(), 5);
  EXPECT_EQ(picture->at(9, 4, 0), 255);  // 0.5, times a white balance of 2
  EXPECT_EQ(picture->at(9, 4, 1), 0);
  EXPECT_EQ(picture->at(0, 0, 0), 128);  // masked
}

TEST(LfPicture, ALargeImageIsLoadedReduced) {
  LightField field = TwoImages();
  field.intrinsics = {{10, 10, 50, 25, 0, 101, 50}};
  const ReducedStore store(field);
  struct {
    int most_px, width, height, brightness;
  } const wanted[] = {
      {51, 50, 25, 255},  // squares of 2
      {26, 25, 12, 255},  // of 4
      {25, 17, 9, 188},   // of 6: squares of 3 in what is loaded at a half
      {8, 7, 3, 137},     // of 16: of 4 in what is loaded at a quarter
  };
  for (const auto& w : wanted) {
    const auto picture = LfPicture(field, store, {0}, w.most_px);
    ASSERT_TRUE(picture) << w.most_px << ": " << picture.error().message;
    EXPECT_EQ(picture->width(), w.width) << w.most_px;
    EXPECT_EQ(picture->height(), w.height) << w.most_px;
    EXPECT_EQ(picture->at(0, 0, 1), 0) << w.most_px;
    EXPECT_NEAR(picture->at(w.width - 1, w.height - 1, 1), w.brightness, 1) << w.most_px;
  }
  // An odd number of LF pixels cannot be loaded reduced, and a small image need not be.
  for (const int most_px : {34, 101}) {
    const auto picture = LfPicture(field, store, {0}, most_px);
    ASSERT_FALSE(picture) << most_px;
    EXPECT_NE(picture.error().message.find("loaded whole"), std::string::npos);
  }
}

TEST(LfPicture, TellsWhatIsMissing) {
  const LightField field = TwoImages();
  const auto picture = LfPicture(field, RedStore(field), {1}, 10);
  ASSERT_FALSE(picture);
  EXPECT_NE(picture.error().message.find("gone.png"), std::string::npos);
}

}  // namespace
}  // namespace lf

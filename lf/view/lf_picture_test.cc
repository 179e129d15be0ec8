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

TEST(LfPicture, TellsWhatIsMissing) {
  const LightField field = TwoImages();
  const auto picture = LfPicture(field, RedStore(field), {1}, 10);
  ASSERT_FALSE(picture);
  EXPECT_NE(picture.error().message.find("gone.png"), std::string::npos);
}

}  // namespace
}  // namespace lf

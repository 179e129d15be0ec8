// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/colour_space.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <string>

namespace lf {
namespace {

constexpr ColourSpace kAll[] = {ColourSpace::kRec709, ColourSpace::kRec2020, ColourSpace::kAcesCg};

Mat3 FromRec709(ColourSpace to) {
  return LinearFromLinear(PrimariesOf(to), PrimariesOf(ColourSpace::kRec709));
}

void ExpectNear(const Mat3& matrix, const Mat3& published, double tolerance) {
  EXPECT_LT((matrix - published).cwiseAbs().maxCoeff(), tolerance) << matrix;
}

TEST(ColourSpace, MatricesAreThePublishedOnes) {
  Mat3 bt2087;  // ITU-R BT.2087-0, section 2: 4 digits
  bt2087 << 0.6274, 0.3293, 0.0433, 0.0691, 0.9195, 0.0114, 0.0164, 0.0880, 0.8956;
  ExpectNear(FromRec709(ColourSpace::kRec2020), bt2087, 0.0001);
  Mat3 acescg;  // the matrix of the ACES 1.3 configurations of OpenColorIO, rounded
  acescg << 0.61310, 0.33952, 0.04738, 0.07019, 0.91635, 0.01345, 0.02062, 0.10957, 0.86981;
  ExpectNear(FromRec709(ColourSpace::kAcesCg), acescg, 0.00002);
}

TEST(ColourSpace, WhiteStaysWhite) {
  for (const ColourSpace space : kAll)
    EXPECT_LT((FromRec709(space) * Vec3::Ones() - Vec3::Ones()).norm(), 1e-14) << NameOf(space);
}

TEST(ColourSpace, TheWayBackIsTheInverse) {
  for (const ColourSpace space : kAll) {
    Image<float> rgb(2, 2, 4);
    for (size_t i = 0; i < 16; ++i) rgb.pixels()[i] = static_cast<float>(i) / 7 - 0.4F;
    const Image<float> before = rgb;
    ConvertFromRec709(space, &rgb);
    EXPECT_EQ(rgb.pixels() == before.pixels(), space == ColourSpace::kRec709);
    ConvertToRec709(space, &rgb);
    for (size_t i = 0; i < 16; ++i) EXPECT_NEAR(rgb.pixels()[i], before.pixels()[i], 1e-6);
    for (int x = 0; x < 2; ++x) EXPECT_EQ(rgb.at(x, 1, 3), before.at(x, 1, 3));
  }
}

TEST(ColourSpace, NamesAreParsed) {
  for (const ColourSpace space : kAll) EXPECT_EQ(ParseColourSpace(NameOf(space)), space);
  EXPECT_EQ(ParseColourSpace("srgb"), std::nullopt);
}

}  // namespace
}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/hci_archive.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace lf {
namespace {

ViewArray NineByNine() { return *ViewArrayOfDataset({{9, 9, 768, 768, 3}, 'u', 1, {}}, "lf.h5"); }

TEST(HciArchive, StatesPitchFocalLengthAndThePlaneThatStandsStill) {
  const auto archive =
      HciArchiveOf({{"dH", 0.5}, {"focalLength", 840}, {"shift", 42}}, NineByNine(), "lf.h5");
  ASSERT_TRUE(archive);
  EXPECT_EQ(archive->pitch_w, Vec2(0.5, 0.5));
  EXPECT_EQ(archive->focal_px, 840);
  // dH focalLength / Z - shift is 0 at this depth.
  EXPECT_EQ(archive->plane_distance_w, 0.5 * 840 / 42);
  EXPECT_FALSE(archive->unclear_focal_length);
}

TEST(HciArchive, RowsMayBeFartherApartThanColumns) {
  const auto archive = HciArchiveOf({{"dH", 0.5}, {"dV", 0.25}}, NineByNine(), "lf.h5");
  EXPECT_EQ(archive.value().pitch_w, Vec2(0.5, 0.25));
}

TEST(HciArchive, AFileWithoutAttributesStatesNothing) {
  const auto archive = HciArchiveOf({}, NineByNine(), "lf.h5");
  ASSERT_TRUE(archive);
  EXPECT_FALSE(archive->pitch_w || archive->focal_px || archive->plane_distance_w);
}

TEST(HciArchive, ParallelCamerasHaveNoPlane) {
  const auto archive =
      HciArchiveOf({{"dH", 0.5}, {"focalLength", 840}, {"shift", 0}}, NineByNine(), "lf.h5");
  EXPECT_FALSE(archive.value().plane_distance_w);
}

TEST(HciArchive, AFocalLengthInMillimetresIsNotTakenForPixels) {
  for (const double value : {0.035, 35.0, 1e6, -840.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto archive =
        HciArchiveOf({{"dH", 0.5}, {"focalLength", value}, {"shift", 42}}, NineByNine(), "lf.h5");
    ASSERT_TRUE(archive);
    EXPECT_FALSE(archive->focal_px) << value;
    EXPECT_TRUE(archive->unclear_focal_length);
    EXPECT_FALSE(archive->plane_distance_w);
  }
}

TEST(HciArchive, OtherSizesThanThoseOfTheArrayAreRefused) {
  const auto archive = HciArchiveOf({{"hRes", 17}}, NineByNine(), "lf.h5");
  ASSERT_FALSE(archive);
  EXPECT_NE(archive.error().message.find("lf.h5: its attribute hRes is 17"), std::string::npos)
      << archive.error().message;
  EXPECT_TRUE(HciArchiveOf({{"hRes", 9}, {"yRes", 768}, {"channels", 3}}, NineByNine(), "lf.h5"));
}

TEST(HciArchive, LengthsAreAboveZero) {
  for (const char* key : {"dH", "dV"})
    for (const double value : {0.0, -1.0, 1e10, std::numeric_limits<double>::infinity()})
      EXPECT_FALSE(HciArchiveOf({{key, value}}, NineByNine(), "lf.h5")) << key << value;
  EXPECT_FALSE(HciArchiveOf({{"shift", -1}}, NineByNine(), "lf.h5"));
}

TEST(Hdf5Dataset, HasTheShapeAndTypeOfViews) {
  const auto is_read = [](std::vector<size_t> shape, char kind = 'u', size_t bytes = 1) {
    const Hdf5Dataset dataset = {std::move(shape), kind, bytes, {}};
    return static_cast<bool>(ViewArrayOfDataset(dataset, "a.h5"));
  };
  EXPECT_TRUE(is_read({2, 3, 4, 5}));
  EXPECT_TRUE(is_read({2, 3, 4, 5, 4}, 'f', 8));
  EXPECT_FALSE(is_read({2, 3, 4}));
  EXPECT_FALSE(is_read({2, 3, 4, 5, 6}));
  EXPECT_FALSE(is_read({2, 3, 4, 5}, 'i'));
  EXPECT_FALSE(is_read({2, 3, 4, 5}, 'f', 2));
  EXPECT_FALSE(is_read({2, 3, 4, 5}, '?'));
  EXPECT_FALSE(is_read({1 << 20, 1 << 20, 4, 5}));
}

TEST(Hdf5Dataset, KeepsTheChunksThatAViewTouches) {
  const auto cache = [](std::vector<size_t> chunk) {
    const Hdf5Dataset dataset = {{9, 9, 768, 768, 3}, 'u', 1, std::move(chunk)};
    return ViewArrayOfDataset(dataset, "a.h5");
  };
  EXPECT_EQ(cache({}).value().cache_bytes, 0);
  EXPECT_EQ(cache({1, 1, 768, 768, 3}).value().cache_bytes, 768 * 768 * 3);
  EXPECT_EQ(cache({1, 1, 100, 768, 3}).value().cache_bytes, 8 * 100 * 768 * 3);
  EXPECT_EQ(cache({9, 9, 768, 16, 3}).value().cache_bytes, 81 * 768 * 768 * 3)
      << "81 views in each chunk";
  EXPECT_EQ(cache({9, 9, 767, 767, 3}).value().cache_bytes, kMostHdf5ChunkBytes);
  EXPECT_FALSE(cache({9, 9, 768, 768, 64}));
  EXPECT_FALSE(cache({9, 9, 0, 768, 3}));
}

}  // namespace
}  // namespace lf

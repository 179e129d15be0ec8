// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/map_place.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "lf/camera/path/path_yaml.h"
#include "lf/core/file.h"
#include "lf/import/paths/open_path.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/pixels/files/test_geo_tiff.h"

namespace lf {
namespace {

// Returns a height map of one sample that is placed by these tags; an empty list adds none.
std::string MapFile(const std::vector<double>& scale, const std::vector<double>& tie,
                    const std::vector<uint16_t>& keys = {}, const std::string& nodata = "") {
  GeoTiffText file;
  if (!scale.empty()) file.Doubles(33550, scale);
  if (!tie.empty()) file.Doubles(33922, tie);
  if (!keys.empty()) file.Keys(keys);
  if (!nodata.empty()) file.Nodata(nodata);
  return file.Bytes();
}

const std::vector<double> kScale = {0.5, 0.5, 0}, kTie = {0, 0, 0, 500'000, 5'600'000, 0};

class MapPlace : public FolderTest {
 protected:
  // Opens a path with this section, and returns its height map.
  Result<FocalSurfaceSource> Placed(const std::string& keys, double unit_m = 1) {
    const auto path = folder_ / "p.yaml";
    const std::string text =
        "format: lfpath 1\nfps: 1\nframes: 1\nresolution: [16, 12]\n"
        "camera: {sensor_width: 1, focal_length: 1, position: [0, 0, 10], look_at: [0, 0, 0], "
        "up: [0, 1, 0]}\nlens: {aperture_diameter: 1, focus_distance: 5}\n"
        "focus: {surface: map.tif, kind: height" +
        keys + "}\n";
    LF_RETURN_IF_ERROR(WriteFileAtomically(path, text));
    PathOptions options;
    options.light_field_unit_m = unit_m;
    options.surface = PathOptions::Surface::kName;
    LF_ASSIGN_OR_RETURN(const CameraPath opened, OpenPath(path, options));
    return *opened.focal_surface;
  }
  void Expect(const std::string& words, const std::string& keys = "") {
    const auto placed = Placed(keys);
    ASSERT_FALSE(placed) << words;
    EXPECT_NE(placed.error().message.find(words), std::string::npos) << placed.error().message;
  }
  void Write(const std::string& bytes) {
    ASSERT_TRUE(WriteFileAtomically(folder_ / "map.tif", bytes));
  }
};

TEST_F(MapPlace, TagsPlaceTheMapInTheWorld) {
  Write(MapFile(kScale, kTie, {}, "-9999"));
  const auto placed = Placed(", map_origin: [499990, 5600020, 400]", 0.1);
  ASSERT_TRUE(placed) << placed.error().message;
  // 10 m east and 20 m south of the origin of the world; the middle of a sample is 0.25 m inwards.
  EXPECT_NEAR(placed->origin_w.x(), (10 + 0.25) / 0.1, 1e-6);
  EXPECT_NEAR(placed->origin_w.y(), (-20 - 0.25) / 0.1, 1e-6);
  EXPECT_EQ(placed->origin_w.z(), 0);
  EXPECT_TRUE(placed->right_w.isApprox(Vec3(5, 0, 0), 1e-12));
  EXPECT_TRUE(placed->down_w.isApprox(Vec3(0, -5, 0), 1e-12));
  EXPECT_NEAR(placed->scale, 10, 1e-12);
  EXPECT_NEAR(placed->offset_w, -4000, 1e-9);
  EXPECT_EQ(placed->nodata, -9999);
}

TEST_F(MapPlace, GivenValuesOverrideTags) {
  Write(MapFile(kScale, kTie, {}, "-9999"));
  const auto all = Placed(", origin: [1, 2, 3], cell: 0.25, nodata: 7, scale: 3");
  ASSERT_TRUE(all) << all.error().message;
  EXPECT_EQ(all->origin_w, Vec3(1, 2, 3));
  EXPECT_EQ(all->right_w, Vec3(0.25, 0, 0));
  EXPECT_EQ(all->nodata, 7);
  EXPECT_EQ(all->scale, 3);
  const auto origin = Placed(", origin: [1, 2, 3]");
  ASSERT_TRUE(origin) << origin.error().message;
  EXPECT_EQ(origin->origin_w, Vec3(1, 2, 3));
  EXPECT_EQ(origin->right_w, Vec3(0.5, 0, 0));
  EXPECT_EQ(origin->scale, 1);
  EXPECT_EQ(origin->nodata, -9999);
  const auto turned = Placed(", right: [0, 0, -1], down: [1, 0, 0], up: [0, 1, 0], offset: 4");
  ASSERT_TRUE(turned) << turned.error().message;
  EXPECT_TRUE(turned->origin_w.isApprox(Vec3(-5'599'999.75, 0, -500'000.25), 1e-12));
  EXPECT_EQ(turned->offset_w, 4);
}

TEST_F(MapPlace, MapsThatCannotBePlacedAreErrorsThatSayWhy) {
  Write(MapFile({}, {}));
  Expect("focus.origin is missing, and ");
  Expect("focus.cell is missing, and ", ", origin: [0, 0, 0]");
  Write(MapFile(kScale, kTie, {1, 1, 0, 1, 1024, 0, 1, 2}));
  Expect("in degrees");
  Write(MapFile(kScale, kTie, {1, 1, 0, 1, 3076, 0, 1, 9003}));
  Expect("EPSG code 9003");
  Write(MapFile({0.5, 0.6, 0}, kTie));
  Expect("0.5 x 0.6 m");
  Expect("map_origin is used only if", ", origin: [0, 0, 0], map_origin: [1, 2, 3]");
}

}  // namespace
}  // namespace lf

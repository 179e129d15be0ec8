// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_kapture.h"

#include "lf/core/file.h"
#include "lf/import/exports/test_exports.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

struct TextsOfKapture {
  std::string sensors =
      "# kapture format: 1.1\n# sensor_device_id, name, sensor_type, [sensor_params]+\n"
      "a, Hero7, camera, OPENCV, 400, 200, 100, 90, 203, 96, 0.1, 0, 0, 0.01\n"
      "b, , camera, SIMPLE_PINHOLE, 40, 20, 10, 20, 10\n"
      "u, , camera, UNKNOWN_CAMERA, 40, 20\ngps, , gnss, EPSG:4326\n";
  std::string records = "0, a, map/0.jpg\n1, a, map/1.jpg\n2, a, map/2.jpg\n";
  std::string trajectories =
      "0000, a, 1, 0, 0, 0, 0, 0, 0\n"
      "1, a, 0.70710678118654757, 0, 0, 0.70710678118654757, 1, 2, 3\n";
  std::string rigs;

  Result<ExportedCameras> Parse() const {
    return ParseKapture({sensors, records, trajectories, rigs}, "f/sensors");
  }
};

TEST(Kapture, PosesTurnFromTheWorldToTheSensor) {
  const Result<ExportedCameras> cameras = TextsOfKapture().Parse();
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->images.size(), 2u);  // the third has no pose
  EXPECT_EQ(cameras->folder, "f/sensors/records_data");
  EXPECT_EQ(cameras->images[1].name, "map/1.jpg");
  const double r2 = 0.25 * 0.25 + 0.125 * 0.125;
  const Vec2 expected = {203 + 100 * (0.25 * (1 + 0.1 * r2) + 0.01 * (r2 + 2 * 0.0625)),
                         96 + 90 * (0.125 * (1 + 0.1 * r2) + 2 * 0.01 * 0.25 * 0.125)};
  ExpectNear(PixelOf(cameras->images[0], {0.5, 0.25, 2}), expected);
  // (x, y, z) becomes (-y + 1, x + 2, z + 3).
  ExpectNear(PixelOf(cameras->images[1], {-1.75, 0.5, -1}), expected);
}

TEST(Kapture, RigsMayBeInRigs) {
  TextsOfKapture texts;
  texts.records = "7, a, a.jpg\n7, b, b.jpg\n";
  texts.trajectories = "7, car, 1, 0, 0, 0, 0, 0, 1\n";
  texts.rigs =
      "# rig, sensor\nroof, a, 1, 0, 0, 0, 0.5, 0, 0\nroof, b, 1, 0, 0, 0, -0.5, 0, 0\n"
      "car, roof, 1, 0, 0, 0, 0, 2, 0\n";
  const Result<ExportedCameras> cameras = texts.Parse();
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->images.size(), 2u);
  EXPECT_EQ(cameras->images[0].cam_from_world.translation, Vec3(0.5, 2, 1));
  EXPECT_EQ(cameras->images[1].cam_from_world.translation, Vec3(-0.5, 2, 1));
  EXPECT_EQ(cameras->images[1].intrinsics.width_px, 40);
}

void ExpectKaptureFault(const std::string& part, void (*change)(TextsOfKapture* texts)) {
  TextsOfKapture texts;
  change(&texts);
  ExpectFault(texts.Parse(), part);
}

TEST(Kapture, NamesWhatIsWrong) {
  ExpectKaptureFault("f/sensors/sensors.txt: line 3 has the parameter \"x\"",
                     [](auto* t) { t->sensors = Replaced(t->sensors, "203", "x"); });
  ExpectKaptureFault("line 3 has the camera model \"LENS\", which is not supported",
                     [](auto* t) { t->sensors = Replaced(t->sensors, "OPENCV", "LENS"); });
  ExpectKaptureFault("has the size 40.5 x 20",
                     [](auto* t) { t->sensors = Replaced(t->sensors, "HOLE, 40", "HOLE, 40.5"); });
  ExpectKaptureFault("f/sensors/trajectories.txt: line 1 has the tz \"nan\"", [](auto* t) {
    t->trajectories = Replaced(t->trajectories, "0, 0, 0\n", "0, 0, nan\n");
  });
  ExpectKaptureFault("line 1 (2, 0, 0, 0) has the length 2",
                     [](auto* t) { t->trajectories = Replaced(t->trajectories, "a, 1", "a, 2"); });
  ExpectKaptureFault("records_camera.txt: line 1 is of the sensor \"c\", which is no camera",
                     [](auto* t) {
                       t->records = "0, c, c.jpg\n";
                       t->trajectories = "0, c, 1, 0, 0, 0, 0, 0, 0\n";
                     });
  ExpectKaptureFault("is of the sensor \"u\", whose lens is not known", [](auto* t) {
    t->records = "0, u, c.jpg\n";
    t->trajectories = "0, u, 1, 0, 0, 0, 0, 0, 0\n";
  });
  ExpectKaptureFault("f/sensors/rigs.txt: line 1 has no place in its rig",
                     [](auto* t) { t->rigs = "r, a\n"; });
  ExpectKaptureFault("line 3 belongs to rigs that are in each other", [](auto* t) {
    t->rigs = "r, a, 1, 0, 0, 0, 0, 0, 0\na, r, 1, 0, 0, 0, 0, 0, 0\n";
  });
}

using KaptureFolder = FolderTest;

TEST_F(KaptureFolder, AnyOfTheFilesLeadsToTheOthers) {
  const TextsOfKapture texts;
  const std::filesystem::path sensors = folder_ / "sensors";
  ASSERT_TRUE(CreateFolder(sensors));
  ASSERT_TRUE(WriteFileAtomically(sensors / "sensors.txt", texts.sensors));
  ASSERT_TRUE(WriteFileAtomically(sensors / "records_camera.txt", texts.records));
  ASSERT_FALSE(ReadKapture(sensors / "sensors.txt", {}));
  ASSERT_TRUE(WriteFileAtomically(sensors / "trajectories.txt", texts.trajectories));
  const Result<LightField> light_field = ReadKapture(sensors / "trajectories.txt", {});
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->size(), 2u);
}

}  // namespace
}  // namespace lf

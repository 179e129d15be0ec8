// SPDX-License-Identifier: Apache-2.0
#include "lf/render/package/package_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "lf/camera/testing_scenes.h"
#include "lf/core/file.h"
#include "lf/core/random.h"
#include "lf/render/package/package_format.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

// Returns a package with every third of the film's twelve frames, and with 40 of the light field's
// 1000 LF images. The last five of these 40 are neighbours.
Package TestPackage() {
  Package package;
  package.number = 4;
  package.count = 8;
  package.whole = {1000, "0123456789abcdef", "fedcba9876543210"};
  package.choices = {ImageOrder::kRoundRobin,  UINT64_MAX, 17, 0.25, true, RenderMode::kHybrid,
                     RayInterpolation::kPixels};
  package.ranks.end = 1000;
  LightField& field = package.light_field;
  field.folder = "/nowhere/images";
  field.unit_m = 0.01;
  field.depth_range = DepthRange{0.1 + 0.2, 1e3 / 3};
  field.encoding.bayer = BayerPattern::kGrbg;
  field.encoding.transfer = Transfer::kResponse;
  field.encoding.response = {0, 0.1, 1.0 / 3, 1};
  field.encoding.black_level = 64;
  field.encoding.white_level = 4095.5;
  field.encoding.max_radiance = 16;
  field.encoding.masks_clipped = true;
  field.encoding.pedestal = 1024;
  field.encoding.white_balance = {2.1, 1, 1.0 / 7};
  field.encoding.linear_srgb_from_camera << 1, 2, 3, 4, 5, 6, 7, 8, 1.0 / 9;
  for (uint32_t i = 0; i < 40; ++i) {
    const testing::CameraPair pair = testing::RandomDistortedPair(i);
    if (i < 10) field.intrinsics.push_back(pair.lf_camera.intrinsics);
    field.cameras.push_back(
        {pair.lf_camera.cam_from_world, i % 10, 0.5f + 0.1f * static_cast<float>(i)});
    if (i % 4 == 1) field.cameras.back().gain = {1.0f / 3, 1, 2.0f / 3};
    if (i % 3 == 1 && i < 10) field.intrinsics.back().vignetting.v = {-1e-9 / 3, 0, 0.0025};
    if (i == 1) {  // LF images 0 and 1 are a bracket
      field.cameras[1].cam_from_world = field.cameras[0].cam_from_world;
      field.cameras[1].intrinsics_index = 0;
    }
    field.image_names.push_back("bänd/ima'ge " + std::to_string(i) + ".png");
    field.mask_names.push_back(i % 2 == 0 ? "" : "mask.png");
    package.ranks.of_images.push_back((i * 717 + 5) % 1000);
    PackageImage image{25 * i, 1000000000000ULL + i, {}, 0, 0};
    if (i < 35) image = {25 * i, i, {1, 2, 30, 41 + static_cast<int>(i)}, i, uint64_t{i} << 40};
    package.images.push_back(image);
  }
  package.path.fps = 23.976;
  package.path.unit_m = 0.01;
  for (uint32_t f = 0; f < 12; ++f) {
    package.path.cameras.push_back(testing::RandomCameraPair(f).render_camera);
    package.path.cameras.back().transmission =
        std::make_shared<const Transmission>(*Transmission::FromText("00ff/80ff"));
    package.surroundings.push_back({f / 7.0, 0.01 + f, {1.0 / 3, f * 0.1, -2}, f / 9.0});
    if (f % 2 == 0) package.surroundings.back().recorded_distance_w = f / 5.0;
    if (f % 3 != 0) continue;
    PackageFrame frame;
    frame.id = FrameId{f + 1};
    frame.image_count = f;
    frame.ray_count = uint64_t{f} << 40;
    package.frames.push_back(frame);
  }
  return package;
}

class PackageFileTest : public ::testing::Test {
 protected:
  PackageFileTest()
      : folder_(fs::temp_directory_path() /
                ("lf_package_test." + std::to_string(::getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_ / "packages");
    path_ = folder_ / "packages" / "package-0003.lfp";
  }
  ~PackageFileTest() override { fs::remove_all(folder_); }

  void Write(const Package& package) {
    const Result<void> written = WritePackage(path_, package, {"1.2.3", "../field"});
    ASSERT_TRUE(written) << written.error().message;
  }
  std::string Fault(const std::string& bytes, bool check_seal = true) {
    EXPECT_TRUE(WriteFileAtomically(path_, bytes));
    const Result<Package> package = ReadPackage(path_, {check_seal});
    if (package) return "";
    EXPECT_EQ(package.error().kind, ErrorKind::kInput);
    EXPECT_NE(package.error().message.find("package-0003.lfp: "), std::string::npos);
    return package.error().message;
  }

  fs::path folder_;
  fs::path path_;
};

TEST_F(PackageFileTest, KeepsTheMarksOfVirtualImages) {
  Package package = TestPackage();
  Write(package);
  const std::string recorded = *ReadFile(path_);
  EXPECT_EQ(ReadPackage(path_)->whole_virtual_count, 0u);
  EXPECT_EQ(recorded.find("virtual"), std::string::npos);
  package.whole_virtual_count = 500;
  for (uint32_t i = 3; i < 40; i += 5) package.light_field.cameras[i].is_virtual = true;
  Write(package);
  const Result<Package> read = ReadPackage(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->whole_virtual_count, 500u);
  EXPECT_EQ(IdentityOf(read->light_field), IdentityOf(package.light_field));
  for (uint32_t i = 0; i < 40; ++i)
    EXPECT_EQ(read->light_field.cameras[i].is_virtual, i % 5 == 3) << i;
}

Package PackageWithShutter() {
  Package package = TestPackage();
  package.path.shutter = {172.8, 3};
  for (uint32_t i = 0; i < 36; ++i) {
    package.path.instants.push_back(testing::RandomCameraPair(100 + i).render_camera);
    package.path.instants.back().transmission = package.path.cameras.front().transmission;
    package.instant_distances_w.push_back(i / 3 % 3 == 0 ? i / 7.0 : -1);
  }
  return package;
}

TEST_F(PackageFileTest, KeepsTheInstantsOfAShutter) {
  const Package package = PackageWithShutter();
  Write(package);
  const Result<Package> read = ReadPackage(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->path.shutter.angle_deg, 172.8);
  EXPECT_EQ(read->path.shutter.samples, 3);
  ASSERT_EQ(read->path.instants.size(), 36u);
  for (size_t i = 0; i < 36; ++i) {
    EXPECT_EQ(NumbersOfCamera(read->path.instants[i]), NumbersOfCamera(package.path.instants[i]));
    EXPECT_TRUE(
        AreEqual(read->path.instants[i].transmission, package.path.instants[i].transmission));
  }
  EXPECT_EQ(read->instant_distances_w, package.instant_distances_w);
  EXPECT_EQ(read->InstantDistances(FrameId{4})[2], 11 / 7.0);
  EXPECT_TRUE(read->InstantDistances(FrameId{2}).empty());
  Write(TestPackage());
  EXPECT_FALSE(ReadPackage(path_)->path.shutter.exists());
  EXPECT_EQ(ReadFile(path_)->find("shutter"), std::string::npos);
  EXPECT_EQ(ReadFile(path_)->find("instants"), std::string::npos);
}

TEST_F(PackageFileTest, WrongInstantsAreDamage) {
  for (const auto& [sql, words] :
       {std::pair("delete from instants where frame = 5 and instant = 2",
                  "expected instant 2 of frame 5, found instant 3 of frame 5"),
        std::pair("delete from instants where frame = 12", "33 instants, expected 36"),
        std::pair("insert into instants select 13, 1, time_s, camera, camera_distance from "
                  "instants where frame = 12 and instant = 1",
                  "expected instant 1 of frame 13"),
        std::pair("update instants set camera_distance = -2 where frame = 2",
                  "the distance between LF cameras at instant 1 of frame 2 is impossible"),
        std::pair("update instants set camera_distance = -1 where frame = 4 and instant = 3",
                  "instants of frame 4 are missing or impossible"),
        std::pair("update settings set value = '65' where key = 'shutter_samples'",
                  "setting shutter_samples"),
        std::pair("update settings set value = '2.5' where key = 'shutter_samples'",
                  "setting shutter_samples"),
        std::pair("update settings set value = '361' where key = 'shutter_angle_deg'",
                  "setting shutter_angle_deg"),
        std::pair("delete from settings where key = 'shutter_samples'",
                  "only one of the shutter and the cameras of its instants")}) {
    Write(PackageWithShutter());
    ASSERT_TRUE(Database::OpenToAppend(path_, kPackageFormat).value().Execute(sql)) << sql;
    const Result<Package> read = ReadPackage(path_, {.check_seal = false});
    ASSERT_FALSE(read) << sql;
    EXPECT_NE(read.error().message.find(words), std::string::npos) << read.error().message;
  }
}

TEST_F(PackageFileTest, WrongMarksOfVirtualImagesAreDamage) {
  Package package = TestPackage();
  package.whole_virtual_count = 1;
  package.light_field.cameras[2].is_virtual = true;
  for (const auto& [sql, words] :
       {std::pair("insert into virtual_images values (51)", "LF image 51 is virtual, but missing"),
        std::pair("insert into virtual_images values (4294967346)", "is virtual, but missing"),
        std::pair("update settings set value = '1001' where key = 'light_field.virtual'",
                  "setting light_field.virtual"),
        std::pair("update settings set value = '0' where key = 'light_field.virtual'",
                  "setting light_field.virtual"),
        std::pair("delete from settings where key = 'light_field.virtual'",
                  "setting light_field.virtual")}) {
    Write(package);
    ASSERT_TRUE(Database::OpenToAppend(path_, kPackageFormat).value().Execute(sql)) << sql;
    const Result<Package> read = ReadPackage(path_, {.check_seal = false});
    ASSERT_FALSE(read) << sql;
    EXPECT_NE(read.error().message.find(words), std::string::npos) << read.error().message;
  }
}

TEST_F(PackageFileTest, ReadsWhatWasWrittenToTheBit) {
  const Package package = TestPackage();
  Write(package);
  const Result<Package> read = ReadPackage(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->name, "package-0003");
  EXPECT_EQ(read->number, 4u);
  EXPECT_EQ(read->count, 8u);
  EXPECT_EQ(read->whole, package.whole);
  EXPECT_EQ(read->choices.order, package.choices.order);
  EXPECT_EQ(read->choices.seed, package.choices.seed);
  EXPECT_EQ(read->choices.max_image_count, package.choices.max_image_count);
  EXPECT_EQ(read->choices.max_angle_rad, package.choices.max_angle_rad);
  EXPECT_EQ(read->choices.has_neighbours, package.choices.has_neighbours);
  EXPECT_EQ(read->choices.mode, package.choices.mode);
  EXPECT_EQ(read->choices.interpolation, RayInterpolation::kPixels);
  EXPECT_EQ(read->ranks.of_images, package.ranks.of_images);
  EXPECT_EQ(read->ranks.end, package.ranks.end);

  // The first two LF images have one pose and different gains.
  EXPECT_TRUE(read->light_field.cameras[0].masks_clipped);
  EXPECT_EQ(read->light_field.cameras[1].brighter, 0U);

  const LightField &a = read->light_field, &b = package.light_field;
  EXPECT_EQ(IdentityOf(a), IdentityOf(b));
  EXPECT_EQ(a.image_names, b.image_names);
  EXPECT_EQ(a.mask_names, b.mask_names);
  EXPECT_EQ(a.folder, b.folder);
  EXPECT_EQ(a.unit_m, b.unit_m);
  EXPECT_EQ(a.depth_range, b.depth_range);
  EXPECT_EQ(a.encoding.bayer, b.encoding.bayer);
  EXPECT_EQ(a.encoding.transfer, b.encoding.transfer);
  EXPECT_EQ(a.encoding.response, b.encoding.response);
  EXPECT_EQ(a.encoding.black_level, b.encoding.black_level);
  EXPECT_EQ(a.encoding.white_level, b.encoding.white_level);
  EXPECT_EQ(a.encoding.max_radiance, b.encoding.max_radiance);
  EXPECT_EQ(a.encoding.masks_clipped, b.encoding.masks_clipped);
  EXPECT_EQ(a.encoding.pedestal, b.encoding.pedestal);
  EXPECT_EQ(a.encoding.white_balance, b.encoding.white_balance);
  EXPECT_EQ(a.encoding.linear_srgb_from_camera, b.encoding.linear_srgb_from_camera);
  for (size_t i = 0; i < package.images.size(); ++i) {
    EXPECT_EQ(read->images[i].id, package.images[i].id);
    EXPECT_EQ(read->images[i].file_bytes, package.images[i].file_bytes);
    EXPECT_EQ(read->images[i].rect, package.images[i].rect);
    EXPECT_EQ(read->images[i].frame_count, package.images[i].frame_count);
    EXPECT_EQ(read->images[i].ray_count, package.images[i].ray_count);
  }

  EXPECT_EQ(read->path.fps, package.path.fps);
  EXPECT_EQ(read->path.unit_m, package.path.unit_m);
  ASSERT_EQ(read->path.frame_count(), package.path.frame_count());
  for (uint32_t n = 1; n <= 12; ++n) {
    const RenderCamera &c = read->path.Camera(FrameId{n}), &d = package.path.Camera(FrameId{n});
    EXPECT_EQ(c.pinhole.intrinsics, d.pinhole.intrinsics);
    EXPECT_EQ(c.pinhole.cam_from_world.rotation, d.pinhole.cam_from_world.rotation);
    EXPECT_EQ(c.pinhole.cam_from_world.translation, d.pinhole.cam_from_world.translation);
    EXPECT_EQ(c.aperture.radius_w, d.aperture.radius_w);
    EXPECT_EQ(c.aperture.blades, d.aperture.blades);
    EXPECT_EQ(c.aperture.rotation_rad, d.aperture.rotation_rad);
    EXPECT_EQ(c.aperture.ratio, d.aperture.ratio);
    EXPECT_EQ(c.aperture.roundness, d.aperture.roundness);
    EXPECT_EQ(c.hood.distance_w, d.hood.distance_w);
    EXPECT_EQ(c.hood.radius_w, d.hood.radius_w);
    EXPECT_TRUE(AreEqual(c.transmission, d.transmission));
    EXPECT_EQ(c.focus_plane.normal, d.focus_plane.normal);
    EXPECT_EQ(c.focus_plane.offset_w, d.focus_plane.offset_w);
    EXPECT_EQ(c.focus_tilt.vertical_rad, d.focus_tilt.vertical_rad);
    EXPECT_EQ(c.unit_m, d.unit_m);
  }
  ASSERT_EQ(read->surroundings.size(), package.surroundings.size());
  for (size_t f = 0; f < package.surroundings.size(); ++f) {
    const FrameSurroundings &a_frame = read->surroundings[f], &b_frame = package.surroundings[f];
    EXPECT_EQ(a_frame.camera_distance_w, b_frame.camera_distance_w);
    EXPECT_EQ(a_frame.pixel_rad, b_frame.pixel_rad);
    EXPECT_EQ(a_frame.middle_world, b_frame.middle_world);
    EXPECT_EQ(a_frame.hole_w, b_frame.hole_w);
    EXPECT_EQ(a_frame.recorded_distance_w, b_frame.recorded_distance_w);
    EXPECT_EQ(read->RecordedCameraDistance(FrameId{static_cast<uint32_t>(f) + 1}),
              b_frame.recorded_distance_w.value_or(b_frame.camera_distance_w));
    EXPECT_EQ(read->CameraDistance(FrameId{static_cast<uint32_t>(f) + 1}),
              b_frame.camera_distance_w);
  }
  EXPECT_EQ(read->FrameIds(), package.FrameIds());
  for (size_t f = 0; f < package.frames.size(); ++f) {
    EXPECT_EQ(read->frames[f].image_count, package.frames[f].image_count);
    EXPECT_EQ(read->frames[f].ray_count, package.frames[f].ray_count);
  }
}

// Packages that were made before there were kept pixels do not have the setting.
TEST_F(PackageFileTest, AModeWithoutInterpolationHasCells) {
  const auto changed = [this](const std::string& statement) {
    Write(TestPackage());
    EXPECT_TRUE(Database::OpenToAppend(path_, kPackageFormat).value().Execute(statement));
    return ReadPackage(path_, {.check_seal = false});
  };
  const Result<Package> old = changed("delete from settings where key = 'interpolation'");
  ASSERT_TRUE(old) << old.error().message;
  EXPECT_EQ(old->choices.interpolation, RayInterpolation::kCells);
  const Result<Package> wrong =
      changed("update settings set value = 'auto' where key = 'interpolation'");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("setting interpolation"), std::string::npos)
      << wrong.error().message;
  Package collected = TestPackage();
  collected.choices.mode = RenderMode::kCollect;
  collected.choices.interpolation = RayInterpolation::kAuto;
  Write(collected);
  EXPECT_EQ(ReadPackage(path_).value().choices.interpolation, RayInterpolation::kAuto);
}

TEST_F(PackageFileTest, KeepsTheNumbersOfTheFrames) {
  Package package = TestPackage();
  package.path.first_frame = 1001;
  for (PackageFrame& frame : package.frames) frame.id.value += 1000;
  Write(package);
  const Result<Package> read = ReadPackage(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->path.frames(), (FrameNumbers{1001, 12}));
  EXPECT_EQ(read->FrameIds(), package.FrameIds());
  for (const FrameId frame : package.path.frames().All())
    EXPECT_EQ(read->CameraDistance(frame), package.CameraDistance(frame));
  for (const auto& [first, words] :
       {std::pair("1000", "frame 1000 is missing"), std::pair("-1", "setting first_frame")}) {
    Write(package);
    ASSERT_TRUE(Database::OpenToAppend(path_, kPackageFormat)
                    .value()
                    .Execute(std::string("update settings set value = '") + first +
                             "' where key = 'first_frame'"));
    const Result<Package> wrong = ReadPackage(path_, {.check_seal = false});
    ASSERT_FALSE(wrong) << first;
    EXPECT_NE(wrong.error().message.find(words), std::string::npos) << wrong.error().message;
  }
}

// Equal packages have equal checksums, because their bytes are equal.
TEST_F(PackageFileTest, TheSamePackageHasTheSameBytes) {
  Write(TestPackage());
  const std::string first = *ReadFile(path_);
  Write(TestPackage());
  EXPECT_EQ(*ReadFile(path_), first);
}

TEST_F(PackageFileTest, EveryFlippedByteIsAnError) {
  Write(TestPackage());
  const std::string whole = *ReadFile(path_);
  EXPECT_EQ(Fault(whole), "");
  for (uint64_t i = 0; i < 300; ++i) {
    std::string damaged = whole;
    const size_t at = RandomBits(5, 0, i) % whole.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << i % 8));
    EXPECT_NE(Fault(damaged), "") << at;
    // Without the check of the footer, the damage may remain undetected, but reading must not
    // crash.
    Fault(damaged, false);
  }
}

// If the missing frame were ignored, the frames after it would get wrong numbers.
TEST_F(PackageFileTest, AFrameThatIsMissingIsAnError) {
  Package package = TestPackage();
  package.choices.has_neighbours = false;
  package.surroundings.clear();
  for (const int frame : {1, 6, 11}) {
    Write(package);
    {
      Database database = Database::OpenToAppend(path_, kPackageFormat).value();
      ASSERT_TRUE(database.Execute("delete from frames where frame = " + std::to_string(frame)));
    }
    const Result<Package> read = ReadPackage(path_, {.check_seal = false});
    ASSERT_FALSE(read) << frame;
    EXPECT_NE(read.error().message.find("frame " + std::to_string(frame) + " is missing"),
              std::string::npos)
        << read.error().message;
  }
}

TEST_F(PackageFileTest, ALimitOfNoLfImagesIsAnError) {
  Package package = TestPackage();
  package.choices.max_image_count = 0;
  Write(package);
  EXPECT_NE(Fault(ReadFile(path_).value()).find("max_images is '0', expected 1 or more"),
            std::string::npos);
}

TEST_F(PackageFileTest, CutAndForeignFilesAreErrors) {
  Write(TestPackage());
  const std::string whole = *ReadFile(path_);
  for (const size_t size :
       {whole.size() - 1, whole.size() / 2, size_t{5000}, size_t{100}, size_t{0}})
    EXPECT_NE(Fault(whole.substr(0, size)), "") << size;
  EXPECT_NE(Fault("no package"), "");
  std::string newer = whole;
  newer[63] = 4;  // last byte of user_version (big-endian, offset 60)
  EXPECT_NE(Fault(newer).find("of version 4, which a newer"), std::string::npos) << Fault(newer);
  std::string other = whole;
  other[71] = 'X';  // last byte of application_id (offset 68)
  EXPECT_NE(Fault(other).find("is no package"), std::string::npos);
}

TEST_F(PackageFileTest, TheFolderMayMoveWithThePackages) {
  Package package = TestPackage();
  fs::create_directories(folder_ / "field" / "images");
  package.light_field.folder = folder_ / "field" / "images";
  Write(package);
  const fs::path moved = folder_.string() + ".moved";
  fs::rename(folder_, moved);
  EXPECT_EQ(ReadPackage(moved / "packages" / "package-0003.lfp")->light_field.folder,
            moved / "field" / "images");
  fs::rename(moved, folder_);
  EXPECT_EQ(ReadPackage(path_)->light_field.folder, folder_ / "field" / "images");
}

TEST_F(PackageFileTest, NothingIsLeftWhereItCannotBeWritten) {
  path_ = folder_ / "no" / "folder" / "package-0003.lfp";
  const Result<void> written = WritePackage(path_, TestPackage(), {});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf

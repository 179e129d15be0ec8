// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/plate_notes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lf/render/state/run_inputs.h"

namespace lf {
namespace {

PlateNotes Notes() {
  PlateNotes notes;
  notes.frame = FrameId{17};
  RenderCamera& camera = notes.camera;
  camera.pinhole.intrinsics = {100.1, 1.0 / 3, 50, 40.7, 1e-9, 96, 64};
  camera.pinhole.cam_from_world = *LookAlong({0.1, 0.2, 0.3}, {1, 2, 3}, {0, -1, 0});
  camera.aperture = {0.1, 5, 0.3, 1.0 / 3, 0.7};
  camera.hood = {0.2, 1.0 / 7};
  camera.transmission = std::make_shared<const Transmission>(*Transmission::FromText("00ff/8000"));
  camera.focus_plane = FocusPlane(camera.pinhole, 2.2, {0.1, 0.2});
  camera.time_s = 0.1;
  camera.focal_length_w = 0.05;
  camera.sensor_width_w = 0.036;
  camera.focus_distance_w = 2.2;
  camera.focus_tilt = {0.1, 0.2};
  camera.unit_m = 1e-3;
  notes.fps = 23.976;
  notes.estimator = Estimator::kNearest;
  notes.version = "1.2.3";
  notes.rays = {12, uint64_t{1} << 40, 34567, 5};
  notes.develop.pedestal = 1024;
  notes.develop.scale = 65535 / 16.0;
  notes.develop.white_balance = {2.1, 1, 1.7};
  notes.develop.linear_srgb_from_camera << 1.1, -0.1, 0, 0.2, 0.9, -0.1, 0, 0.3, 0.7;
  notes.develop.smooth_below = 3;
  notes.develop.fill_radius_px = 7;
  Image<float> counts(12, 8);
  for (size_t i = 0; i < counts.pixels().size(); ++i)
    counts.pixels()[i] = static_cast<float>(i) / 7;
  notes.weighed = PlateNotes::Weighed{0.25, {1e-17, 0.1}, counts};
  return notes;
}

TEST(PlateNotes, ComesBackAsTheSameBits) {
  const PlateNotes notes = Notes();
  const Result<PlateNotes> read = PlateNotesOf(TextOf(notes), 96, 64, "p");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(TextOf(*read), TextOf(notes));
  EXPECT_EQ(read->frame, notes.frame);
  EXPECT_EQ(read->camera.pinhole.intrinsics, notes.camera.pinhole.intrinsics);
  EXPECT_EQ(read->camera.pinhole.cam_from_world.rotation,
            notes.camera.pinhole.cam_from_world.rotation);
  EXPECT_EQ(read->camera.focus_plane.normal, notes.camera.focus_plane.normal);
  EXPECT_EQ(read->camera.focus_tilt.vertical_rad, 0.2);
  EXPECT_EQ(read->develop.linear_srgb_from_camera, notes.develop.linear_srgb_from_camera);
  EXPECT_EQ(read->rays.tested_count, uint64_t{1} << 40);
  EXPECT_EQ(read->rays.image_count, 12u);
  EXPECT_EQ(read->rays.virtual_count, 5u);
  EXPECT_EQ(read->weighed->effective_counts.pixels(), notes.weighed->effective_counts.pixels());
}

TEST(PlateNotes, TheShutterComesBack) {
  PlateNotes notes = Notes();
  EXPECT_EQ(FindEntry(TextOf(notes), "plate.shutter"), nullptr);
  notes.shutter = FrameShutter{{172.8, 8}, "0123456789abcdef"};
  const Result<PlateNotes> read = PlateNotesOf(TextOf(notes), 96, 64, "p");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->shutter->shutter.angle_deg, 172.8);
  EXPECT_EQ(read->shutter->shutter.samples, 8);
  EXPECT_EQ(read->shutter->cameras, "0123456789abcdef");
  for (const char* const wrong :
       {"", "180", "180 8", "180 8 ", "361 8 0123456789abcdef", "-1 8 0123456789abcdef",
        "180 1 0123456789abcdef", "180 65 0123456789abcdef", "180 8 0123456789abcdeg",
        "180 8 0123456789abcdef0", "180  8 0123456789abcdef", "nan 8 0123456789abcdef"}) {
    PlateEntries entries = TextOf(Notes());
    entries.emplace_back("plate.shutter", wrong);
    const Result<PlateNotes> fault = PlateNotesOf(entries, 96, 64, "p");
    ASSERT_FALSE(fault) << wrong;
    EXPECT_NE(fault.error().message.find("plate.shutter"), std::string::npos);
  }
}

TEST(PlateNotes, NamesOfLfImagesThatAreMissingComeBackInAnyBytes) {
  PlateNotes notes = Notes();
  notes.skipped = {"a, b.png", "c\n\"d\".png", "\xc3\xa9.png"};
  notes.skipped_count = 5;
  const PlateEntries text = TextOf(notes);
  for (const auto& [key, value] : text)
    EXPECT_TRUE(std::all_of(value.begin(), value.end(), [](char c) { return c >= ' '; })) << key;
  const Result<PlateNotes> read = PlateNotesOf(text, 96, 64, "p");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->skipped_count, 5u);
  EXPECT_EQ(read->skipped, notes.skipped);
  // The text has only the first names, up to a limit; the count includes all names.
  notes.skipped.assign(100'000, "a_name_of_some_length.png");
  notes.skipped_count = notes.skipped.size();
  const Result<PlateNotes> many = PlateNotesOf(TextOf(notes), 96, 64, "p");
  ASSERT_TRUE(many);
  EXPECT_EQ(many->skipped_count, 100'000u);
  EXPECT_GT(many->skipped.size(), 1000u);
  EXPECT_LT(FindEntry(TextOf(notes), "plate.skipped")->size(), size_t{300} << 10);
}

TEST(PlateNotes, ListsOfMissingLfImagesAreChecked) {
  const auto fault = [](const std::string& count, const std::string& names) {
    PlateEntries entries = TextOf(Notes());
    entries.emplace_back("plate.lf_images_skipped", count);
    entries.emplace_back("plate.skipped", names);
    const Result<PlateNotes> read = PlateNotesOf(entries, 96, 64, "p");
    return read ? std::string() : read.error().message;
  };
  EXPECT_EQ(fault("1", "[\"a\"]"), "");
  for (const char* names : {"", "a", "[1]", "{}", "[\"a\""})
    EXPECT_NE(fault("1", names).find("p: plate.skipped is"), std::string::npos) << names;
  EXPECT_NE(fault("1", "[\"a\",\"b\"]").find("at most 1 names"), std::string::npos);
  EXPECT_NE(fault("-1", "[]").find("p: plate.lf_images_skipped is"), std::string::npos);
}

TEST(PlateNotes, OtherVersionsOfTheRayModelAreRefused) {
  for (const int difference : {-1, 0, 1}) {
    PlateEntries entries = TextOf(Notes());
    entries.emplace_back(kRayModelKey, std::to_string(kRayModelVersion + difference));
    const Result<PlateNotes> read = PlateNotesOf(entries, 96, 64, "p");
    EXPECT_EQ(read.has_value(), difference == 0);
    const std::string message = read ? "p: ray_model is \"" : read.error().message;
    EXPECT_TRUE(message.starts_with("p: ray_model is \"")) << message;
  }
}

TEST(PlateNotes, FaultsAreNamed) {
  const auto fault = [](const std::string& key, const std::optional<std::string>& value) {
    PlateEntries entries = TextOf(Notes());
    const auto entry = std::find_if(entries.begin(), entries.end(),
                                    [&](const auto& one) { return one.first == key; });
    if (value)
      entry->second = *value;
    else
      entries.erase(entry);
    const Result<PlateNotes> read = PlateNotesOf(entries, 96, 64, "p");
    return read ? std::string() : read.error().message;
  };
  for (const char* key :
       {"plate.frame", "plate.intrinsics", "plate.pose", "plate.aperture", "plate.focus_plane",
        "plate.lens", "plate.fps", "plate.estimator", "plate.version", "plate.develop",
        "plate.smooth_below", "plate.fill", "plate.lf_images", "plate.rays_tested",
        "plate.rays_accepted", "plate.effective"}) {
    EXPECT_NE(fault(key, {}).find(std::string("p: has no entry ") + key), std::string::npos) << key;
    if (std::string(key) == "plate.version") continue;
    for (const char* value : {"", "x", "1 2 nan", "1,2", "-1e999"})
      EXPECT_NE(fault(key, value).find(std::string("p: ") + key + " is \"" + value),
                std::string::npos)
          << key << " " << value;
  }
  EXPECT_NE(fault("plate.aperture", "1 2 0"), "");
  EXPECT_NE(fault("plate.lens_shape", "11 0 0 0"), "");
  EXPECT_NE(fault("plate.lens_shape", "1 0 0 -0.1"), "");
  EXPECT_EQ(fault("plate.lens_shape", {}), "");  // valid: a lens without a shape
  EXPECT_NE(fault("plate.develop", "0 0 1 1 1 1 0 0 0 1 0 0 0 1"), "");
  EXPECT_EQ(fault("plate.weights", {}), "");  // valid: a frame without lens weights
}

}  // namespace
}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/run_state.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "lf/core/file.h"
#include "lf/film/plate/test_plate.h"
#include "lf/pixels/files/image_file.h"
#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

class RunStateTest : public ::testing::Test {
 protected:
  RunStateTest() {
    static int count = 0;
    folder_ = fs::temp_directory_path() /
              ("lf_run_state_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    path_.cameras = testing::NoiseFrames();
  }
  ~RunStateTest() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  Result<std::unique_ptr<RunState>> Open(bool resume, bool overwrite = false, uint64_t seed = 0) {
    RunChoices choices;
    choices.film.seed = seed;
    std::vector<FrameId> frames;
    for (uint32_t n = 1; n <= path_.frame_count(); ++n) frames.push_back(FrameId{n});
    return RunState::Open(
        {folder_, "", frames, FrameFormat::kExrHalf, resume, overwrite,
         InputsOfRays(IdentityOf(field_), field_.encoding, choices), InputsOfPicture(choices)},
        path_);
  }
  // Leaves a state in which frame 2 is begun and frame 3 is finished.
  void LeaveUnfinished() {
    const std::unique_ptr<RunState> state = *Open(false);
    ASSERT_TRUE(state->SavePlate(FrameId{2}, progress_, plate_, pool_));
    const Image<float> picture(8, 40, 1);
    ASSERT_TRUE(WriteImage(folder_ / "frame_0003.exr", picture.view(), {"Y"}, PixelType::kHalf));
    FrameReport frame;
    frame.frame = FrameId{3};
    frame.rays.accepted_count = 77;
    frame.camera = InputsOfCamera(FrameId{3}, path_.Camera(FrameId{3}));
    ASSERT_TRUE(state->SaveFinished(frame));
  }

  // Saves one rebinned ray, for section 0 of a pass of frames 1 to 3.
  void AddRays() {
    BinnedRay ray;
    ray.cell = 5;
    ray.rgb = {1000, 2000, 3000};
    RayMap map(1000);
    map.Add(RayMap::ShardOf(ray.cell), std::span(&ray, 1));
    const std::unique_ptr<RunState> state = *Open(true);
    ASSERT_TRUE(state->SaveRays(FrameId{1}, 0, "1-3", map, 128, pool_));
  }

  // Saves one kept pixel of LF image 4, for a pass of frames 1 to 3.
  void AddKept() {
    KeptImage image;
    image.id = LfImageId{4};
    image.width_px = 3;
    image.height_px = 2;
    image.rect = {1, 0, 3, 2};
    image.places = {3};
    image.values = {1000, 2000, 3000};
    KeptPixels pixels(1000);
    pixels.Add({image}, pool_);
    const std::unique_ptr<RunState> state = *Open(true);
    ASSERT_TRUE(state->SaveKept(FrameId{1}, "1-3", pixels, 64, pool_));
    EXPECT_TRUE(state->HasPlates());
  }
  fs::path KeptFile() const { return folder_ / "partial" / "kept_0001.pixels"; }

  fs::path folder_;
  CameraPath path_;
  const LightField field_ = testing::NoiseField();
  ThreadPool pool_{2};
  const FrameProgress progress_ = {128, {50, 5000, 4000}};
  const SensorPlate plate_ = testing::NoisePlate(80, 60, 7, SensorPlate::kMaxCount, true);
};

TEST_F(RunStateTest, GoesOnWhereItWas) {
  LeaveUnfinished();
  const auto state = Open(true);
  ASSERT_TRUE(state) << state.error().message;
  ASSERT_EQ((*state)->finished().size(), 1u);
  EXPECT_EQ((*state)->finished().at(FrameId{3}).rays.accepted_count, 77u);
  SensorPlate plate(80, 60);
  const Result<FrameProgress> progress = (*state)->LoadPlate(FrameId{2}, &plate);
  ASSERT_TRUE(progress);
  EXPECT_EQ(progress->ranks_done, 128u);
  EXPECT_EQ(progress->rays.tested_count, 5000u);
  EXPECT_EQ(plate, plate_);
  SensorPlate fresh(80, 60);
  EXPECT_EQ((*state)->LoadPlate(FrameId{1}, &fresh)->ranks_done, 0u);
}

TEST_F(RunStateTest, LeavesNothingWhenAllIsDone) {
  {
    const std::unique_ptr<RunState> state = *Open(false);
    FrameReport frame;
    frame.frame = FrameId{1};
    ASSERT_TRUE(state->SavePlate(FrameId{1}, progress_, plate_, pool_));
    ASSERT_TRUE(state->SaveTotals({}));
    ASSERT_TRUE(state->SaveFinished(frame));
    ASSERT_TRUE(state->Close({}));
  }
  EXPECT_FALSE(fs::exists(folder_ / "partial"));
  EXPECT_TRUE(fs::exists(folder_ / "report.json"));
}

TEST_F(RunStateTest, IsNotTouchedUnlessAskedFor) {
  LeaveUnfinished();
  const auto refused = Open(false);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_NE(refused.error().message.find("1 frames finished, 1 begun"), std::string::npos);
  EXPECT_TRUE(Open(true));
  EXPECT_TRUE(Open(false, true));
  EXPECT_FALSE(fs::exists(folder_ / "partial"));
  EXPECT_TRUE(Open(false));
}

TEST_F(RunStateTest, AnInterruptionSaysWhatIsKept) {
  const std::string folder = folder_.string();
  const std::vector<FrameId> frames = {FrameId{1}, FrameId{2}};
  {
    const std::unique_ptr<RunState> state = *Open(false);
    EXPECT_EQ(state->Interruption(frames).kind, ErrorKind::kInterrupted);
    EXPECT_EQ(state->Interruption(frames).message,
              fmt::format("interrupted after 0 of {} frames; nothing was made yet", frames.size()));
    ASSERT_TRUE(state->SavePlate(FrameId{2}, progress_, plate_, pool_));
    EXPECT_EQ(state->Interruption(frames).message,
              fmt::format("interrupted after 0 of {} frames; the state is kept in {}",
                          frames.size(), folder));
    FrameReport frame;
    frame.frame = FrameId{2};
    ASSERT_TRUE(state->SaveFinished(frame));
    EXPECT_EQ(state->Interruption(frames).message,
              fmt::format("interrupted after 1 of {} frames; finished frames are kept in {}",
                          frames.size(), folder));
    ASSERT_TRUE(state->SavePlate(FrameId{1}, progress_, plate_, pool_));
    EXPECT_EQ(state->Interruption(frames).message,
              fmt::format("interrupted after 1 of {} frames; finished frames and the state are "
                          "kept in {}",
                          frames.size(), folder));
  }
}

TEST_F(RunStateTest, OtherInputsAreNamed) {
  LeaveUnfinished();
  auto refused = Open(true, false, 9);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("seed 0, this call has 9"), std::string::npos);
  path_.cameras[1].aperture.blades = 8;
  refused = Open(true);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("frame_0002.plate"), std::string::npos);
  EXPECT_NE(refused.error().message.find("frame.blades 5, this call has 8"), std::string::npos);
  path_.cameras.pop_back();
  refused = Open(true);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("frame 3, but the camera path has the frames 1 to 2"),
            std::string::npos);
}

// The frames of two films in one folder would look like one film.
TEST_F(RunStateTest, FramesOfAnotherFilmAreNotLeftBesideNewOnes) {
  const auto open = [this](std::vector<FrameId> written, uint64_t seed, bool overwrite = false) {
    RunChoices choices;
    choices.film.seed = seed;
    RunStateOptions options = {folder_,
                               "",
                               {},
                               FrameFormat::kExrHalf,
                               false,
                               overwrite,
                               InputsOfRays(IdentityOf(field_), field_.encoding, choices),
                               InputsOfPicture(choices)};
    for (uint32_t n = 1; n <= path_.frame_count(); ++n) options.frames.push_back(FrameId{n});
    options.written = std::move(written);
    return RunState::Open(options, path_);
  };
  const auto leave_finished = [&] {
    fs::remove_all(folder_);
    LeaveUnfinished();
    const std::unique_ptr<RunState> state = *Open(true);
    RenderReport report;
    for (const auto& [frame, finished] : state->finished()) report.frames.push_back(finished);
    RunChoices choices;
    report.inputs = InputsOfRays(IdentityOf(field_), field_.encoding, choices);
    for (const auto& input : InputsOfPicture(choices)) report.inputs.push_back(input);
    state->RemoveAll();
    ASSERT_TRUE(state->Close(report));
  };
  leave_finished();
  const auto refused = open({FrameId{1}}, 7);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_NE(refused.error().message.find(
                "a file is a frame of another film; the first, frame_0003.exr, was rendered with "),
            std::string::npos)
      << refused.error().message;
  EXPECT_TRUE(fs::exists(folder_ / "report.json"));
  EXPECT_TRUE(open({FrameId{1}, FrameId{3}}, 7));  // nothing stays
  leave_finished();
  {
    const Result<std::unique_ptr<RunState>> state = open({FrameId{1}}, 0);  // the same film
    ASSERT_TRUE(state);
    FrameReport frame;
    frame.frame = FrameId{1};
    RenderReport report;
    report.frames = {frame};
    ASSERT_TRUE((*state)->Close(report));
  }
  // The report has the frame that stays, so that another film is still refused.
  EXPECT_EQ(ReadReport(folder_ / "report.json")->frames.size(), 2);
  leave_finished();
  EXPECT_TRUE(open({FrameId{1}}, 7, true));
  leave_finished();
  path_.cameras[2].aperture.radius_w *= 2;  // the same light field, but another path
  EXPECT_FALSE(open({FrameId{1}}, 0));
  fs::remove(folder_ / "frame_0003.exr");
  EXPECT_TRUE(open({FrameId{1}}, 0));
}

TEST_F(RunStateTest, AFinishedFrameThatWasRemovedIsRenderedAgain) {
  LeaveUnfinished();
  fs::remove(folder_ / "frame_0003.exr");
  EXPECT_TRUE((*Open(true))->finished().empty());
}

TEST_F(RunStateTest, AFinishedFrameThatWasCutIsRenderedAgain) {
  LeaveUnfinished();
  const fs::path picture = folder_ / "frame_0003.exr";
  fs::resize_file(picture, fs::file_size(picture) - 1);
  EXPECT_TRUE((*Open(true))->finished().empty());
}

TEST_F(RunStateTest, WhatAKilledProcessLeftIsCleared) {
  LeaveUnfinished();
  const fs::path partial = folder_ / "partial";
  std::ofstream(partial / ".frame_0002.123-00ab12cd.tmp.plate") << "half";
  std::ofstream(folder_ / ".frame_0003.123-00ab12cd.tmp.exr") << "half";
  std::ofstream(folder_ / ".hidden.tmp.txt") << "the user's";
  std::ofstream(partial / ".kept_0001.123-00ab12cd.tmp.pixels") << "half";
  // Another process renders frame 4, of another package, into the same folder.
  std::ofstream(folder_ / ".frame_0004.456-00ab12cd.tmp.exr") << "half";
  // A process was killed after it wrote the record of frame 3, and before it removed the plate of
  // the frame.
  fs::copy(partial / "frame_0002.plate", partial / "frame_0003.plate");
  ASSERT_TRUE(Open(true));
  EXPECT_FALSE(fs::exists(partial / ".frame_0002.123-00ab12cd.tmp.plate"));
  EXPECT_FALSE(fs::exists(folder_ / ".frame_0003.123-00ab12cd.tmp.exr"));
  EXPECT_FALSE(fs::exists(partial / ".kept_0001.123-00ab12cd.tmp.pixels"));
  EXPECT_TRUE(fs::exists(folder_ / ".hidden.tmp.txt"));
  EXPECT_TRUE(fs::exists(folder_ / ".frame_0004.456-00ab12cd.tmp.exr"));
  EXPECT_FALSE(fs::exists(partial / "frame_0003.plate"));
  EXPECT_TRUE(fs::exists(partial / "frame_0002.plate"));
}

TEST_F(RunStateTest, RebinnedRaysAreThoseOfTheSameFrames) {
  AddRays();
  const auto state = Open(true);
  ASSERT_TRUE(state) << state.error().message;
  const auto rays = (*state)->LoadRays(FrameId{1}, 0, "1-3", 1000, pool_);
  ASSERT_TRUE(rays) << rays.error().message;
  ASSERT_TRUE(rays->has_value());
  EXPECT_EQ((*rays)->ranks_done, 128u);
  EXPECT_EQ((*rays)->map.size(), 1u);
  const auto others = (*state)->LoadRays(FrameId{1}, 0, "1", 1000, pool_);
  ASSERT_FALSE(others);
  EXPECT_EQ(others.error().kind, ErrorKind::kUsage);
  EXPECT_NE(others.error().message.find("rays.frames 1-3, this call has 1"), std::string::npos)
      << others.error().message;
  EXPECT_FALSE((*state)->LoadRays(FrameId{1}, 1, "1-3", 1000, pool_)->has_value());
}

TEST_F(RunStateTest, KeptPixelsAreThoseOfTheSameFrames) {
  AddKept();
  const auto state = Open(true);
  ASSERT_TRUE(state) << state.error().message;
  const auto kept = (*state)->LoadKept(FrameId{1}, "1-3", 1000, pool_);
  ASSERT_TRUE(kept) << kept.error().message;
  ASSERT_TRUE(kept->has_value());
  EXPECT_EQ((*kept)->ranks_done, 64u);
  ASSERT_EQ((*kept)->pixels.size(), 1u);
  EXPECT_EQ((*kept)->pixels.images().at(LfImageId{4}).values,
            (std::vector<uint16_t>{1000, 2000, 3000}));
  const auto others = (*state)->LoadKept(FrameId{1}, "1", 1000, pool_);
  ASSERT_FALSE(others);
  EXPECT_EQ(others.error().kind, ErrorKind::kUsage);
  EXPECT_NE(others.error().message.find("rays.frames 1-3, this call has 1"), std::string::npos)
      << others.error().message;
  EXPECT_FALSE((*state)->LoadKept(FrameId{2}, "1-3", 1000, pool_)->has_value());
}

TEST_F(RunStateTest, KeptPixelsOfOtherInputsAreRefused) {
  AddKept();
  const auto state = Open(true, false, 9);
  ASSERT_TRUE(state) << state.error().message;
  const auto kept = (*state)->LoadKept(FrameId{1}, "1-3", 1000, pool_);
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().kind, ErrorKind::kUsage);
  EXPECT_NE(kept.error().message.find("kept_0001.pixels: was made with seed 0, this call has 9"),
            std::string::npos)
      << kept.error().message;
}

TEST_F(RunStateTest, KeptPixelsAreReadOnlyToResume) {
  {
    const std::unique_ptr<RunState> fresh = *Open(false);
    ASSERT_TRUE(fresh->SaveKept(FrameId{1}, "1-3", KeptPixels(1), 5, pool_));
    EXPECT_FALSE(fresh->LoadKept(FrameId{1}, "1-3", 1000, pool_)->has_value());
  }
  AddKept();
  EXPECT_EQ(Open(false).error().kind, ErrorKind::kUsage);
  EXPECT_TRUE((*Open(true))->HasPlates());
  EXPECT_TRUE(fs::exists(KeptFile()));
  const auto state = Open(false, true);
  ASSERT_TRUE(state) << state.error().message;
  EXPECT_FALSE((*state)->HasPlates());
  EXPECT_FALSE(fs::exists(KeptFile()));
}

TEST_F(RunStateTest, RaysAndKeptPixelsAreRemovedTogether) {
  LeaveUnfinished();
  AddRays();
  AddKept();
  const fs::path partial = folder_ / "partial";
  EXPECT_TRUE(fs::exists(partial / "rays_0001_1.rays"));
  {
    // A run with one kind is not continued with the other.
    const std::unique_ptr<RunState> state = *Open(true);
    const auto kept = state->LoadKept(FrameId{1}, "1-3", 1000, pool_);
    ASSERT_FALSE(kept);
    EXPECT_EQ(kept.error().kind, ErrorKind::kUsage);
    EXPECT_NE(kept.error().message.find("interpolation cells, this call has pixels"),
              std::string::npos);
    const auto rays = state->LoadRays(FrameId{1}, 0, "1-3", 1000, pool_);
    ASSERT_FALSE(rays);
    EXPECT_NE(rays.error().message.find("interpolation pixels, this call has cells"),
              std::string::npos);
  }
  {
    const std::unique_ptr<RunState> state = *Open(true);
    state->RemoveRays();
    EXPECT_TRUE(state->HasPlates());  // the plate of frame 2
  }
  EXPECT_FALSE(fs::exists(partial / "rays_0001_1.rays"));
  EXPECT_FALSE(fs::exists(KeptFile()));
  EXPECT_TRUE(fs::exists(partial / "frame_0002.plate"));
  fs::remove(partial / "frame_0002.plate");
  AddKept();
  const std::unique_ptr<RunState> state = *Open(true);
  EXPECT_TRUE(state->HasPlates());
  state->RemoveRays();
  EXPECT_FALSE(state->HasPlates());
}

TEST_F(RunStateTest, AdviceIsAboutTheWorkThatTheFileHolds) {
  LeaveUnfinished();
  AddRays();
  auto state = Open(true);
  ASSERT_TRUE(state) << state.error().message;
  SensorPlate small(40, 30);
  const auto other = (*state)->LoadPlate(FrameId{2}, &small);
  ASSERT_FALSE(other);
  EXPECT_TRUE(other.error().message.ends_with(
      ": has 80 x 60 elements, expected 40 x 30; remove the file to render its frame again"))
      << other.error().message;
  const auto too_many = (*state)->LoadRays(FrameId{1}, 0, "1-3", 0, pool_);
  ASSERT_FALSE(too_many);
  EXPECT_TRUE(too_many.error().message.ends_with(
      "contains 1 cells, but {max_rays} and {memory} allow only 0, because they are smaller than "
      "when the file was written; remove the file to rebin its rays again"))
      << too_many.error().message;
  (*state)->RemoveRays();
  state->reset();
  AddKept();
  state = Open(true);
  ASSERT_TRUE(state) << state.error().message;
  const auto many_pixels = (*state)->LoadKept(FrameId{1}, "1-3", 0, pool_);
  ASSERT_FALSE(many_pixels);
  EXPECT_TRUE(many_pixels.error().message.ends_with(
      "contains 1 pixels, but {max_rays} and {memory} allow only 0, because they are smaller than "
      "when the file was written; remove the file to read its pixels again"))
      << many_pixels.error().message;
  fs::resize_file(KeptFile(), fs::file_size(KeptFile()) - 1);
  const auto cut = (*state)->LoadKept(FrameId{1}, "1-3", 1000, pool_);
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().kind, ErrorKind::kInput);
  EXPECT_NE(cut.error().message.find("is truncated"), std::string::npos) << cut.error().message;
  EXPECT_TRUE(cut.error().message.ends_with("; remove the file to read its pixels again"))
      << cut.error().message;
}

TEST_F(RunStateTest, OneAtATime) {
  const auto first = Open(false);
  const auto second = Open(true);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf

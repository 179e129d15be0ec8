// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/run_inputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

RunInputs AllInputs(const LightField& field, const RunChoices& choices,
                    const RenderCamera& camera) {
  RunInputs all = InputsOfRays(IdentityOf(field), field.encoding, choices);
  for (const RunInputs& part : {InputsOfCamera(FrameId{1}, camera), InputsOfPicture(choices)})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(RunInputs, AnotherShutterIsAnotherInput) {
  CameraPath path;
  path.cameras = testing::NoiseFrames();
  const RunInputs without = InputsOfFrame(path, FrameId{2});
  const std::string cameras = HashOfCameras(path);
  EXPECT_EQ(FirstDifference(without, InputsOfCamera(FrameId{2}, path.cameras[1])), std::nullopt);
  path.shutter = {180, 2};
  for (const RenderCamera& camera : path.cameras)
    path.instants.insert(path.instants.end(), 2, camera);
  const RunInputs with = InputsOfFrame(path, FrameId{2});
  EXPECT_EQ(FirstDifference(without, with)->key, "frame.shutter");
  EXPECT_NE(HashOfCameras(path), cameras);
  CameraPath numbered = path;
  numbered.first_frame = 1001;
  EXPECT_NE(HashOfCameras(numbered), HashOfCameras(path));
  CameraPath moved = path, longer = path;
  moved.instants[3].pinhole.cam_from_world.translation.x() += 1e-9;
  longer.shutter.angle_deg = 90;
  for (const CameraPath* other : {&moved, &longer}) {
    EXPECT_EQ(FirstDifference(with, InputsOfFrame(*other, FrameId{2}))->key, "frame.shutter");
    EXPECT_EQ(FirstDifference(InputsOfFrame(path, FrameId{1}), InputsOfFrame(*other, FrameId{1}))
                  .has_value(),
              other == &longer);
  }
}

TEST(RunInputs, ExrFramesAloneHaveNamesOfChannels) {
  const auto has_names = [](const std::string& format) {
    RunChoices choices;
    choices.format = format;
    const RunInputs inputs = InputsOfPicture(choices);
    return std::any_of(inputs.begin(), inputs.end(),
                       [](const auto& input) { return input.first == "picture.channels"; });
  };
  EXPECT_TRUE(has_names("exr"));
  EXPECT_TRUE(has_names("exr-float"));
  EXPECT_FALSE(has_names("png"));
  EXPECT_FALSE(has_names("png16"));
}

TEST(RunInputs, EveryInputMakesADifferenceAndItsKeyNamesIt) {
  struct Inputs {
    Inputs() { choices.film.reading.estimator = Estimator::kBilinear; }
    LightField field = testing::NoiseField();
    RunChoices choices;
    RenderCamera camera = testing::NoiseFrames()[0];
  };
  const Inputs base;
  const RunInputs recorded = AllInputs(base.field, base.choices, base.camera);
  EXPECT_EQ(FirstDifference(recorded, AllInputs(base.field, base.choices, base.camera)),
            std::nullopt);
  const std::vector<std::pair<std::string, std::function<void(Inputs&)>>> changes = {
      {"seed", [](Inputs& i) { i.choices.film.seed = 1; }},
      {"estimator", [](Inputs& i) { i.choices.film.reading.estimator = Estimator::kNearest; }},
      {"filter", [](Inputs& i) { i.choices.film.reading.filter = PixelFilter::kBicubic; }},
      {"back_end", [](Inputs& i) { i.choices.film.back_end = CollectBackEnd::kReference; }},
      {"lens_weights", [](Inputs& i) { i.choices.film.lens_weights = LensWeights::kHat; }},
      {"order", [](Inputs& i) { i.choices.film.order = ImageOrder::kArea; }},
      {"max_angle_deg", [](Inputs& i) { i.choices.film.max_angle_rad = 1; }},
      {"max_images", [](Inputs& i) { i.choices.film.max_image_count = 9; }},
      {"stop_when", [](Inputs& i) { i.choices.film.stop_when.samples = 9; }},
      {"stop_when", [](Inputs& i) { i.choices.film.stop_when.noise = 0.002; }},
      {"picture.format", [](Inputs& i) { i.choices.format = "png"; }},
      {"picture.channels", [](Inputs& i) { i.choices.look.channels = FrameChannels::kRgb; }},
      {"picture.exr_compression",
       [](Inputs& i) { i.choices.look.compression = ExrCompression::kZips; }},
      {"smooth_below", [](Inputs& i) { i.choices.film.smooth_below = 2; }},
      {"fill", [](Inputs& i) { i.choices.film.fill_radius_px = 32; }},
      {"light_field.images", [](Inputs& i) { i.field.cameras.pop_back(); }},
      {"light_field.names", [](Inputs& i) { i.field.image_names[3] += "x"; }},
      {"light_field.names", [](Inputs& i) { i.field.mask_names.assign(49, "m.png"); }},
      {"light_field.calibration",
       [](Inputs& i) { i.field.cameras[3].cam_from_world.translation.x() += 1e-15; }},
      {"light_field.calibration", [](Inputs& i) { i.field.cameras[3].gain = 1.01f; }},
      {"light_field.calibration",
       [](Inputs& i) { i.field.intrinsics[0].distortion.parameters[2] = 1e-9; }},
      {"light_field.calibration", [](Inputs& i) { i.field.cameras[3].gain[2] = 1.01f; }},
      {"light_field.calibration", [](Inputs& i) { i.field.intrinsics[0].vignetting.v[1] = 1e-9; }},
      {"light_field.encoding", [](Inputs& i) { i.field.encoding.black_level = 64; }},
      {"light_field.encoding",
       [](Inputs& i) {
         i.field.encoding.response = {0, 1};
       }},
      {"light_field.colours", [](Inputs& i) { i.field.encoding.white_balance[2] = 1.5; }},
      {"light_field.encoding", [](Inputs& i) { i.field.encoding.masks_clipped = true; }},
      {"frame.resolution", [](Inputs& i) { i.camera.pinhole.intrinsics.height_px = 61; }},
      {"frame.position", [](Inputs& i) { i.camera.pinhole.cam_from_world.translation.z() += 0.1; }},
      {"frame.aperture_diameter_w", [](Inputs& i) { i.camera.aperture.radius_w = 0.031; }},
      {"frame.blades", [](Inputs& i) { i.camera.aperture.blades = 7; }},
      {"frame.focus_plane", [](Inputs& i) { i.camera.focus_plane.offset_w += 1e-12; }},
      {"frame.camera", [](Inputs& i) { i.camera.pinhole.intrinsics.cy_px += 0.5; }},
      {"frame.camera", [](Inputs& i) { i.camera.aperture.rotation_rad = 0.1; }},
      {"frame.camera", [](Inputs& i) { i.camera.aperture.ratio = 1.1; }},
      {"frame.camera", [](Inputs& i) { i.camera.aperture.roundness = 0.1; }},
      {"frame.camera",
       [](Inputs& i) {
         i.camera.hood = {0.1, 0.2};
       }},
      {"frame.camera", [](Inputs& i) {
         i.camera.transmission =
             std::make_shared<const Transmission>(*Transmission::FromText("ff"));
       }}};
  for (const auto& [key, change] : changes) {
    Inputs inputs;
    change(inputs);
    const auto difference =
        FirstDifference(recorded, AllInputs(inputs.field, inputs.choices, inputs.camera));
    ASSERT_TRUE(difference) << key;
    EXPECT_EQ(difference->key, key);
    EXPECT_NE(difference->recorded, difference->wanted);
  }
}

// States that an older reading made are refused, and states of other readings are kept.
TEST(RunInputs, OnlyStatesThatDependOnAReadingHaveItsVersion) {
  const LightField field = testing::NoiseField();
  const auto has = [&](const std::string& key, Estimator estimator, PixelFilter filter) {
    RunChoices choices;
    choices.film.reading.estimator = estimator;
    choices.film.reading.filter = filter;
    const RunInputs inputs = InputsOfRays(IdentityOf(field), field.encoding, choices);
    return std::count_if(inputs.begin(), inputs.end(),
                         [&](const auto& input) { return input.first == key; }) == 1;
  };
  EXPECT_TRUE(has("ray_model.mosaic", Estimator::kBilinear, PixelFilter::kMosaic));
  EXPECT_FALSE(has("ray_model.mosaic", Estimator::kBilinear, PixelFilter::kPrefiltered));
  EXPECT_FALSE(has("ray_model.mosaic", Estimator::kNearest, PixelFilter::kMosaic));
  EXPECT_TRUE(has("ray_model.bilinear", Estimator::kBilinear, PixelFilter::kMosaic));
  EXPECT_TRUE(has("ray_model.bilinear", Estimator::kBilinear, PixelFilter::kPrefiltered));
  EXPECT_FALSE(has("ray_model.bilinear", Estimator::kNearest, PixelFilter::kMosaic));
}

TEST(RunInputs, WhatOneSideLacksIsADifference) {
  EXPECT_EQ(FirstDifference({}, {{"a", "1"}})->recorded, "(none)");
  EXPECT_EQ(FirstDifference({{"a", "1"}}, {})->wanted, "(none)");
}

TEST(RunInputs, DifferencesAreReadable) {
  const RunInputs packages = {{kFilmOfPackage, "1f"}}, other = {{kFilmOfPackage, "2e"}};
  EXPECT_EQ(FirstDifference(packages, other)->Text("was made with", "this call has"),
            "was made with picture.film 1f, this call has 2e");
  EXPECT_EQ(FirstDifference({}, packages)->Text("was made with", "this call has"),
            "was made with no packages, this call has picture.film 1f");
  EXPECT_EQ(FirstDifference({{"a", "1"}}, {})->Text("has", "this has"), "has a 1, this has no a");
}

// The number of rays that follows from --memory is none of the options of the call.
TEST(RunInputs, TheRemedyNamesTheNumberOfRays) {
  const RunInputs more = {{"max_rays", "5000"}}, fewer = {{"max_rays", "3000"}};
  EXPECT_EQ(FirstDifference(more, fewer)->Remedy(), "give {max_rays 5000}, or the same {memory}");
  EXPECT_EQ(FirstDifference({{"seed", "1"}}, {{"seed", "2"}})->Remedy(),
            "give the same inputs and options");
}

// Renders that were begun before there were kept pixels have no input "interpolation".
TEST(RunInputs, ARenderWithoutAnInterpolationHasCells) {
  const LightField field = testing::NoiseField();
  RunChoices choices;
  choices.film.mode = RenderMode::kHybrid;
  const auto inputs = [&](RayInterpolation interpolation) {
    choices.film.rebin.interpolation = interpolation;
    return InputsOfRays(IdentityOf(field), field.encoding, choices);
  };
  const RunInputs cells = inputs(RayInterpolation::kCells),
                  pixels = inputs(RayInterpolation::kPixels);
  RunInputs before = cells;
  ASSERT_EQ(std::erase_if(before, [](const auto& input) { return input.first == "interpolation"; }),
            1u);
  EXPECT_EQ(FirstDifference(before, cells), std::nullopt);
  EXPECT_EQ(FirstDifference(cells, before), std::nullopt);
  const auto difference = FirstDifference(before, pixels);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->Text("was made with", "this call has"),
            "was made with interpolation cells, this call has pixels");
  EXPECT_EQ(FirstDifference(pixels, cells)->Text("was made with", "this call has"),
            "was made with interpolation pixels, this call has cells");
  choices.film.mode = RenderMode::kCollect;
  EXPECT_EQ(FirstDifference(before, inputs(RayInterpolation::kPixels))->key, "mode");
}

TEST(RunInputs, TheFolderMayMove) {
  LightField field = testing::NoiseField();
  const RunInputs before = InputsOfRays(IdentityOf(field), field.encoding, {});
  field.folder = "/elsewhere";
  EXPECT_EQ(FirstDifference(before, InputsOfRays(IdentityOf(field), field.encoding, {})),
            std::nullopt);
}

}  // namespace
}  // namespace lf

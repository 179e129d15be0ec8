// SPDX-License-Identifier: Apache-2.0
// Errors of the face of the library. tests/programs/install_test.py compares its frames with
// lfrenderer's.
#include "lf/api/frame.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

// A film whose LF images are in no file.
Film FilmWithoutImages() {
  Film film;
  film.light_field = testing::NoiseField(2);
  film.light_field.folder = "/nowhere";
  film.path.cameras = testing::NoiseFrames();
  return film;
}

void ExpectError(const Error& error, ErrorKind kind, const std::string& part) {
  EXPECT_EQ(error.kind, kind) << error.message;
  EXPECT_NE(error.message.find(part), std::string::npos) << error.message;
}

TEST(Face, NumbersOfFramesAreChecked) {
  const Film film = FilmWithoutImages();
  for (const uint32_t number : {0u, 4u, 4000000000u}) {
    const Result<Frame> frame = RenderFrame(film, number);
    ASSERT_FALSE(frame) << number;
    ExpectError(frame.error(), ErrorKind::kUsage, "expected a number from 1 to 3");
  }
}

TEST(Face, FramesThatAreRenderedTogetherAreInOrder) {
  for (const auto& frames : {std::vector{FrameId{2}, FrameId{1}}, {FrameId{1}, FrameId{1}}}) {
    const Result<FrameRenderer> renderer = FrameRenderer::Open(FilmWithoutImages(), frames);
    ASSERT_FALSE(renderer);
    ExpectError(renderer.error(), ErrorKind::kUsage, "ascending");
  }
  const Result<FrameRenderer> renderer = FrameRenderer::Open(FilmWithoutImages(), {FrameId{4}});
  ASSERT_FALSE(renderer);
  ExpectError(renderer.error(), ErrorKind::kUsage, "expected a number from 1 to 3");
}

TEST(Face, FramesWithoutLfImagesAreErrors) {
  const Result<Frame> frame = RenderFrame(FilmWithoutImages(), 1);
  ASSERT_FALSE(frame);
  ExpectError(frame.error(), ErrorKind::kInput, "/nowhere");
}

// A shutter makes pictures of the instants, and their metadata of the cameras: both must change.
TEST(Face, AChangeOfCamerasIsOneOfInstants) {
  Film film = FilmWithoutImages();
  film.path.shutter = {180, 2};
  for (const RenderCamera& camera : film.path.cameras)
    film.path.instants.insert(film.path.instants.end(), 2, camera);
  film.path.ChangeCameras([](RenderCamera* camera) { camera->aperture.radius_w = 0.125; });
  for (uint32_t frame = 1; frame <= film.path.frame_count(); ++frame) {
    EXPECT_EQ(film.path.Camera(FrameId{frame}).aperture.radius_w, 0.125);
    for (const RenderCamera& camera : film.path.Instants(FrameId{frame}))
      EXPECT_EQ(camera.aperture.radius_w, 0.125);
  }
}

TEST(Face, MissingFilesAreNamed) {
  ExpectError(Open("/nowhere/capture").error(), ErrorKind::kInput, "/nowhere/capture");
  const auto film = OpenFilm(testing::NoiseField(2), "/nowhere/path.yaml");
  ASSERT_FALSE(film);
  ExpectError(film.error(), ErrorKind::kInput, "/nowhere/path.yaml");
}

TEST(Face, NamesOfFramesTellTheirFormat) {
  ExpectError(SaveFrame(Frame(), "frame.jpg").error(), ErrorKind::kUsage, ".exr or .png");
  ExpectError(SaveFrame(Frame(), "frame.png", FrameFormat::kExrHalf).error(), ErrorKind::kUsage,
              "exr");
  ExpectError(SaveFrame(Frame(), "frame.exr").error(), ErrorKind::kUsage, "has no notes");
}

}  // namespace
}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/view/film_use.h"

#include <gtest/gtest.h>

#include <atomic>

#include "lf/view/shown_frames.h"
#include "lf/view/test_grid.h"

namespace lf {
namespace {

std::shared_ptr<CameraPath> Film(int frame_count) {
  auto path = std::make_shared<CameraPath>();
  for (int i = 0; i < frame_count; ++i) {
    path->cameras.push_back(testing::GridFrame());
    path->cameras.back().aperture.radius_w *= 1 - 0.1 * i;
  }
  return path;
}

TEST(FilmUse, CountsWhatItsFramesNeed) {
  const LightField field = testing::GridField();
  const ImageIndex index(field);
  ThreadPool pool(2);
  const auto path = Film(4);
  std::atomic<int> told = 0;
  FilmUse film(index, std::make_shared<const PathFrames>(*path), {}, pool, [&] { ++told; });
  film.Wait();
  const FilmUse::Facts facts = film.Get();
  EXPECT_EQ(facts.frames_done, 4u);
  EXPECT_GE(told, 1);
  std::vector<uint16_t> expected(field.size(), 0);
  for (size_t i = 0; i < 4; ++i) {
    const FrameNeeds needs = NeedsOf(index, path->cameras[i], {}, pool);
    EXPECT_GT(needs.images.size(), 10u);
    EXPECT_EQ(facts.image_counts[i], needs.images.size());
    EXPECT_EQ(facts.ray_counts[i], needs.RayCount());
    for (const FrameNeeds::Image& image : needs.images) ++expected[image.id.value];
  }
  EXPECT_EQ(facts.frames_of_image, expected);
}

TEST(FilmUse, LeavesOffAtOnce) {
  const LightField field = testing::GridField();
  const ImageIndex index(field);
  ThreadPool pool(1);
  const auto path = std::make_shared<CameraPath>();
  path->cameras.assign(200'000, testing::GridFrame());
  const FilmUse film(index, std::make_shared<const PathFrames>(*path), {}, pool, [] {});
  EXPECT_LT(film.Get().frames_done, film.Get().image_counts.size());
}

TEST(FilmUse, CountsSomeFramesOfALongFilm) {
  const LightField field = testing::GridField();
  const ImageIndex index(field);
  ThreadPool pool(2);
  const auto path = std::make_shared<CameraPath>();
  path->cameras.assign(2 * kMostShownFrames, testing::GridFrame());
  const FilmUse film(index, std::make_shared<const PathFrames>(*path), {}, pool, [] {});
  EXPECT_LE(film.Get().image_counts.size(), kMostShownFrames);
  while (film.Get().frames_done < 100) {
  }
  const FilmUse::Facts facts = film.Get();
  const FrameNeeds needs = NeedsOf(index, path->cameras[0], {}, pool);
  const size_t step = ShownStep(path->frame_count());
  EXPECT_EQ(facts.frames_of_image[needs.images[0].id.value], facts.frames_done * step);
}

}  // namespace
}  // namespace lf

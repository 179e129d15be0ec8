// SPDX-License-Identifier: Apache-2.0
// Tests that renders of synthetic light fields equal the pictures that the lens takes of the scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/optics/analytic_field.h"

#include "lf/light_field/synthetic/built_in_scenes.h"
#include "lf/light_field/synthetic/photograph.h"
#include "lf/light_field/synthetic/write_light_field.h"

namespace lf {
namespace {

// Photographs of a scene, rendered when they are loaded.
class SceneStore : public LfImageStore {
 public:
  SceneStore(const LightField& field, const Scene& scene) : field_(field), scene_(scene) {}

  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    const Image<float> picture = Photograph(scene_, field_.Camera(id), 4);
    *pixels = LfPixels(rect, BayerPattern::kNone);
    for (int y = rect.y_begin; y < rect.y_end; ++y)
      for (int x = rect.x_begin; x < rect.x_end; ++x)
        for (int channel = 0; channel < 3; ++channel)
          pixels->radiance.at(x - rect.x_begin, y - rect.y_begin, channel) =
              QuantizeRadiance(field_.encoding, static_cast<double>(picture.at(x, y, channel)), 1);
    return {};
  }

 private:
  const LightField& field_;
  const Scene& scene_;
};

struct Film {
  const char* scene;
  Aperture aperture;
  double focus_distance_w = 1;
  FocusTilt tilt = {};
  double beside_w = 0;  // position of the lens, to the right of the middle LF camera
};

RenderCamera CameraOf(const Film& film, const PinholeCamera& middle) {
  RenderCamera camera;
  camera.pinhole = middle;
  camera.pinhole.cam_from_world.translation.x() -= film.beside_w;
  camera.aperture = film.aperture;
  camera.focus_plane = FocusPlane(camera.pinhole, film.focus_distance_w, film.tilt);
  return camera;
}

// Returns the peak signal-to-noise ratio in dB, in linear light clipped at 1. Leaves out a margin
// of the frame that some LF cameras do not see.
double Likeness(const SensorPlate& plate, double scale, const Image<float>& truth) {
  constexpr int kMargin = 15;
  double squares = 0;
  int count = 0;
  for (int y = kMargin; y < truth.height() - kMargin; ++y)
    for (int x = kMargin; x < truth.width() - kMargin; ++x)
      for (int channel = 0; channel < 3; ++channel, ++count) {
        const ElementSum element = plate.At(x, y, channel);
        const double radiance = static_cast<double>(element.sum) / element.count / scale;
        const double error =
            std::min(1.0, radiance) - std::min(1.0, static_cast<double>(truth.at(x, y, channel)));
        squares += error * error;
      }
  return -10 * std::log10(squares / count);
}

struct Likenesses {
  double right_db = 0;
  double wrong_db = 0;
};

// Returns how similar renders with the cameras of `film` and of `wrong` are to the ground truth of
// `film`.
Likenesses CompareWithTruth(const Film& film, const Film& wrong) {
  const BuiltInScene& built_in = *FindBuiltInScene(film.scene);
  const Scene scene(built_in.describe());
  RigOptions rig = built_in.rig;
  rig.count = 121;
  rig.spacing_w = 0.0035;
  const LightField field = DescribeLightField(*MakeRig(rig), IntrinsicsFor(built_in, 180, 120),
                                              LfImageFormat::kExr, built_in.max_radiance, "");
  const PinholeCamera middle = field.Camera({60});
  const SceneStore store(field, scene);
  ThreadPool pool(2);
  const Image<float> truth = ThinLensPhotograph(scene, CameraOf(film, middle), {144, 0}, pool);
  const auto likeness = [&](const Film& rendered) {
    const SensorPlate plate = testing::CollectFrame(field, store, CameraOf(rendered, middle));
    return Likeness(plate, field.encoding.Scale(), truth);
  };
  return {likeness(film), likeness(wrong)};
}

TEST(SyntheticTruth, BokehThroughGlassAndMirrorsIsThatOfTheLens) {
  const Film film{"still-life", {0.017, 5, 0}, 0.75};
  Film wrong = film;
  wrong.beside_w = 0.003;
  const Likenesses db = CompareWithTruth(film, wrong);
  EXPECT_GT(db.right_db, 32);
  EXPECT_LT(db.wrong_db, db.right_db - 8);
}

TEST(SyntheticTruth, ATiltedPlaneIsSharpWhereTheTruthIs) {
  const Film film{"chart", {0.017, 0, 0}, 1, {0, RadiansFromDegrees(-50)}};
  Film wrong = film;
  wrong.tilt.vertical_rad = -film.tilt.vertical_rad;
  const Likenesses db = CompareWithTruth(film, wrong);
  EXPECT_GT(db.right_db, 26);
  EXPECT_LT(db.wrong_db, db.right_db - 3);
}

TEST(SyntheticTruth, LightsBecomeThePolygonOfTheLens) {
  const Film film{"lights", {0.017, 3, 0}, 0.75};
  Film wrong = film;
  wrong.aperture.rotation_rad = kPi;
  const Likenesses db = CompareWithTruth(film, wrong);
  EXPECT_GT(db.right_db, 26);
  EXPECT_LT(db.wrong_db, db.right_db - 3);
}

}  // namespace
}  // namespace lf

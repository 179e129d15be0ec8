// SPDX-License-Identifier: Apache-2.0
// Renders the first frame of a path into an array: frame LIGHTFIELD PATH.yaml
#include <cstdio>
#include <utility>
#include <vector>

#include "lf/camera/path/path_yaml.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/film_renderer.h"

lf::Result<lf::Image<float>> FirstFrame(const char* calibration, const char* path_file) {
  LF_ASSIGN_OR_RETURN(lf::LightField light_field, lf::OpenLightField(calibration));
  LF_ASSIGN_OR_RETURN(lf::CameraPath path, lf::ReadPathYaml(path_file, light_field.unit_m));
  lf::ThreadPool pool(2);
  constexpr uint64_t kSeed = 0;  // seed of the order of the LF images
  lf::Package film = lf::PackageOfAll(std::move(light_field), std::move(path), kSeed);
  LF_ASSIGN_OR_RETURN(const auto renderer,
                      lf::FilmRenderer::Open(std::move(film), lf::FilmSettings(), lf::WorkSettings(),
                                             {lf::FrameId{1}}, pool));
  for (bool is_going_on = true; is_going_on;) {
    LF_ASSIGN_OR_RETURN(is_going_on, renderer->Step());
  }
  return renderer->Develop(0).picture.rgb;
}

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto picture = FirstFrame(argv[1], argv[2]);
  if (!picture) {
    std::fprintf(stderr, "error: %s\n", picture.error().message.c_str());
    return 3;
  }
  std::printf("%d x %d, red of the middle: %.9g\n", picture->width(), picture->height(),
              picture->at(picture->width() / 2, picture->height() / 2, 0));
  return 0;
}

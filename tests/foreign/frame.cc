// SPDX-License-Identifier: Apache-2.0
// Renders the first frame of a path into a file: frame LIGHTFIELD PATH FRAME.exr [SETTING...]
#include <lf/lfrendertools.h>

#include <string_view>
#include <utility>

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  lf::Result<lf::LightField> light_field = lf::Open(argv[1]);
  if (!light_field) return lf::Report(light_field.error());
  lf::Result<lf::Film> film = lf::OpenFilm(*std::move(light_field), argv[2]);
  if (!film) return lf::Report(film.error());
  for (const std::string_view setting : std::span(argv + 4, argv + argc)) {
    if (setting == "hybrid") film->settings.mode = lf::RenderMode::kHybrid;
    if (setting == "nearest") film->settings.reading = lf::Estimator::kNearest;
    if (setting == "no weights") film->settings.lens_weights = lf::LensWeights::kNone;
  }
  const lf::Result<lf::Frame> frame = lf::RenderFrame(*film, 1);
  if (!frame) return lf::Report(frame.error());
  const lf::Result<void> saved = lf::SaveFrame(*frame, argv[3]);
  return saved ? 0 : lf::Report(saved.error());
}

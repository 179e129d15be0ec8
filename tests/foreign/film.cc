// SPDX-License-Identifier: Apache-2.0
// Films a light field with the installed library: film LIGHTFIELD PATH FOLDER
#include <lf/lfrendertools.h>

#include <cstdio>
#include <utility>

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  lf::Result<lf::LightField> light_field = lf::Open(argv[1]);
  if (!light_field) return lf::Report(light_field.error());
  const lf::Result<lf::Film> film = lf::OpenFilm(*std::move(light_field), argv[2]);
  if (!film) return lf::Report(film.error());
  const lf::Result<lf::RenderReport> report =
      lf::RenderFilm(*film, {.output_folder = argv[3], .format = lf::FrameFormat::kPng8});
  if (!report) return lf::Report(report.error());
  std::printf("%zu frames\n", report->frames.size());
}

// SPDX-License-Identifier: Apache-2.0
// Films a light field with the installed library: film LIGHTFIELD PATH.yaml DIR
#include <cstdio>
#include <utility>

#include "lf/camera/path/path_yaml.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/render.h"

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  auto light_field = lf::OpenLightField(argv[1]);
  if (!light_field) {
    std::fprintf(stderr, "error: %s\n", light_field.error().message.c_str());
    return 3;
  }
  auto path = lf::ReadPathYaml(argv[2], light_field->unit_m);
  if (!path) {
    std::fprintf(stderr, "error: %s\n", path.error().message.c_str());
    return 3;
  }
  lf::RenderOptions options;
  options.folder.output_folder = argv[3];
  options.folder.format = lf::FrameFormat::kPng8;
  lf::ThreadPool pool(2);
  constexpr uint64_t kSeed = 0;  // seed of the order of the LF images
  lf::Package film = lf::PackageOfAll(*std::move(light_field), *std::move(path), kSeed);
  const auto report = lf::Render(std::move(film), options, pool, nullptr);
  if (!report) {
    std::fprintf(stderr, "error: %s\n", report.error().message.c_str());
    return 4;
  }
  std::printf("%zu frames\n", report->frames.size());
  return 0;
}

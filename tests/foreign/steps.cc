// SPDX-License-Identifier: Apache-2.0
// Renders the first two frames of a path in steps, and looks at them after each: steps LIGHTFIELD
// PATH FOLDER
#include <lf/lfrendertools.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

namespace {

lf::Result<void> RenderInSteps(const std::filesystem::path& from, const std::filesystem::path& path,
                               const std::filesystem::path& folder) {
  LF_ASSIGN_OR_RETURN(lf::LightField light_field, lf::Open(from));
  LF_ASSIGN_OR_RETURN(const lf::Film film, lf::OpenFilm(std::move(light_field), path));
  LF_ASSIGN_OR_RETURN(lf::FrameRenderer renderer,
                      lf::FrameRenderer::Open(film, {lf::FrameId{1}, lf::FrameId{2}}));
  for (bool is_going_on = true; is_going_on;) {
    LF_ASSIGN_OR_RETURN(is_going_on, renderer.Step());
    LF_ASSIGN_OR_RETURN(const lf::Frame unfinished, renderer.Develop(0));
    std::printf("%g %llu\n", renderer.progress(),
                static_cast<unsigned long long>(unfinished.report.rays.image_count));
  }
  for (size_t index = 0; index < renderer.size(); ++index) {
    LF_ASSIGN_OR_RETURN(const lf::Frame frame, renderer.Develop(index));
    LF_RETURN_IF_ERROR(lf::SaveFrame(frame, folder / (std::to_string(index + 1) + ".exr")));
  }
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const lf::Result<void> done = RenderInSteps(argv[1], argv[2], argv[3]);
  return done ? 0 : lf::Report(done.error());
}

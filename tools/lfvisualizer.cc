// lfvisualizer LIGHTFIELD PATH.yaml: what was captured, and what a camera path needs of it.
#include <fmt/format.h>

#include <string>

#include "tools/common/light_field_argument.h"
#include "tools/common/program.h"

#include "lf/core/log.h"
#include "lf/path/path_yaml.h"
#include "lf/pipeline/frame_range.h"
#include "lf/visualizer/scene_text.h"

namespace {

constexpr const char* kExamples = R"(Examples:
  lfvisualizer capture/ path.yaml --text > scene.txt
  lfvisualizer capture/ path.yaml --text --frames 1-100x10 | grep '^collected 11 '

--text prints lines of words, in world units:
  lf_camera ID X Y Z              every LF camera, from 0
  render_camera FRAME X Y Z       every frame asked for
  collected FRAME ID SHARE        what the frame collects from: LF cameras, and the share of their pixels

The page that shows the same is not in this version.)";

struct Arguments {
  lf::LightFieldArgument light_field;
  std::string path, frames, lens_weights = "auto", estimator = "bilinear";
  double max_angle_deg = 0;
  uint64_t max_images = 0;
  bool text = false;
};

void AddOptions(CLI::App& app, Arguments& a) {
  a.light_field.AddTo(app);
  app.add_option("PATH", a.path, "Camera path (doc/formats/path.md)")->required();
  app.add_flag("--text", a.text, "Print LF cameras, render cameras and collected LF cameras");
  app.add_option("--frames", a.frames, "Only these frames: 1-100x2, 7, 3-5,9")
      ->check(lf::NotEmpty());
  app.add_option("--max-images", a.max_images, "As of lfrenderer; 0: all")
      ->check(lf::WholeNumber());
  app.add_option("--max-angle", a.max_angle_deg, "As of lfpreprocessor, degrees; 0: any")
      ->check(CLI::Range(0.0, 180.0));
  app.add_option("--estimator", a.estimator, "As of lfrenderer")
      ->check(CLI::IsMember({"bilinear", "nearest"}));
  app.add_option("--lens-weights", a.lens_weights, "As of lfrenderer")
      ->check(CLI::IsMember({"auto", "none", "area", "hat"}));
}

lf::NeedsOptions Needs(const Arguments& a) {
  lf::NeedsOptions needs;
  if (a.estimator == "bilinear") needs.select.reach = lf::PixelReach::kNeighbours;
  if (a.max_angle_deg > 0) needs.select.max_angle_rad = lf::RadiansFromDegrees(a.max_angle_deg);
  for (const lf::LensWeights weights : {lf::LensWeights::kNone, lf::LensWeights::kAuto,
                                        lf::LensWeights::kArea, lf::LensWeights::kHat})
    if (a.lens_weights == lf::NameOf(weights)) needs.lens_weights = weights;
  if (a.max_images > 0) needs.max_image_count = a.max_images;
  return needs;
}

lf::Result<void> Run(const Arguments& a, const lf::CommonOptions& common) {
  if (!a.text)
    return lf::UsageError("the page is not in this version of lfvisualizer: give --text");
  LF_ASSIGN_OR_RETURN(const lf::LightField light_field, a.light_field.Open());
  LF_ASSIGN_OR_RETURN(const lf::CameraPath path, lf::ReadPathYaml(a.path, light_field.unit_m));
  LF_ASSIGN_OR_RETURN(
      const std::vector<lf::FrameId> frames,
      lf::ParseFrameRange(a.frames.empty() ? fmt::format("1-{}", path.frame_count()) : a.frames,
                          path.frame_count()));
  lf::ThreadPool pool(common.threads);
  return lf::WriteSceneText(light_field, path, frames, common.seed, Needs(a), pool,
                            lf::PrintReport);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfvisualizer", "Shows what was captured and what a camera path needs of it.",
                      kExamples);
  AddOptions(program.app(), arguments);
  return program.Run(argc, argv, [&] { return Run(arguments, program.common()); });
}

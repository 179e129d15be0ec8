// lfexample LIGHTFIELD -o PATH.yaml: a first camera path, ready to render.
#include <memory>
#include <string>

#include "tools/common/light_field_argument.h"
#include "tools/common/program.h"

#include "lf/capture/capture_geometry.h"
#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/path/path_yaml.h"
#include "lf/pipeline/example_path.h"
#include "lf/store/open_store.h"

namespace {

constexpr const char* kExamples = R"(Examples:
  lfexample capture/ -o path.yaml
  lfexample capture/transforms.json -o orbit.yaml --move orbit --camera 364
  lfexample capture/ -o path.yaml --focus 8.12

The path starts at an LF camera and focuses where the optical axes meet; where they are parallel,
at the sharpest of a sweep of planes. Render it with: lfrenderer LIGHTFIELD PATH.yaml -o DIR)";

}  // namespace

int main(int argc, char** argv) {
  lf::Program program("lfexample", "Writes a commented, working camera path for a light field.",
                      kExamples);
  program.AddCommonOptions({.threads = true, .verbose = true, .quiet = true});
  lf::LightFieldArgument input;
  std::string output, move = "focus-pull";
  int camera = -1;
  double focus = 0;
  CLI::App& app = program.app();
  input.AddTo(app);
  app.add_option("-o,--output", output, "PATH.yaml to write")->required();
  app.add_option("--camera", camera, "LF camera to start at, from 0; -1: the middle one")
      ->check(CLI::Range(-1, 2'000'000'000));
  app.add_option("--move", move, "static, orbit, dolly or focus-pull")
      ->check(CLI::IsMember({"static", "orbit", "dolly", "focus-pull"}));
  app.add_option("--focus", focus, "Focus distance in world units; 0: found by itself")
      ->check(CLI::NonNegativeNumber);

  return program.Run(argc, argv, [&]() -> lf::Result<void> {
    LF_ASSIGN_OR_RETURN(const lf::LightField light_field, input.Open());
    lf::ExampleOptions options;
    options.camera =
        camera >= 0 ? lf::LfImageId{static_cast<uint32_t>(camera)} : lf::MiddleCamera(light_field);
    options.move = *lf::ParseExampleMove(move);
    if (focus > 0) options.focus_distance_w = focus;
    lf::ThreadPool pool(program.common().threads);
    LF_ASSIGN_OR_RETURN(const std::unique_ptr<lf::LfImageStore> store,
                        lf::OpenStore(light_field, lf::Mosaics::kToRgb));
    LF_ASSIGN_OR_RETURN(const lf::ExamplePath example,
                        lf::MakeExamplePath(light_field, *store, options, pool));
    // A path that would not render is a bug of ours, found here and not by the renderer.
    LF_RETURN_IF_ERROR(lf::ParsePathYaml(example.yaml, output, light_field.unit_m));
    LF_RETURN_IF_ERROR(lf::WriteFileAtomically(output, example.yaml));
    lf::LogInfo("{}: starts at LF camera {} ({}), focus at {:.4g} ({}), aperture {:.4g}", output,
                options.camera.value, light_field.image_names[options.camera.value],
                example.focus_distance_w, example.focus_reason, example.aperture_diameter_w);
    return {};
  });
}

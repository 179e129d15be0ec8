// SPDX-License-Identifier: Apache-2.0
// Sends any name and any body as a page would; the answer must be one that the page understands.
// The input is a name to look up, or the name of an edit, a line feed and a body. FIRST stands for
// the id of the first path.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "tools/visualizer/live_view.h"
#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_edits.h"
#include "tools/visualizer/page_scene.h"
#include "tools/visualizer/preview_render.h"

#include "lf/core/check.h"
#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/view/test_grid.h"

namespace {

constexpr std::string_view kPath =
    "format: lfpath 1\nfps: 10\nframes: 3\nresolution: [16, 12]\n"
    "camera: {field_of_view_deg: 50, position: [0, 0, 0], look_at: [0, 0, 1]}\n"
    "lens: {aperture_diameter_mm: 30, focus_distance: 1}\n";

// A grid of LF cameras without image files, in a folder of its own.
struct World {
  World() {
    std::string name = (std::filesystem::temp_directory_path() / "page_requests-XXXXXX").string();
    LF_CHECK(::mkdtemp(name.data()) != nullptr);
    folder = name;
    lf::PageArguments arguments;
    arguments.path = folder / "path.yaml";
    arguments.watch = folder / "frames";
    arguments.threads = 1;
    LF_CHECK(lf::WriteFileAtomically(arguments.path, kPath));
    auto opened = lf::PageScene::Open(lf::testing::GridField(), std::move(arguments));
    LF_CHECK(opened);
    scene = *std::move(opened);
    preview = std::make_unique<lf::PreviewRender>(*scene);
    live = std::make_unique<lf::LiveView>(*scene, size_t{1} << 20);
  }
  ~World() {
    live.reset();
    preview.reset();
    scene.reset();
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }

  std::filesystem::path folder;
  std::unique_ptr<lf::PageScene> scene;
  std::unique_ptr<lf::PreviewRender> preview;
  std::unique_ptr<lf::LiveView> live;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  static World world;
  std::string text(reinterpret_cast<const char*>(bytes), size_bytes);
  constexpr std::string_view kFirst = "FIRST";
  for (size_t at; (at = text.find(kFirst)) != std::string::npos;)
    text.replace(at, kFirst.size(), world.scene->first_draft()->id);
  const size_t line_end = text.find('\n');
  const std::string name = text.substr(0, line_end);
  lf::PageAnswer answer;
  if (line_end == std::string::npos) {
    answer = lf::Answer(*world.scene, name);
  } else {
    if (name == "preview") return 0;  // it would take too long
    answer = lf::Edit(*world.scene, *world.preview, *world.live, name, text.substr(line_end + 1));
  }
  static const std::set<int> kStatuses = {200, 400, 404, 410, 422, 507};
  LF_CHECK(kStatuses.contains(answer.status));
  if (answer.type == "application/json" || answer.status != 200)
    LF_CHECK(nlohmann::json::accept(answer.body));
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
// lf_ray_usage LIGHTFIELD PATH.yaml: counts, for every LF image inside the widened frustum, the
// pixels that all frames together would try, as whole images and within their rectangles, and the
// rays among them that reach a plate (thesis, Figure 5.5). Uses the ray model's spans and reads no
// image. Writes CSV to stdout.
#include <cstdio>
#include <optional>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/path/path_yaml.h"
#include "lf/collection/scatter.h"
#include "lf/core/parallel.h"
#include "lf/film/plate/tile_sums.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/selection/select.h"

namespace {

struct Usage {
  uint64_t whole = 0;
  uint64_t rectangles = 0;
  uint64_t accepted = 0;
};

Usage UsageOf(const lf::LightField& light_field, lf::LfImageId id,
              const std::vector<lf::RenderCamera>& frames) {
  const lf::PinholeCamera camera = light_field.Camera(id);
  const lf::Intrinsics& k = camera.intrinsics;
  std::optional<lf::IdealPixels> ideal;
  std::vector<lf::IdealCell> cells;
  if (k.has_distortion()) {
    ideal.emplace(k);
    cells = lf::MakeIdealCells(k);
  }
  const lf::ImageOverlap overlap(camera, cells, lf::PixelReach::kOwn);
  Usage usage;
  for (const lf::RenderCamera& frame : frames) {
    if (lf::SeenRegion(frame).Misses(camera.CentreWorld())) continue;
    usage.whole += static_cast<uint64_t>(k.width_px) * static_cast<uint64_t>(k.height_px);
    const lf::PixelRect rect = overlap.Rect(frame);
    if (rect.empty()) continue;
    usage.rectangles += static_cast<uint64_t>(rect.pixel_count());
    const lf::Intrinsics& plate = frame.pinhole.intrinsics;
    const lf::ScatterPlan plan =
        lf::PlanScatter(camera, frame, rect, lf::TileSums::GridOf(plate.width_px, plate.height_px),
                        ideal ? &*ideal : nullptr);
    for (const lf::Segment& segment : plan.segments)
      usage.accepted += static_cast<uint64_t>(segment.count);
  }
  return usage;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: lf_ray_usage LIGHTFIELD PATH.yaml\n", stderr);
    return 2;
  }
  const auto light_field = lf::OpenLightField(argv[1]);
  if (!light_field) {
    std::fprintf(stderr, "error: %s\n", light_field.error().message.c_str());
    return 3;
  }
  const auto path = lf::ReadPathYaml(argv[2], light_field->unit_m);
  if (!path) {
    std::fprintf(stderr, "error: %s\n", path.error().message.c_str());
    return 3;
  }
  lf::ThreadPool pool;
  lf::SelectOptions frustum;
  frustum.whole_images = true;
  const auto images = lf::SelectImages(lf::ImageIndex(*light_field), path->cameras, frustum, pool);
  std::vector<Usage> usages(images.size());
  pool.ForEach(images.size(),
               [&](size_t i) { usages[i] = UsageOf(*light_field, images[i].id, path->cameras); });
  std::puts("whole,rectangles,accepted");
  for (const Usage& usage : usages)
    std::printf("%llu,%llu,%llu\n", static_cast<unsigned long long>(usage.whole),
                static_cast<unsigned long long>(usage.rectangles),
                static_cast<unsigned long long>(usage.accepted));
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include "lf/view/scene_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lf/selection/image_index.h"

namespace lf {
namespace {

constexpr size_t kPartBytes = size_t{1} << 20;

// Collects lines and passes them to `emit` in large parts.
class Lines {
 public:
  explicit Lines(const std::function<Result<void>(const std::string&)>& emit) : emit_(emit) {}

  template <class... Args>
  Result<void> Add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    return text_.size() < kPartBytes ? Result<void>() : Flush();
  }
  Result<void> Flush() {
    const std::string text = std::exchange(text_, "");
    return text.empty() ? Result<void>() : emit_(text);
  }

 private:
  const std::function<Result<void>(const std::string&)>& emit_;
  std::string text_;
};

// Returns the position of a camera. Adding zero removes the sign of negative zeros.
Vec3 Place(const PinholeCamera& camera) { return camera.CentreWorld() + Vec3::Zero(); }

}  // namespace

Result<void> WriteSceneText(const LightField& light_field, const CameraPath& path,
                            const std::vector<FrameId>& frames, ImageRanks ranks,
                            const NeedsOptions& options, ThreadPool& pool,
                            const std::function<Result<void>(const std::string&)>& emit) {
  Lines lines(emit);
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const Vec3 centre = Place(light_field.Camera(LfImageId{i}));
    LF_RETURN_IF_ERROR(lines.Add("lf_camera {} {} {} {}\n", i, centre.x(), centre.y(), centre.z()));
  }
  for (const FrameId frame : frames) {
    const Vec3 centre = Place(path.Camera(frame).pinhole);
    LF_RETURN_IF_ERROR(
        lines.Add("render_camera {} {} {} {}\n", frame.value, centre.x(), centre.y(), centre.z()));
  }
  const ImageIndex index(light_field, std::move(ranks));
  for (const FrameId frame : frames) {
    std::vector<FrameNeeds::Image> used = NeedsOf(index, path.Camera(frame), options, pool).images;
    std::sort(used.begin(), used.end(),
              [](const FrameNeeds::Image& a, const FrameNeeds::Image& b) { return a.id < b.id; });
    for (const FrameNeeds::Image& image : used) {
      const Intrinsics& k = light_field.Camera(image.id).intrinsics;
      const double share = static_cast<double>(image.rect.pixel_count()) /
                           (static_cast<double>(k.width_px) * k.height_px);
      LF_RETURN_IF_ERROR(lines.Add("collected {} {} {:.4g}\n", frame.value, image.id.value, share));
    }
  }
  return lines.Flush();
}

}  // namespace lf

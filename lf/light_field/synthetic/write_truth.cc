#include "lf/light_field/synthetic/write_truth.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

Result<void> WriteTruth(const Scene& scene, std::span<const RenderCamera> cameras,
                        const LensSampling& sampling, const std::filesystem::path& folder,
                        ThreadPool& pool, Surroundings surroundings,
                        const std::function<bool(size_t frames_done)>& keep_going) {
  LF_RETURN_IF_ERROR(CreateFolder(folder));
  std::vector<std::string> names = {"R", "G", "B"};
  if (surroundings == Surroundings::kTransparent) names.emplace_back("A");
  for (size_t i = 0; i < cameras.size(); ++i) {
    const Image<float> picture =
        ThinLensPhotograph(scene, cameras[i], sampling, pool, surroundings);
    const Image<float> depths = DepthsSeen(scene, cameras[i].pinhole, pool);
    std::vector<ExrChannel> channels;
    for (int c = 0; c < picture.channels(); ++c)
      channels.push_back({names[static_cast<size_t>(c)], picture.view(), c, false});
    channels.push_back({"Z", depths.view(), 0, false});
    LF_RETURN_IF_ERROR(WriteExr(folder / fmt::format("frame_{:04}.exr", i + 1), channels));
    if (keep_going && !keep_going(i + 1) && i + 1 < cameras.size())
      return Error{
          ErrorKind::kInterrupted,
          fmt::format("{}: stopped after {} of {} frames; run the same command again to start anew",
                      folder.string(), i + 1, cameras.size())};
  }
  return {};
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/write_truth.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "lf/core/check.h"
#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"

namespace lf {
namespace {

// Returns the mean of the pictures that lenses record of the scene.
Image<float> MeanPhotograph(const Scene& scene, std::span<const RenderCamera> cameras,
                            const LensSampling& sampling, ThreadPool& pool,
                            Surroundings surroundings) {
  Image<float> picture = ThinLensPhotograph(scene, cameras.front(), sampling, pool, surroundings);
  if (cameras.size() == 1) return picture;
  std::vector<double> sums(picture.pixels().begin(), picture.pixels().end());
  for (const RenderCamera& camera : cameras.subspan(1)) {
    const Image<float> other = ThinLensPhotograph(scene, camera, sampling, pool, surroundings);
    for (size_t i = 0; i < sums.size(); ++i) sums[i] += other.pixels()[i];
  }
  for (size_t i = 0; i < sums.size(); ++i)
    picture.pixels()[i] = static_cast<float>(sums[i] / static_cast<double>(cameras.size()));
  return picture;
}

}  // namespace

std::filesystem::path TruthPath(const std::filesystem::path& folder, size_t number) {
  return folder / fmt::format("frame_{:04}.exr", number);
}

Result<void> WriteTruth(const Scene& scene, std::span<const RenderCamera> cameras,
                        const LensSampling& sampling, const std::filesystem::path& folder,
                        ThreadPool& pool, Surroundings surroundings,
                        const std::function<bool(size_t frames_done)>& keep_going, size_t instants,
                        uint32_t first_frame) {
  LF_CHECK(instants > 0 && cameras.size() % instants == 0);
  LF_RETURN_IF_ERROR(CreateFolder(folder));
  std::vector<std::string> names = {"R", "G", "B"};
  if (surroundings == Surroundings::kTransparent) names.emplace_back("A");
  const size_t count = cameras.size() / instants;
  for (size_t i = 0; i < count; ++i) {
    const auto of_frame = cameras.subspan(i * instants, instants);
    const Image<float> picture = MeanPhotograph(scene, of_frame, sampling, pool, surroundings);
    const Image<float> depths = DepthsSeen(scene, of_frame[instants / 2].pinhole, pool);
    std::vector<ExrChannel> channels;
    for (int c = 0; c < picture.channels(); ++c)
      channels.push_back({names[static_cast<size_t>(c)], picture.view(), c, false});
    channels.push_back({"Z", depths.view(), 0, false});
    LF_RETURN_IF_ERROR(WriteExr(TruthPath(folder, first_frame + i), channels));
    if (keep_going && !keep_going(i + 1) && i + 1 < count)
      return Error{ErrorKind::kInterrupted,
                   fmt::format("{}: stopped after {} of {} frames; run the command again with "
                               "{{overwrite}} to start "
                               "anew",
                               folder.string(), i + 1, count)};
  }
  return {};
}

}  // namespace lf

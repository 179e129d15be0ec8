// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/check_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <system_error>
#include <variant>

#include "lf/core/files_nearby.h"
#include "lf/import/check/check_codes.h"
#include "lf/light_field/model/image_fit.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/picture_view.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Number of LF images that are checked, by their headers or by all pixels, before progress is
// reported and CheckOptions::interrupted is read.
constexpr size_t kHeadersPerRound = 512;
constexpr size_t kImagesPerRound = 64;

using Finding = CodeChecker::Fault;

Finding CheckFile(const fs::path& path, bool is_mosaic, const Intrinsics& k, ImageCheck check) {
  std::error_code error;
  if (!fs::exists(FileOfImage(path), error))
    return {true, fmt::format("{}: {}{}", path.string(), error ? error.message() : "no such file",
                              FilesNearby(path))};
  const Result<ImageFileInfo> info = ReadImageInfo(path);
  if (!info) return {false, info.error().message};
  if (const auto fit = FitToCalibration(*info, is_mosaic, k, path.string()); !fit)
    return {false, fit.error().message};
  if (check == ImageCheck::kHeaders) return {};
  const Result<StoredImage> image = ReadImage(path);
  return {false, image ? "" : image.error().message};
}

Finding CheckImage(const LightField& light_field, const CodeChecker* codes, LfImageId id,
                   ImageCheck check) {
  if (codes != nullptr) return codes->Check(id, check == ImageCheck::kPixels);
  const Intrinsics& k = light_field.intrinsics[light_field.cameras[id.value].intrinsics_index];
  Finding finding = CheckFile(light_field.ImagePath(id),
                              light_field.encoding.bayer != BayerPattern::kNone, k, check);
  if (!finding.reason.empty() || light_field.mask_names.empty()) return finding;
  const std::string& mask = light_field.mask_names[id.value];
  return mask.empty() ? finding : CheckFile(light_field.folder / mask, false, k, check);
}

}  // namespace

Result<ImageFaults> CheckImages(const LightField& light_field, const CheckOptions& options,
                                ThreadPool& pool) {
  const size_t round = options.check == ImageCheck::kHeaders ? kHeadersPerRound : kImagesPerRound;
  std::unique_ptr<CodeChecker> codes;
  if (HoldsPackedStore(light_field)) {
    LF_ASSIGN_OR_RETURN(codes, CodeChecker::Open(light_field));
  }
  ImageFaults faults;
  std::vector<Finding> findings(round);
  for (size_t begin = 0; begin < light_field.size(); begin += round) {
    if (options.interrupted && *options.interrupted)
      return Error{
          ErrorKind::kInterrupted,
          fmt::format("interrupted after checking {} of {} images", begin, light_field.size())};
    const size_t count = std::min(round, light_field.size() - begin);
    pool.ForEach(count, [&](size_t i) {
      findings[i] = CheckImage(light_field, codes.get(),
                               LfImageId{static_cast<uint32_t>(begin + i)}, options.check);
    });
    for (size_t i = 0; i < count; ++i) {
      faults.left_out_count += findings[i].is_left_out ? 1 : 0;
      if (!findings[i].reason.empty())
        (findings[i].is_missing ? faults.missing : faults.broken)
            .push_back(
                {LfImageId{static_cast<uint32_t>(begin + i)}, std::move(findings[i].reason)});
    }
    if (options.progress) options.progress(begin + count, light_field.size());
  }
  return faults;
}

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/write_light_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <system_error>

#include "lf/core/check.h"
#include "lf/core/file.h"
#include "lf/core/random.h"
#include "lf/light_field/synthetic/photograph.h"
#include "lf/light_field/transforms_json/transforms_json.h"
#include "lf/pixels/files/image_file.h"

namespace lf {
namespace {

constexpr double kLargest16 = 65535;
constexpr double kBlackLevel = 1024;

// Returns one Gaussian random number for each (seed, stream, index), by Box and Muller's method.
double NormalRandom(uint64_t seed, uint64_t stream, uint64_t index) {
  const double radius = std::sqrt(-2 * std::log(1 - RandomUnit(seed, stream, 2 * index)));
  return radius * std::cos(2 * kPi * RandomUnit(seed, stream, 2 * index + 1));
}

uint16_t Stored16(double value) {
  return static_cast<uint16_t>(std::lround(std::clamp(value, 0.0, kLargest16)));
}

constexpr int kAlphaChannel = 3;

Image<uint16_t> Linear16(ImageView<const float> picture, double white_level) {
  Image<uint16_t> stored(picture.width, picture.height, picture.channels);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < picture.channels; ++c)
        stored.at(x, y, c) = Stored16((c == kAlphaChannel ? kLargest16 : white_level) *
                                      static_cast<double>(picture.at(x, y, c)));
  return stored;
}

void EncodeSrgb(Image<float>& picture) {
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      for (int c = 0; c < 3; ++c) {
        const auto value = static_cast<double>(picture.at(x, y, c));
        picture.at(x, y, c) = static_cast<float>(SrgbFromLinear(std::clamp(value, 0.0, 1.0)));
      }
}

// Converts premultiplied colours to straight ones.
void MakeStraight(Image<float>& picture) {
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      if (const float alpha = picture.at(x, y, kAlphaChannel); alpha > 0)
        for (int c = 0; c < 3; ++c) picture.at(x, y, c) /= alpha;
}

Result<void> WriteLfImage(const std::filesystem::path& path, Image<float> picture,
                          const RadianceEncoding& encoding, const WriteLightFieldOptions& options,
                          uint64_t image_seed) {
  std::vector<std::string> names = {"R", "G", "B"};
  if (encoding.AlphaIsLight()) names.emplace_back("A");
  if (encoding.alpha == AlphaMeaning::kStraight) MakeStraight(picture);
  switch (options.format) {
    case LfImageFormat::kExr:
      return WriteImage(path, picture.view(), names, PixelType::kHalf);
    case LfImageFormat::kPng:
      EncodeSrgb(picture);
      return WriteImage(path, picture.view(), names, PixelType::kUint8);
    case LfImageFormat::kPng16: {
      const Image<uint16_t> stored = Linear16(picture.view(), *encoding.white_level);
      return WriteImage(path, stored.view());
    }
    case LfImageFormat::kBayer: {
      const Image<uint16_t> stored = Mosaic(picture.view(), encoding, options.noise, image_seed);
      return WriteImage(path, stored.view());
    }
  }
  return {};
}

}  // namespace

RadianceEncoding EncodingOf(LfImageFormat format, double max_radiance) {
  RadianceEncoding encoding;
  encoding.max_radiance = max_radiance;
  switch (format) {
    case LfImageFormat::kExr:
      encoding.transfer = Transfer::kLinear;
      break;
    case LfImageFormat::kPng:
      encoding.max_radiance = 1;
      break;
    case LfImageFormat::kPng16:
      encoding.transfer = Transfer::kLinear;
      encoding.white_level = std::floor(kLargest16 / max_radiance);
      break;
    case LfImageFormat::kBayer:
      encoding.bayer = BayerPattern::kRggb;
      encoding.transfer = Transfer::kLinear;
      encoding.black_level = kBlackLevel;
      encoding.white_level = kBlackLevel + std::floor((kLargest16 - kBlackLevel) / max_radiance);
      encoding.pedestal = 1024;
      encoding.white_balance = {2, 1, 1.5};
      break;
  }
  return encoding;
}

LightField DescribeLightField(const std::vector<RigidTransform>& poses,
                              const Intrinsics& intrinsics, LfImageFormat format,
                              double max_radiance, const std::filesystem::path& folder) {
  LightField light_field;
  light_field.folder = folder;
  light_field.intrinsics = {intrinsics};
  light_field.encoding = EncodingOf(format, max_radiance);
  const char* const extension = format == LfImageFormat::kExr ? "exr" : "png";
  light_field.cameras.reserve(poses.size());
  light_field.image_names.reserve(poses.size());
  for (const RigidTransform& pose : poses) {
    light_field.image_names.push_back(
        fmt::format("images/{:04}.{}", light_field.cameras.size(), extension));
    light_field.cameras.push_back({pose, 0, 1});
  }
  return light_field;
}

Image<uint16_t> Mosaic(ImageView<const float> picture, const RadianceEncoding& encoding,
                       double noise, uint64_t seed) {
  LF_CHECK(picture.channels == 3 && encoding.white_level);
  constexpr double kElectronics = 0.01;
  const double per_radiance = *encoding.white_level - encoding.black_level;
  Image<uint16_t> mosaic(picture.width, picture.height);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const int channel = BayerChannel(encoding.bayer, x, y);
      double radiance = static_cast<double>(picture.at(x, y, channel)) /
                        encoding.white_balance[static_cast<size_t>(channel)];
      if (noise > 0)
        radiance += noise * std::sqrt(radiance + kElectronics) *
                    NormalRandom(seed, static_cast<uint64_t>(y), static_cast<uint64_t>(x));
      mosaic.at(x, y) = Stored16(encoding.black_level + per_radiance * radiance);
    }
  return mosaic;
}

Result<void> WriteLightField(const Scene& scene, const LightField& light_field,
                             const WriteLightFieldOptions& options, ThreadPool& pool) {
  LF_CHECK(!light_field.encoding.AlphaIsLight() || options.format != LfImageFormat::kBayer);
  const Surroundings surroundings =
      light_field.encoding.AlphaIsLight() ? Surroundings::kTransparent : Surroundings::kShown;
  const std::filesystem::path calibration = light_field.folder / "transforms.json";
  LF_RETURN_IF_ERROR(CreateFolder(light_field.folder / "images"));
  std::error_code error;
  if (!std::filesystem::remove(calibration, error) && error)
    return OutputError(fmt::format("{}: the older calibration cannot be removed: {}",
                                   calibration.string(), error.message()));
  std::mutex mutex;  // guards failure and images_done
  std::optional<Error> failure;
  size_t images_done = 0;
  std::atomic<bool> stopped = false;
  pool.ForEach(light_field.size(), [&](size_t i) {
    if (stopped) return;
    const LfImageId id{static_cast<uint32_t>(i)};
    const Result<void> written =
        WriteLfImage(light_field.ImagePath(id),
                     Photograph(scene, light_field.Camera(id), options.samples, surroundings),
                     light_field.encoding, options, RandomBits(options.seed, 1, i));
    const std::lock_guard lock(mutex);
    if (!written) {
      if (!failure) failure = written.error();
      stopped = true;
      return;
    }
    ++images_done;
    if (options.keep_going && !options.keep_going(images_done)) stopped = true;
  });
  if (failure) return *failure;
  if (images_done < light_field.size())
    return Error{ErrorKind::kInterrupted,
                 fmt::format("{}: stopped after {} of {} images; no transforms.json was written. "
                             "Run the same command again to start anew",
                             light_field.folder.string(), images_done, light_field.size())};
  return WriteTransformsJson(light_field, calibration, kSynthProgram);
}

}  // namespace lf

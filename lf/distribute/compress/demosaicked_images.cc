// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/demosaicked_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "lf/core/check.h"
#include "lf/storage/load/lf_image_store.h"
#include "lf/storage/load/measure_footprint.h"

namespace lf {
namespace {

constexpr double kMostStored = 65535;
// Stored value of no light, which leaves room for values below black.
constexpr double kStoredBlack = 4096;

// Loads LF images that are demosaicked on the way.
class JointStore : public LfImageStore {
 public:
  JointStore(const JointDemosaicker& joint, const RadianceEncoding& encoding)
      : joint_(joint), encoding_(encoding) {}

  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    LF_ASSIGN_OR_RETURN(const JointImageResult joint, joint_.Demosaic(id));
    *pixels = LfPixels(rect, BayerPattern::kNone);
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x)
        for (int c = 0; c < 3; ++c) {
          const float radiance = joint.rgb.at(rect.x_begin + x, rect.y_begin + y, c);
          if (std::isnan(radiance)) {
            pixels->Mask(x, y);
            break;
          }
          pixels->radiance.at(x, y, c) = QuantizeRadiance(encoding_, radiance, 1);
        }
    return {};
  }

 private:
  const JointDemosaicker& joint_;
  const RadianceEncoding& encoding_;
};

}  // namespace

RadianceEncoding RgbEncodingOf(const LightField& mosaics) {
  RadianceEncoding encoding = mosaics.encoding;
  // The most light before gain that loading does not clip.
  double most = std::max(1.0, encoding.max_radiance);
  for (const LfCamera& camera : mosaics.cameras)
    for (const float gain : camera.gain.of_channels)
      if (gain > 0) most = std::max(most, encoding.max_radiance / static_cast<double>(gain));
  encoding.bayer = BayerPattern::kNone;
  encoding.transfer = Transfer::kLinear;
  encoding.response.clear();
  encoding.black_level = kStoredBlack;
  encoding.white_level = kStoredBlack + (kMostStored - kStoredBlack) / most;
  MakeRoomForUndershoot(&encoding);
  return encoding;
}

DemosaickedImages::DemosaickedImages(LightField mosaics, bool measures_footprint)
    : mosaics_(std::move(mosaics)),
      measures_footprint_(measures_footprint),
      encoding_(RgbEncodingOf(mosaics_)),
      errors_(mosaics_.size()) {}

std::string DemosaickedImages::Words() {
  return fmt::format("demosaicked jointly ({})", kJointVersion);
}

Result<void> DemosaickedImages::Prepare(ThreadPool& pool, const std::atomic<bool>* interrupted,
                                        const std::function<void(size_t, size_t)>& tell) {
  JointDemosaicker::Options options;
  options.watch = {"mosaics", interrupted, tell};
  LF_ASSIGN_OR_RETURN(joint_, JointDemosaicker::Make(mosaics_, pool, options));
  if (!measures_footprint_) return {};
  LightField rgb = mosaics_;
  rgb.encoding = encoding_;
  LF_ASSIGN_OR_RETURN(encoding_.footprint, MeasureFootprint(rgb, JointStore(*joint_, encoding_)));
  return {};
}

Result<RecordedImage> DemosaickedImages::Read(LfImageId id, const PixelRect& rect) {
  LF_CHECK(joint_ != nullptr);
  LF_ASSIGN_OR_RETURN(const JointImageResult joint, joint_->Demosaic(id));
  {
    const std::lock_guard lock(mutex_);
    errors_[id.value] = joint.errors;
  }
  RecordedImage image;
  image.layout = PixelLayout::kRgb;
  image.values = StoredValues::kUint16;
  image.rect = Intersection(rect, {0, 0, joint.rgb.width(), joint.rgb.height()});
  image.source_bytes = SourceBytesOf(mosaics_, id);
  const Intrinsics& k = mosaics_.Camera(id).intrinsics;
  const ChannelGains& gain = mosaics_.cameras[id.value].gain;
  const double scale = *encoding_.white_level - kStoredBlack;
  Image<uint16_t> pixels(image.rect.width(), image.rect.height(), 3);
  Image<uint8_t> mask(image.rect.width(), image.rect.height(), 1, 255);
  bool is_masked = false;
  for (int y = 0; y < pixels.height(); ++y)
    for (int x = 0; x < pixels.width(); ++x) {
      const int in_x = image.rect.x_begin + x, in_y = image.rect.y_begin + y;
      const double falloff = k.vignetting.is_none()
                                 ? 1
                                 : k.vignetting.Falloff(RadiusSquared(k, in_x + 0.5, in_y + 0.5));
      for (int c = 0; c < 3; ++c) {
        const float radiance = joint.rgb.at(in_x, in_y, c);
        const double of_channel = gain[static_cast<size_t>(c)];
        if (std::isnan(radiance)) {
          mask.at(x, y) = 0;
          is_masked = true;
        } else if (of_channel > 0) {
          pixels.at(x, y, c) = static_cast<uint16_t>(
              std::clamp(std::floor(kStoredBlack + radiance * falloff / of_channel * scale + 0.5),
                         0.0, kMostStored));
        }
      }
    }
  image.pixels = std::move(pixels);
  if (is_masked) image.mask = std::move(mask);
  return image;
}

GuardErrors DemosaickedImages::Errors() const {
  const std::lock_guard lock(mutex_);
  GuardErrors sum;
  for (const std::optional<GuardErrors>& errors : errors_)
    if (errors) sum += *errors;
  return sum;
}

Result<CompressSource> DemosaickedJointly(LightField mosaics) {
  LF_RETURN_IF_ERROR(CheckForJoint(mosaics));
  // A packed store may state what was measured from its mosaics.
  const bool is_stated = mosaics.encoding.footprint && !HoldsPackedStore(mosaics);
  if (!is_stated) mosaics.encoding.footprint = PixelFootprint::kArea;
  LF_ASSIGN_OR_RETURN(CompressSource source, SourceOfAll(std::move(mosaics)));
  source.demosaicked = std::make_shared<DemosaickedImages>(source.light_field, !is_stated);
  source.light_field.encoding = RgbEncodingOf(source.light_field);
  source.films.reset();
  return source;
}

}  // namespace lf

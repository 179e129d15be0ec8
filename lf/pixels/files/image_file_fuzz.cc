// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

#include "lf/pixels/files/colour_profile.h"
#include "lf/pixels/files/exposure_facts.h"
#include "lf/pixels/files/file_bytes.h"
#include "lf/pixels/files/geo_tags.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/picture_header.h"
#include "lf/pixels/files/whole_file.h"

// Any bytes must give an image, or an error that names the file. Pictures above a million values
// are read up to their header only, because decoding them takes long and shows nothing new.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view file(reinterpret_cast<const char*>(bytes), size_bytes);
  if (const auto facts = lf::ReadExposureFactsBytes(file, "fuzz"); facts) {
    for (const auto& fact : {facts->time_s, facts->f_number, facts->iso})
      LF_CHECK(!fact || (*fact > 0 && *fact < 1e300));
  }
  if (const auto tags = lf::ReadGeoTagsBytes(file, "fuzz"); tags)
    LF_CHECK(!tags->pixel_size || ((*tags->pixel_size)[0] > 0 && (*tags->pixel_size)[1] > 0));
  else
    LF_CHECK(tags.error().message.starts_with("fuzz: "));
  const lf::FileBytes bytes_of = lf::FileInMemory(file, "fuzz");
  if (const auto whole = lf::CheckIsWhole(bytes_of.read, bytes_of.size_bytes, "fuzz"); !whole)
    LF_CHECK(whole.error().message.starts_with("fuzz: "));
  const auto info = lf::ReadImageInfoBytes(file, "fuzz");
  if (!info) {
    LF_CHECK(info.error().message.starts_with("fuzz: "));
    return 0;
  }
  const auto header = lf::ReadPictureHeaderBytes(file, "fuzz");
  LF_CHECK(header && header->info.channels == info->channels);
  LF_CHECK(header->colours.frames_per_second.value_or(1) > 0);
  LF_CHECK(info->width > 0 && info->height > 0 && info->channels > 0);
  if (info->raw)
    LF_CHECK(info->raw->black_level.value_or(0) < info->raw->white_level.value_or(65536));
  if (int64_t{info->width} * info->height > 1'000'000 / info->channels) return 0;
  lf::ImagePart part;
  const auto all = [](const lf::ImageFileInfo& of) -> lf::Result<lf::PixelRect> {
    return lf::PixelRect{0, 0, of.width, of.height};
  };
  if (const auto read = lf::ReadImagePartBytes(file, "fuzz", all, &part); !read) {
    LF_CHECK(read.error().message.starts_with("fuzz: "));
    return 0;
  }
  LF_CHECK(lf::NameOfProfile(part.icc_profile).size() <= 80);
  lf::ConvertToSrgb(part.icc_profile, &part.image);
  std::visit(
      [&](const auto& pixels) {
        LF_CHECK(pixels.width() == info->width && pixels.height() == info->height);
        LF_CHECK(pixels.channels() == info->channels);
      },
      part.image);
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/colour_profile.h"

#include <lcms2.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "lf/core/hash.h"

namespace lf {
namespace {

struct CloseProfile {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
using Profile = std::unique_ptr<void, CloseProfile>;

using Transform = std::shared_ptr<void>;

Profile OpenProfile(std::string_view icc) {
  // Little CMS prints nothing unless it is given a handler.
  return Profile(cmsOpenProfileFromMem(icc.data(), static_cast<cmsUInt32Number>(icc.size())));
}

// Returns a transform of RGB values, with `extra` channels behind them that are not touched, to
// sRGB; null if the bytes are no profile of RGB colours, or Little CMS cannot use it.
Transform MakeTransform(std::string_view icc, int bytes, int extra) {
  const Profile from = OpenProfile(icc), to(cmsCreate_sRGBProfile());
  if (!from || !to || cmsGetColorSpace(from.get()) != cmsSigRgbData) return nullptr;
  const cmsUInt32Number type = COLORSPACE_SH(PT_RGB) | CHANNELS_SH(3) |
                               EXTRA_SH(static_cast<cmsUInt32Number>(extra)) |
                               BYTES_SH(static_cast<cmsUInt32Number>(bytes));
  // Without its cache of one pixel, a transform may be used by several threads at once.
  return Transform(cmsCreateTransform(from.get(), type, to.get(), type,
                                      INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE),
                   [](void* transform) {
                     if (transform != nullptr) cmsDeleteTransform(transform);
                   });
}

// Returns true if the transform changes a value of a lattice of colours by more than one step.
bool Changes(const Transform& transform) {
  constexpr int kSteps = 6;
  std::vector<std::array<uint8_t, 3>> colours;
  for (int r = 0; r < kSteps; ++r)
    for (int g = 0; g < kSteps; ++g)
      for (int b = 0; b < kSteps; ++b) {
        const auto level = [](int step) { return static_cast<uint8_t>(step * 51); };
        colours.push_back({level(r), level(g), level(b)});
      }
  std::vector<std::array<uint8_t, 3>> changed(colours.size());
  cmsDoTransform(transform.get(), colours.data(), changed.data(),
                 static_cast<cmsUInt32Number>(colours.size()));
  for (size_t i = 0; i < colours.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      if (std::abs(colours[i][c] - changed[i][c]) > 1) return true;
  return false;
}

// Keeps transforms, because making one takes longer than a small picture.
class Transforms {
 public:
  // Returns null if pictures with this profile need no transform.
  Transform Of(std::string_view icc, int bytes, int extra) {
    constexpr size_t kMost = 64;  // more profiles than a light field has
    const std::tuple key(HashBytes(icc), icc.size(), bytes, extra);
    const std::lock_guard lock(mutex_);
    if (const auto found = made_.find(key); found != made_.end()) return found->second;
    if (made_.size() >= kMost) made_.clear();
    Transform transform = MakeTransform(icc, 1, 0);
    if (transform && !Changes(transform)) transform = nullptr;
    if (transform && (bytes != 1 || extra != 0)) transform = MakeTransform(icc, bytes, extra);
    return made_[key] = transform;
  }

 private:
  std::mutex mutex_;
  std::map<std::tuple<uint64_t, size_t, int, int>, Transform> made_;
};

Transform TransformOf(std::string_view icc, int bytes, int extra) {
  static Transforms transforms;
  return icc.empty() ? nullptr : transforms.Of(icc, bytes, extra);
}

template <class T>
bool Convert(std::string_view icc, Image<T>* image) {
  if (image->channels() < 3) return false;
  const Transform transform = TransformOf(icc, sizeof(T), image->channels() - 3);
  if (!transform) return false;
  for (int y = 0; y < image->height(); ++y)
    cmsDoTransform(transform.get(), image->row(y), image->row(y),
                   static_cast<cmsUInt32Number>(image->width()));
  return true;
}

bool Convert(std::string_view, Image<float>*) { return false; }

}  // namespace

std::string NameOfProfile(std::string_view icc) {
  const Profile profile = OpenProfile(icc);
  if (!profile) return "";
  std::array<char, 80> name = {};
  cmsGetProfileInfoASCII(profile.get(), cmsInfoDescription, "en", "US", name.data(),
                         static_cast<cmsUInt32Number>(name.size()));
  std::string text = name.data();
  // A file may state anything.
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
  return text.empty() ? "without a name" : text;
}

bool IsOtherThanSrgb(std::string_view icc) { return TransformOf(icc, 1, 0) != nullptr; }

bool ConvertToSrgb(std::string_view icc, StoredImage* image) {
  return std::visit([&](auto& pixels) { return Convert(icc, &pixels); }, *image);
}

}  // namespace lf

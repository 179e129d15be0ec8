// SPDX-License-Identifier: Apache-2.0
// Planes of a densified store: a packed store that also has virtual LF images
// (doc/formats/packed_store.md, "Densified stores"). A plane holds numbers for the pixels of an LF
// image: 16 bits for those of a recorded one, such as its disparities, and 8 bits for the trust of
// a virtual one. packed_store_writer.h writes planes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

enum class PlaneKind : uint8_t {
  kSwept = 0,      // an intermediate result, from which the densifier resumes
  kDisparity = 1,  // the final result
  // Trust in the pixels of a virtual LF image (LfPixels::trust), one number for each, rounded to
  // kTrustSteps steps. Virtual LF images without this plane, as earlier builds wrote them, are
  // trusted.
  kTrust = 2,
};
// Finer steps are noise, which would make the planes three times as large. Divides 255.
inline constexpr int kTrustSteps = 15;
inline constexpr int kPlaneKindCount = 3;

// Everything about a densified store but its virtual LF images and planes.
struct DensifiedPlan {
  std::string settings;  // all settings of the densifier, in words; not empty
  // Inverse depths, in 1 / world unit along the axis of the LF camera, that the numbers 1 and 65535
  // of a plane stand for; least <= greatest, both at most 1e12. Below 0, points are beyond
  // infinity, as in images that are rectified to a plane. The number 0 means unknown.
  double plane_least = 0;
  double plane_greatest = 0;
  // A plane of a recorded LF image has one number for plane_divisor x plane_divisor LF pixels. From
  // 1 to kMostDivisor.
  int plane_divisor = 1;

  friend bool operator==(const DensifiedPlan&, const DensifiedPlan&) = default;
};
inline constexpr int kMostDivisor = 1024;

// Width and height of a plane.
struct PlaneSize {
  int width = 0;
  int height = 0;
  friend bool operator==(const PlaneSize&, const PlaneSize&) = default;
};
// Returns the size of the LF image divided by `divisor`, rounded up.
PlaneSize PlaneSizeOf(int width_px, int height_px, int divisor);

// Reads the plan of a densified store, and no other facts; nullopt if the store is not densified.
// kInput as ReadPackedStore().
Result<std::optional<DensifiedPlan>> ReadDensifiedPlan(const std::filesystem::path& path);

// Reads planes of a complete store, one at a time, for one thread.
class PackedPlaneReader {
 public:
  // Opens a store for reading. kInput as ReadPackedStore(), and if the store is not densified.
  static Result<PackedPlaneReader> Open(const std::filesystem::path& path);
  PackedPlaneReader(PackedPlaneReader&&) noexcept;
  PackedPlaneReader& operator=(PackedPlaneReader&&) noexcept;
  ~PackedPlaneReader();

  // Returns true if the store has this plane. kInput: the file is damaged.
  Result<bool> Has(LfImageId id, PlaneKind kind);
  // Reads a plane of a recorded LF image, [height][width][1]. kInput, naming the file: the store
  // lacks the plane, or the plane is damaged.
  Result<Image<uint16_t>> Read(LfImageId id, PlaneKind kind);
  // Reads the trust, 0 to LfPixels::kTrusted, in the pixels `rect` of a virtual LF image, which
  // must contain a pixel and lie in the image. [rect.height()][rect.width()][1]. Errors as Read();
  // also kInput: the image is smaller than `rect`.
  Result<Image<uint8_t>> ReadTrust(LfImageId id, const PixelRect& rect);

 private:
  struct State;
  explicit PackedPlaneReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lf

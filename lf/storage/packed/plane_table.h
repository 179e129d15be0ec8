// SPDX-License-Identifier: Apache-2.0
// The table of planes and the settings of a densified store, for its writer and its reader.
// Internal to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/packed_planes.h"

namespace lf {

// Returns the text of a kind in the column `kind`.
std::string_view NameOf(PlaneKind kind);

// Returns the settings of a densified store.
SettingList SettingsOf(const DensifiedPlan& plan);
// Reads them again; nullopt if the store is not densified, which its tables tell.
Result<std::optional<DensifiedPlan>> ReadDensified(OpenedStore* store);

// One plane as it is stored.
struct StoredPlane {
  std::string code;   // encoded image
  PlaneSize size;     // size that the plane must have
  std::string place;  // begins messages: "a.lfs: plane disparity of LF image 3"
};
// Reads a plane. An error of the database's kind if it is missing or damaged.
Result<StoredPlane> ReadStoredPlane(Database* database, LfImageId id, PlaneKind kind, int divisor);
std::string EncodePlane(const Image<uint16_t>& plane);
// Encodes trust, rounded to kTrustSteps steps.
std::string EncodeTrust(const Image<uint8_t>& trust);
// kInput: the plane is damaged.
Result<Image<uint16_t>> DecodePlane(const StoredPlane& stored);
// Decodes a part of a plane of trust. kInput: the plane is damaged, or smaller than `rect`.
Result<Image<uint8_t>> DecodeTrust(const StoredPlane& stored, const PixelRect& rect);

// The planes of a store that is being written. It must be closed before the database.
class PlaneTable {
 public:
  // Finds the planes that the store has. kInput: a plane belongs to no LF image that has such
  // planes: recorded ones have all kinds but kTrust, which virtual ones have.
  static Result<PlaneTable> Open(const Settings& settings, const LightField& light_field,
                                 int divisor, Database* database);

  bool Has(LfImageId id, PlaneKind kind) const;
  // Returns true if the LF image has planes of this kind, and they must have this size.
  bool Fits(LfImageId id, PlaneKind kind, PlaneSize size) const {
    return is_virtual_[id.value] == (kind == PlaneKind::kTrust) && sizes_[id.value] == size;
  }
  Result<void> Insert(LfImageId id, PlaneKind kind, std::string_view code);
  Result<StoredPlane> Read(LfImageId id, PlaneKind kind) {
    return ReadStoredPlane(database_, id, kind, divisor_);
  }
  // Removes all planes of a kind. No batch may be open.
  Result<void> Drop(PlaneKind kind);

 private:
  PlaneTable(Database* database, int divisor, Statement insert)
      : database_(database), divisor_(divisor), insert_(std::move(insert)) {}

  Database* database_;
  int divisor_;
  Statement insert_;
  std::vector<bool> is_virtual_;            // [LF image]
  std::vector<PlaneSize> sizes_;            // [LF image]: size of its planes
  std::vector<bool> has_[kPlaneKindCount];  // [kind][LF image]
};

}  // namespace lf

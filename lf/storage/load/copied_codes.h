// SPDX-License-Identifier: Apache-2.0
// Copies the encoded images of a packed store into another one. They are decoded only if their
// reference images are not copied.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/reference_cache.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/packed/reference_table.h"

namespace lf {

class CopiedCodes {
 public:
  // Opens the packed store light_field.folder, in which LF images are found by name. The light
  // field must outlive the result. kInput: the store is damaged.
  static Result<std::unique_ptr<CopiedCodes>> Open(const LightField& light_field);

  // Returns the store's entry of an LF image.
  const PackedCode& EntryOf(LfImageId id) const { return codes_[id.value]; }
  // Returns an encoded image with its mask, fronts and the ids of its reference images. An LF image
  // that is predicted from LF images that the light field lacks is decoded, and encoded alone
  // without loss. May be called by many threads at the same time. kInput, naming the LF image: the
  // store lacks it or its bytes, or is damaged.
  Result<CodedImage> Of(LfImageId id) const;

  // Returns true if LF images of the store are predicted.
  bool ArePredicted() const { return !references_.empty(); }
  // Returns CodedImage::references of Of(id).
  std::vector<LfImageId> ReferencesOf(LfImageId id) const;
  // Returns all LF images that a copy of this one needs, each after its reference images. The last
  // one is `id` itself.
  std::vector<LfImageId> NeededBy(LfImageId id) const;

  // Sets PackedStorePlan::codec, display_levels and is_predicted to those of the store.
  void Describe(PackedStorePlan* plan) const;

 private:
  explicit CopiedCodes(const LightField& light_field) : light_field_(light_field) {}
  Result<void> OpenReferences();
  Result<void> EncodeAlone(LfImageId id, CodedImage* image) const;

  const LightField& light_field_;
  std::string codec_;
  std::vector<PackedCode> codes_;  // [LF image]
  ReferenceTable references_;
  // [id in the store]: id in the light field, kNoWholeId if it lacks the LF image; empty if no LF
  // image is predicted.
  std::vector<uint32_t> ids_;
  std::unique_ptr<ReferenceCache> decoded_;  // null if no LF image is predicted
  std::optional<DisplayLevels> display_levels_;
  mutable std::mutex mutex_;
  mutable std::optional<PackedCodeReader> reader_;  // guarded by the mutex
};

}  // namespace lf

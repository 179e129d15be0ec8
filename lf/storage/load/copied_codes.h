// SPDX-License-Identifier: Apache-2.0
// Copies the encoded images of a packed store into another one, without decoding them.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {

class CopiedCodes {
 public:
  // Opens the packed store light_field.folder, in which LF images are found by name. The light
  // field must outlive the result. kInput: the store is damaged.
  static Result<std::unique_ptr<CopiedCodes>> Open(const LightField& light_field);

  // Returns the store's entry of an LF image.
  const PackedCode& EntryOf(LfImageId id) const { return codes_[id.value]; }
  // Returns an encoded image with its mask and fronts. May be called by many threads at the same
  // time. kInput, naming the LF image: the store lacks it or its bytes, or is damaged.
  Result<CodedImage> Of(LfImageId id) const;

  // Sets PackedStorePlan::codec and display_levels to those of the store.
  void Describe(PackedStorePlan* plan) const;

 private:
  explicit CopiedCodes(const LightField& light_field) : light_field_(light_field) {}

  const LightField& light_field_;
  std::string codec_;
  std::vector<PackedCode> codes_;  // [LF image]
  std::optional<DisplayLevels> display_levels_;
  mutable std::mutex mutex_;
  mutable std::optional<PackedCodeReader> reader_;  // guarded by the mutex
};

}  // namespace lf

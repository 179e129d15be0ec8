// SPDX-License-Identifier: Apache-2.0
// Checks the LF images of a packed store. Internal to this folder.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/reference_cache.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {

class CodeChecker {
 public:
  // Opens the packed store that the light field was read from. The light field must outlive the
  // checker. kInput: the store's table cannot be read.
  static Result<std::unique_ptr<CodeChecker>> Open(const LightField& light_field);

  // The result of a check. `reason` is a message that names the LF image; "" if there is no fault.
  struct Fault {
    bool is_missing = false;  // true: the store lacks the LF image
    std::string reason = {};
    bool is_left_out = false;  // true: it was left out of the store on purpose, which is no fault
  };
  // Checks one LF image. May be called by many threads at the same time.
  //   decode  false: checks only the entry in the store's table; true: also decodes image and mask,
  //           or, if the store lacks its finest parts, compares the others with their checksums
  Fault Check(LfImageId id, bool decode) const;

 private:
  CodeChecker(const LightField& light_field, std::vector<PackedCode> codes, int missing_parts);
  // The messages of errors begin with `name`.
  Result<void> Decode(LfImageId id, const std::string& name) const;
  Result<void> DecodeColours(const PackedCode& code, std::string_view bytes,
                             const std::string& name) const;

  const LightField& light_field_;
  const std::vector<PackedCode> codes_;
  const int missing_parts_;                     // number of files that a store by resolution lacks
  std::unique_ptr<ReferenceCache> references_;  // null if no LF image is predicted
  mutable std::mutex mutex_;
  mutable std::vector<PackedCodeReader> readers_;  // open readers that no call uses now
};

}  // namespace lf

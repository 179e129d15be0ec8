// SPDX-License-Identifier: Apache-2.0
// Reads and writes the table of reference images (reference_table.h). Internal to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/reference_table.h"

namespace lf {

// As ReadReferences() of a path.
Result<ReferenceTable> ReadReferences(OpenedStore* store);

// The reference images in a store that is being written. It must be closed before the database.
class ReferenceRows {
 public:
  // Reads the rows of a store that is resumed. kInput: one of them is damaged, or belongs to an LF
  // image that the store lacks.
  //   has  [id]: true if the store has the encoded image
  static Result<ReferenceRows> Open(const Settings& settings, const std::vector<bool>& has,
                                    Database* database);

  // Returns true if a reader would accept an LF image with these reference images, which the store
  // has.
  bool Allows(std::span<const LfImageId> references) const;
  Result<void> Insert(LfImageId id, std::span<const LfImageId> references);

 private:
  explicit ReferenceRows(Statement insert) : insert_(std::move(insert)) {}

  Statement insert_;
  std::unordered_map<uint32_t, std::vector<uint32_t>> references_;  // of each predicted LF image
};

}  // namespace lf

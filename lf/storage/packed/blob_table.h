// SPDX-License-Identifier: Apache-2.0
// The tables of encoded images and of their fronts in a store or shard that is being written.
// Internal to this folder.
#pragma once

#include <utility>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/sqlite/database.h"

namespace lf {

// It must be closed before the database.
class BlobTable {
 public:
  // An unfinished file of an earlier build gets the table of fronts.
  static Result<BlobTable> Open(Database* file);
  // Replaces rows of the LF image: an earlier program may have committed them to a shard, and ended
  // before it committed the row of the table `codes` to the store.
  Result<void> Insert(LfImageId id, const CodedImage& image);

 private:
  BlobTable(Statement insert_blob, Statement insert_fronts)
      : insert_blob_(std::move(insert_blob)), insert_fronts_(std::move(insert_fronts)) {}

  Statement insert_blob_;
  Statement insert_fronts_;
};

}  // namespace lf

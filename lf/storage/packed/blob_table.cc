// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/blob_table.h"

#include "lf/core/check.h"
#include "lf/storage/packed/code_fronts.h"
#include "lf/storage/packed/packed_format.h"

namespace lf {

Result<BlobTable> BlobTable::Open(Database* file) {
  LF_ASSIGN_OR_RETURN(Statement insert_blob,
                      file->Prepare("insert or replace into blobs values (?, ?, ?)"));
  LF_ASSIGN_OR_RETURN(const bool has_fronts, HasTable(file, kFrontsName));
  if (!has_fronts) LF_RETURN_IF_ERROR(file->Execute(kFrontsTable));
  LF_ASSIGN_OR_RETURN(Statement insert_fronts,
                      file->Prepare("insert or replace into fronts values (?, ?)"));
  return BlobTable(std::move(insert_blob), std::move(insert_fronts));
}

Result<void> BlobTable::Insert(LfImageId id, const CodedImage& image) {
  insert_blob_.Bind(0, int64_t{id.value}).BindBlob(1, image.code);
  if (image.mask.empty())
    insert_blob_.BindNull(2);
  else
    insert_blob_.BindBlob(2, image.mask);
  LF_RETURN_IF_ERROR(insert_blob_.Run());
  if (image.front_ends.empty()) return {};
  LF_CHECK(image.mask.empty());
  insert_fronts_.Bind(0, int64_t{id.value});
  insert_fronts_.BindBlob(1, CodeOfFronts(image.code, image.front_ends));
  return insert_fronts_.Run();
}

}  // namespace lf

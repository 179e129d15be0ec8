// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/open_store.h"

#include <utility>

#include "lf/storage/load/folder_store.h"
#include "lf/storage/load/packed_store.h"
#include "lf/storage/load/reduced_store.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {

Result<std::unique_ptr<LfImageStore>> OpenStore(const LightField& light_field, Mosaics mosaics,
                                                StoreContent content) {
  if (light_field.reduction) return ReducedStore::Open(light_field);
  if (!HoldsPackedStore(light_field))
    return std::unique_ptr<LfImageStore>(std::make_unique<FolderStore>(light_field, mosaics));
  LF_ASSIGN_OR_RETURN(std::unique_ptr<LfImageStore> store,
                      PackedStore::Open(light_field, mosaics, content));
  return store;
}

}  // namespace lf

#include "lf/store/open_store.h"

#include <utility>

#include "lf/packed/packed_store_file.h"
#include "lf/store/folder_store.h"
#include "lf/store/packed_store.h"

namespace lf {

Result<std::unique_ptr<LfImageStore>> OpenStore(const LightField& light_field, Mosaics mosaics) {
  if (!HoldsPackedStore(light_field))
    return std::unique_ptr<LfImageStore>(std::make_unique<FolderStore>(light_field, mosaics));
  LF_ASSIGN_OR_RETURN(std::unique_ptr<LfImageStore> store, PackedStore::Open(light_field, mosaics));
  return store;
}

}  // namespace lf

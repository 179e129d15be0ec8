// SPDX-License-Identifier: Apache-2.0
// Opens the store of a light field: image files or a packed store.
#pragma once

#include <memory>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Returns a PackedStore if light_field.folder is the file of a packed store, otherwise a
// FolderStore. Of a reduced light field, returns a store that loads reduced LF images, always in
// RGB. The store keeps a reference to `light_field`, which must outlive it. kInput as
// PackedStore::Open().
Result<std::unique_ptr<LfImageStore>> OpenStore(const LightField& light_field, Mosaics mosaics,
                                                StoreContent content = StoreContent::kPixels);

}  // namespace lf

// The store of a light field, whichever it is.
#pragma once

#include <memory>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"
#include "lf/store/lf_image_store.h"

namespace lf {

// A PackedStore where light_field.folder is the file of one, else a FolderStore. Keeps a reference
// to `light_field`, which must outlive it. kInput: of a packed store.
Result<std::unique_ptr<LfImageStore>> OpenStore(const LightField& light_field, Mosaics mosaics);

}  // namespace lf

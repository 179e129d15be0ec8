// SPDX-License-Identifier: Apache-2.0
// Checks that a packed store on the disk matches its source. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/distribute/compress/compress_source.h"
#include "lf/distribute/compress/encoding.h"
#include "lf/distribute/compress/image_use.h"
#include "lf/storage/load/copied_codes.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {

struct VerifyOptions {
  std::filesystem::path store;
  const CopiedCodes* copied = nullptr;  // set if encoded images were copied from another store
  Encoding encoding;                    // with which the store must have been made
  ThresholdFactors factors;             // factors of the threshold of settings
  PackedStorePlan plan;                 // the plan that the store must match
  bool any_shards = true;               // true: shards may have any size
  std::function<bool()> is_interrupted;
};

// Checks what the store states about itself, without reading encoded images. kInput: the store is
// of other LF images, another calibration or other settings, or is missing, unfinished or damaged.
Result<void> CheckStoreFacts(const CompressSource& source, const VerifyOptions& options);

// Reads all encoded images back. Each must equal the result of encoding its LF image, or its file,
// and be decoded without damage. If an LF image is missing in the store, its file must not be
// readable. Returns the number of encoded images that were read. kInput: an encoded image differs
// or is damaged (the message states the first and the count), or the store is of another light
// field or other settings. kInterrupted: is_interrupted() returned true.
//   progress  called with the number of LF images that have been checked
Result<size_t> VerifyStore(const CompressSource& source, const VerifyOptions& options,
                           ThreadPool& pool, const std::function<void(size_t)>& progress);

// Returns the total size of the store's file and its shards; 0 if the store cannot be read.
uint64_t StoreBytes(const std::filesystem::path& store);

}  // namespace lf

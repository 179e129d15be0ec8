// Whether a packed store on the disk is what it was made from. Internal to compress.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "lf/codec/lf_image_codec.h"
#include "lf/compress/compress_source.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/packed/packed_store_writer.h"

namespace lf {

struct VerifyOptions {
  std::filesystem::path store;
  CodecSettings settings;  // that it must have been made by
  PackedStorePlan plan;    // and from what
  bool any_shards = true;  // of whatever size
  std::function<bool()> is_interrupted;
};

// kInput: the store is of other LF images, another calibration or other settings, or none.
Result<void> CheckStoreFacts(const CompressSource& source, const VerifyOptions& options);

// How many codes were read back, compared with what their LF images give, and decoded. LF images
// without a code must not be readable.
// kInput: the first code that differs, or is damaged, and how many there are; another light field
// or other settings; kInterrupted.
Result<size_t> VerifyStore(const CompressSource& source, const VerifyOptions& options,
                           ThreadPool& pool, const std::function<void(size_t)>& progress);

// Of the store's file and its shards.
uint64_t StoreBytes(const std::filesystem::path& store);

}  // namespace lf

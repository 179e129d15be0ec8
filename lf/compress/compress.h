// LF images into a packed store (thesis 4.2.2, 4.5.3).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/codec/lf_image_codec.h"
#include "lf/compress/code_quality.h"
#include "lf/compress/compress_source.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"

namespace lf {

struct CompressOptions {
  std::filesystem::path store;  // STORE.lfs
  // The threshold is in grey steps (GreyStep() of code_quality.h) of the images' values.
  CodecSettings codec;
  // Instead of the threshold: that with which LF images have this PSNR together, by some of them.
  std::optional<double> target_psnr_db;
  uint64_t shard_bytes = 0;  // as PackedStorePlan
  bool resume = false;       // an unfinished store; one that is there must be what is asked for
  bool overwrite = false;    // one that is there, unfinished or not
  bool strict = false;       // an LF image that cannot be read is an error
  // Reads all codes back from the disk: each must be what its LF image gives, and be decoded
  // without damage. A store that is there already is checked and nothing else.
  bool verify = false;
  std::string source_name;  // LIGHTFIELD or packages, as they were given
  std::string version;      // of the program
  const std::atomic<bool>* interrupted = nullptr;
};

struct CompressProgress {
  size_t done = 0;  // LF images
  size_t total = 0;
  uint64_t pixel_bytes = 0;  // of those done by this call, as they are stored
  uint64_t code_bytes = 0;
  bool is_verifying = false;
};

struct CompressReport {
  size_t image_count = 0;
  size_t resumed_count = 0;  // were there already
  bool was_there = false;    // all of the store: nothing was written
  double threshold = 0;      // in grey steps
  size_t rounded_count = 0;  // LF images with floats that half floats cannot hold
  struct Skipped {
    std::string name;
    std::string reason;
  };
  std::vector<Skipped> skipped;  // LF images without a code, also in a store that was there

  // Of the LF images that this call coded.
  size_t coded_count = 0;
  uint64_t source_bytes = 0;  // of their files
  uint64_t pixel_bytes = 0;   // of their pixels as they are stored
  uint64_t code_bytes = 0;
  CodeError error;
  double worst_psnr_db = 0;  // of one LF image; infinite where all are exact
  std::string worst_name;
  double encode_cpu_s = 0;
  double total_s = 0;

  std::optional<size_t> verified_count;
  uint64_t store_bytes = 0;  // of all its files
};

// The settings in words: what a store that goes on compares.
std::string NameOf(const CodecSettings& settings);

// kUsage: settings, a store that is there, another file of its name; kInput: no LF image can be
// read, one cannot if strict, files that are not those an unfinished store was made from, a store
// that is not what its LF images give (verify); kOutput; kInterrupted: what is done is kept.
Result<CompressReport> Compress(const CompressSource& source, const CompressOptions& options,
                                ThreadPool& pool,
                                const std::function<void(const CompressProgress&)>& progress);

}  // namespace lf

// SPDX-License-Identifier: Apache-2.0
// Compresses LF images into a packed store (thesis 4.2.2, 4.5.3).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/demosaic/joint_demosaicker.h"
#include "lf/distribute/compress/choose_prediction.h"
#include "lf/distribute/compress/code_quality.h"
#include "lf/distribute/compress/compress_source.h"
#include "lf/distribute/compress/encoding.h"
#include "lf/distribute/compress/image_use.h"
#include "lf/distribute/compress/keep_files.h"
#include "lf/pixels/codec/lf_image_codec.h"

namespace lf {

// Says if LF images are predicted from others of their group (selection/reference_groups.h).
enum class Prediction : uint8_t {
  kNone,    // every LF image is encoded by itself
  kGroups,  // LF images are predicted where that saves a tenth of the bytes
  // Decided by a sample of the LF images: kGroups if prediction saves a tenth of its bytes;
  // otherwise kNone, or KeepFiles::kAll if all files of the sample are smaller.
  kChosen,
};

struct CompressOptions {
  std::filesystem::path store;  // path of the packed store, such as STORE.lfs
  // The threshold is in grey steps (GreyStep() of code_quality.h) of the images' values.
  CodecSettings codec;
  // Must be kNone for CodecProfile::kThesis and if CompressSource::demosaicked is set.
  KeepFiles files = KeepFiles::kSmaller;
  // Must be kNone for CodecProfile::kThesis and by_resolution. With kGroups, `files` must be kNone;
  // with kChosen, kSmaller.
  Prediction prediction = Prediction::kNone;
  // Replaces codec.entropy if LF images are predicted.
  Entropy group_entropy = Entropy::kContexts;
  // If not null, each LF image has a threshold of its own: codec's threshold times its factor of
  // ThresholdFactors. The profile must be kDefault.
  const ImageUse* use = nullptr;
  // If set, replaces codec's threshold by the largest one at which a sample of the LF images has at
  // least this PSNR. If `use` is not null, it is that of the frames: of all frames together, as
  // PredictFrames() predicts it.
  std::optional<double> target_psnr_db;
  uint64_t shard_bytes = 0;  // approximate size of each file of encoded images; 0: one file
  // True: makes a store by resolution (packed_store_writer.h), in whose files LF images are in
  // spread order (selection/spread_order.h). Not together with shard_bytes. All pixels of LF images
  // must be compressed, because parts of them are not reduced.
  bool by_resolution = false;
  // True: resumes an unfinished store, or begins a new one if there is none. If the store is
  // complete, it must match the options, and is kept.
  bool resume = false;
  bool overwrite = false;  // true: replaces an existing store, unfinished or complete
  bool strict = false;     // true: an LF image that cannot be read is an error
  // True: reads all encoded images back from the disk. Each must equal the result of encoding its
  // LF image, and be decoded without damage. If a complete store exists already and is not
  // replaced, it is only checked.
  bool verify = false;
  std::string source_name;  // LIGHTFIELD or packages, as the user gave them
  std::string version;      // version of the program
  const std::atomic<bool>* interrupted = nullptr;
};

// Each phase counts anew.
enum class CompressPhase : uint8_t {
  kChoosing,   // a sample of the LF images is encoded (Prediction::kChosen)
  kEncoding,   // the LF images are encoded or copied
  kVerifying,  // the LF images are read back (CompressOptions::verify)
  kPreparing,  // mosaics are examined before they are demosaicked (CompressSource::demosaicked)
};

struct CompressProgress {
  // Number of LF images that are done in this phase. Those that an earlier call has encoded, and
  // those that were found unreadable, count as encoded.
  size_t done = 0;
  size_t total = 0;
  // Size of the pixels of the LF images that this call encoded, in the number type of their files.
  uint64_t pixel_bytes = 0;
  uint64_t code_bytes = 0;
  CompressPhase phase = CompressPhase::kEncoding;
};

struct CompressReport {
  size_t image_count = 0;     // LF images that are compressed
  size_t left_out_count = 0;  // other LF images: the store has their LF cameras alone
  size_t resumed_count = 0;   // LF images that the unfinished store already had
  bool was_there = false;     // true if the store was complete, so that nothing was written
  std::string codec;          // settings in words, as the store records them
  bool is_copy = false;       // true: encoded images were copied from another store
  double threshold = 0;       // threshold of the encoder, in grey steps
  std::optional<SampledBytes> sample;  // by which Prediction::kChosen was chosen; unset without it
  size_t rounded_count = 0;  // LF images with floats that half floats cannot represent exactly
  struct Skipped {
    std::string name;
    std::string reason;
  };
  std::vector<Skipped> skipped;  // LF images that are not in the store because they cannot be read

  // Count, sums and lowest quality of the LF images that this call encoded.
  size_t coded_count = 0;
  size_t file_count = 0;       // of these, LF images that are kept as their files
  size_t predicted_count = 0;  // of these, LF images that are predicted from others
  uint64_t source_bytes = 0;   // size of the files of the LF images
  uint64_t pixel_bytes = 0;    // size of the pixels, in the number type of the files
  uint64_t code_bytes = 0;
  CodeError error;
  double worst_psnr_db = 0;  // lowest PSNR of an LF image; infinite if all are exact
  std::string worst_name;
  // Predicted errors of the frames of CompressOptions::use; unset without it, or if this call did
  // not encode all LF images, because the errors of the others are not known. An LF image that is
  // kept as its file, or could not be read, counts as exact.
  std::optional<FrameErrors> frames;
  // Errors of demosaicking at tested pixels of the LF images that this call encoded or verified;
  // unset unless CompressSource::demosaicked is set.
  std::optional<GuardErrors> demosaicked;
  double encode_cpu_s = 0;
  double total_s = 0;

  // Number of encoded images that were read back; unset without CompressOptions::verify.
  std::optional<size_t> verified_count;
  uint64_t store_bytes = 0;  // size of all files of the store
};

// Compresses the LF images of `source` into options.store. If its light field is a packed store,
// copies their encoded images, with the settings of that store in place of options.codec and files.
// kUsage: wrong settings, the store exists and no option says what to do with it, its name belongs
// to another file or is that of the store that is copied, that has predicted LF images and
// by_resolution is true, or no threshold reaches target_psnr_db. kInput: no LF image can be read,
// or `strict` is true and one cannot be read; the files are not those that an unfinished store was
// made from; or the store differs from the result of encoding its LF images (`verify`). kOutput:
// the disk or the memory fails. kInterrupted: finished work is kept.
//   progress  called at the beginning of each phase, and after each LF image; may be empty
Result<CompressReport> Compress(const CompressSource& source, const CompressOptions& options,
                                ThreadPool& pool,
                                const std::function<void(const CompressProgress&)>& progress);

}  // namespace lf

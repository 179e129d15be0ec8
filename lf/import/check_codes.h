// What is to be said of the LF images of a packed store. Internal to import.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/packed/packed_store_file.h"

namespace lf {

class CodeChecker {
 public:
  static Result<std::unique_ptr<CodeChecker>> Open(const LightField& light_field);

  // "": nothing is. May be called by many threads at the same time.
  struct Fault {
    bool is_missing = false;
    std::string reason;
  };
  //   decode  all of the code, with its checksum; otherwise the store's table is asked
  Fault Check(LfImageId id, bool decode) const;

 private:
  CodeChecker(const LightField& light_field, std::vector<PackedCode> codes);
  Result<void> Decode(LfImageId id) const;

  const LightField& light_field_;
  const std::vector<PackedCode> codes_;
  mutable std::mutex mutex_;
  mutable std::vector<PackedCodeReader> readers_;  // as many as were at work at the same time
};

}  // namespace lf

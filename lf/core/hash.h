// SPDX-License-Identifier: Apache-2.0
// Checksums of bytes: XXH3, 64 bits. They reveal damage and differences, but do not protect against
// forgery.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

namespace lf {

// Returns the hash of the bytes. It is the same on every machine and in every version, so that
// files may contain it.
uint64_t HashBytes(std::string_view bytes, uint64_t seed = 0);

// Hashes bytes that come in parts. Hash() is HashBytes() of all parts together.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  void Add(std::string_view bytes);
  uint64_t Hash() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lf

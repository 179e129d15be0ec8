// Checksums of bytes: XXH3, 64 bits. They tell damage and difference, not malice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

namespace lf {

// The same everywhere, for ever: it may be written to files.
uint64_t HashBytes(std::string_view bytes, uint64_t seed = 0);

// The hash of bytes that come in parts: that of HashBytes() of all together.
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

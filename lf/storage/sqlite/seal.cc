// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/sqlite/seal.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "lf/core/hash.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// The footer consists of 8 letters, the number of bytes of the file in front of the footer, and the
// XXH3 of these bytes. Both numbers have 8 bytes, the least significant first.
constexpr std::string_view kLetters = "LFSEAL1\n";
constexpr size_t kSealBytes = 24;
constexpr size_t kPartBytes = size_t{1} << 20;

std::string NumberText(uint64_t number) {
  std::string text(8, '\0');
  for (size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(number >> (8 * i) & 0xFF);
  return text;
}

// Returns the footer for the first `size` bytes of a file; empty if the file has fewer bytes.
std::string SealOf(std::istream& file, uint64_t size) {
  Hasher hasher;
  std::string part(kPartBytes, '\0');
  uint64_t left = size;
  while (left > 0) {
    const auto wanted = static_cast<std::streamsize>(std::min<uint64_t>(left, part.size()));
    if (!file.read(part.data(), wanted)) return {};
    hasher.Add(std::string_view(part).substr(0, static_cast<size_t>(wanted)));
    left -= static_cast<uint64_t>(wanted);
  }
  return std::string(kLetters) + NumberText(size) + NumberText(hasher.Hash());
}

}  // namespace

Result<void> SealFile(const fs::path& path) {
  const auto failed = [&path] {
    return OutputError(fmt::format("{}: cannot be written: {}", path.string(), strerror(errno)));
  };
  std::error_code error;
  const uint64_t size = fs::file_size(path, error);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  if (error || !file) return failed();
  const std::string seal = SealOf(file, size);
  if (seal.empty()) return failed();
  file.seekp(0, std::ios::end);
  if (!file.write(seal.data(), static_cast<std::streamsize>(seal.size())).flush()) return failed();
  return {};
}

Result<void> CheckSeal(const fs::path& path, const char* what) {
  std::error_code error;
  const uint64_t size = fs::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file)
    return InputError(fmt::format("{}: cannot be read: {}", path.string(), strerror(errno)));
  std::string stored(kSealBytes, '\0');
  if (size > kSealBytes) {
    file.seekg(static_cast<std::streamoff>(size - kSealBytes));
    file.read(stored.data(), kSealBytes);
    file.seekg(0);
  }
  if (!file || !stored.starts_with(kLetters))
    return InputError(
        fmt::format("{}: is a damaged {}: the checksum at its end is missing, probably because it "
                    "was copied in part; copy or make it again",
                    path.string(), what));
  if (SealOf(file, size - kSealBytes) != stored)
    return InputError(
        fmt::format("{}: is a damaged {}: its bytes do not match the checksum at its end; copy or "
                    "make it again",
                    path.string(), what));
  return {};
}

}  // namespace lf

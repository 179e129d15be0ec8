// SPDX-License-Identifier: Apache-2.0
// The file FIELD.lfs.url of a local copy: lines "url URL", "validator TEXT" and "size BYTES".
// Internal to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "lf/core/result.h"

namespace lf {

struct StoreNote {
  std::string url;
  std::string validator;  // of the tables; empty: the server states none
  uint64_t size_bytes = 0;
};

// Returns nullopt if the text is no such file, or its URL is none that stores are read from.
std::optional<StoreNote> ParseStoreNote(std::string_view text);
std::string TextOf(const StoreNote& note);

// Returns the name of the file of a store.
std::filesystem::path NotePath(const std::filesystem::path& store);
// Returns nullopt if there is no such file. kInput: it is damaged or cannot be read.
Result<std::optional<StoreNote>> ReadStoreNote(const std::filesystem::path& store);
// kOutput as WriteFileAtomically().
Result<void> WriteStoreNote(const std::filesystem::path& store, const StoreNote& note);

}  // namespace lf

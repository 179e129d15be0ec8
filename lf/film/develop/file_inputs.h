// SPDX-License-Identifier: Apache-2.0
// States in a finished file what it was made of, so that --resume keeps no file of other inputs.
//
// The inputs are a text of lines "KEY VALUE". EXR files have it as the attribute lf:inputs, PNG
// files as a text of this key. Videos have it in a box at their end, of the type that ISO/IEC
// 14496-12 leaves to programs ("uuid") and that players skip.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"

namespace lf {

// Pairs of key and value. A key has no blank.
using FileInputs = std::vector<std::pair<std::string, std::string>>;

std::string TextOfInputs(const FileInputs& inputs);
FileInputs InputsOfText(std::string_view text);

// Returns the inputs that an EXR, PNG or mp4 file states; nullopt if it cannot be read or states
// none. An EXR file may hold several pictures, such as a focus stack.
std::optional<FileInputs> ReadInputs(const std::filesystem::path& file);

// Returns the error of --resume for a finished file that was made of something else.
//   why  such as "was made with layout anaglyph, and this call has side-by-side"
Error CannotResume(const std::filesystem::path& file, std::string_view why);

// Appends the box with this text to a complete mp4 file. kOutput if it cannot be written.
Result<void> AppendInputs(const std::filesystem::path& video, std::string_view text);
// Returns the text of the box in an mp4 file; nullopt if there is none. Reads only the heads of the
// other boxes.
//   size_bytes  length of the file
//   read        reads bytes at an offset; returns false if there are fewer
std::optional<std::string> FindInputs(
    uint64_t size_bytes, const std::function<bool(uint64_t offset, std::span<char> to)>& read);

// Returns a hash of the contents of files, one after the other. kInput if one cannot be read.
// kInterrupted: is_interrupted, if given, returned true.
Result<std::string> HashOfFiles(std::span<const std::filesystem::path> files, ThreadPool& pool,
                                const std::function<bool()>& is_interrupted = {});

}  // namespace lf

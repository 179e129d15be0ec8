// SPDX-License-Identifier: Apache-2.0
// Joins EXR files into one file of several parts.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// A part of a multi-part EXR file, and the file that it is copied from.
struct ExrPart {
  std::filesystem::path from;  // a file with one part of scanlines, as WriteExr() writes it
  std::string name;            // name of the part; each is different
};

// Writes one EXR file with these parts, in this order, atomically (core/file.h). Channels,
// compressed pixels and attributes are those of the files. The parts must have the same size,
// pixel aspect ratio and chromaticities, because OpenEXR keeps these once for all parts.
//   is_interrupted  called before each part, if given
//   texts           further attributes of the first part: names and texts
// kInput: a file cannot be read, or has another size than the first. kOutput: the folder or the
// disk fails. kInterrupted: is_interrupted returned true; nothing is written.
Result<void> JoinExr(const std::filesystem::path& path, std::span<const ExrPart> parts,
                     const std::function<bool()>& is_interrupted = {},
                     const std::vector<std::pair<std::string, std::string>>& texts = {});

// Returns the value of an attribute of type double in each part of an EXR file. kInput: the file
// cannot be read, or a part has no such attribute.
Result<std::vector<double>> NumbersOfParts(const std::filesystem::path& path,
                                           const std::string& attribute);

}  // namespace lf

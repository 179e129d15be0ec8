// SPDX-License-Identifier: Apache-2.0
// Reads the encoding of camera raw files from the files themselves, for light fields that do not
// state it.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// Default pedestal, the 16-bit value v of no light, for files with a black level above 0. It leaves
// room for noise below black.
inline constexpr double kRawPedestal = 1024;

// Returns true for file names that end in dng or an extension of the cameras' own formats (cr2,
// cr3, nef, arw, ...), in upper or lower case.
bool IsRawName(const std::string& file_name);

// RawFactsOfFirstImage() returns the raw facts of the first image, which are used for all images,
// or nullopt if there is no image or IsRawName() is false for its name. The pixels of this image
// are decoded only if its header does not state the black level. kInput: the file cannot be read or
// is no raw file; the message says what the user can state instead.
using RawFactsSource = std::function<Result<std::optional<RawFacts>>(const LightField&)>;
Result<std::optional<RawFacts>> RawFactsOfFirstImage(const LightField& light_field);

// Returns an encoding for raw files with these facts. It is linear, and has no Bayer pattern if the
// facts have none. Levels and colours that the facts do not have keep their defaults. The pedestal
// is kRawPedestal if the black level is above 0, otherwise 0.
RadianceEncoding EncodingOfRaw(const RawFacts& facts);

// Completes a light field whose calibration says nothing about pixels: sets the encoding of raw
// files from the first image, keeps max_radiance, and warns about facts that the file does not
// state. A light field whose first image is no raw file is unchanged. Returns the errors of
// RawFactsOfFirstImage().
Result<void> CompleteEncodingOfRaw(LightField* light_field);

// Warns about levels and colours that neither the calibration nor the file states; defaults are
// used for them.
void WarnOfUnknown(const LightField& light_field, const RawFacts& facts, bool levels_stated,
                   bool colours_stated);

}  // namespace lf

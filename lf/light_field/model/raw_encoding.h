// Takes the encoding of camera raw files from the files themselves, if the light field does not
// state it.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// Default v of no light if there is a black level: room for the noise below it.
inline constexpr double kRawPedestal = 1024;

// Returns true for dng and the extensions of cameras' own formats (cr2, cr3, nef, arw, ...), in
// upper or lower case.
bool IsRawName(const std::string& file_name);

// Returns the raw facts of the first image, which hold for all images, or nullopt if its name is
// not that of a raw file. Pixels are decoded if the header does not state the black level. kInput:
// the file cannot be read or is no raw file; the message says what to state instead.
using RawFactsSource = std::function<Result<std::optional<RawFacts>>(const LightField&)>;
Result<std::optional<RawFacts>> RawFactsOfFirstImage(const LightField& light_field);

// Returns an encoding for raw files with these facts. It is linear, and has no Bayer pattern if the
// facts have none. Levels and colours that the facts do not have keep their defaults.
RadianceEncoding EncodingOfRaw(const RawFacts& facts);

// For light fields whose calibration says nothing about pixels. Sets the encoding of raw files from
// the first image and warns about facts that it does not have. Other light fields are unchanged.
Result<void> CompleteEncodingOfRaw(LightField* light_field);

// Warns about levels and colours that neither the calibration nor the file states, so that defaults
// are used.
void WarnOfUnknown(const LightField& light_field, const RawFacts& facts, bool levels_stated,
                   bool colours_stated);

}  // namespace lf

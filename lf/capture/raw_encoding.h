// What camera raw files say themselves of their pixels, where the light field does not.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"
#include "lf/imageio/image_file.h"

namespace lf {

// v of no light, by default, where there is a black level: room for the noise below it.
inline constexpr double kRawPedestal = 1024;

// By the extension, in any case: dng, and those of cameras' own formats (cr2, cr3, nef, arw, ...).
bool IsRawName(const std::string& file_name);

// Returns the encoding that the first image tells of all, if its name is that of a raw file; else
// none. Pixels are decoded if the header does not tell the black level. kInput: it cannot be read,
// or is no raw file (the message says what to state instead).
using RawFactsSource = std::function<Result<std::optional<RawFacts>>(const LightField&)>;
Result<std::optional<RawFacts>> RawFactsOfFirstImage(const LightField& light_field);

// An encoding of raw files with these facts: linear; without a pattern where they tell none, or
// where there is no colour filter.
// Levels and colours that they do not tell stay as they are by default.
RadianceEncoding EncodingOfRaw(const RawFacts& facts);

// For light fields whose calibration says nothing of pixels: takes the encoding of raw files from
// the first image, warns of what that does not tell, and leaves others alone.
Result<void> CompleteEncodingOfRaw(LightField* light_field);

// Warns of what is neither stated nor told, and taken to be the default.
void WarnOfUnknown(const LightField& light_field, const RawFacts& facts, bool levels_stated,
                   bool colours_stated);

}  // namespace lf

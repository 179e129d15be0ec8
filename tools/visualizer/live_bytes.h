// SPDX-License-Identifier: Apache-2.0
// The data of live pictures as bytes for the page (doc/formats/page_data.md).
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/live/live_renderer.h"

namespace lf {

// Returns uint32 length of the JSON text, and the text, padded by spaces to a multiple of 4 bytes.
std::string WithHead(const nlohmann::ordered_json& json);

// Returns why the page cannot render live pictures of these LF images itself; "" if it can.
std::string WhyNotInBrowser(const LightField& field);

// Returns {"width", "height": of the LF image in pixels, "matrix": the 9 numbers of calibration
// matrix times rotation, row by row, "centre": position in the world [x, y, z]}.
nlohmann::ordered_json LfCameraJson(const PinholeCamera& camera);

// Returns the lens of a picture that is rendered in the browser: `json` with the facts of the lens
// added, and then the weights at the nodes.
std::string LensBytes(const LiveRenderer::LensPlan& plan, const RenderCamera& frame,
                      nlohmann::ordered_json json);

// Returns LfCameraJson() of a shrunken LF image, and then its radiances, uint16 R, G, B and 1 (0 if
// the pixel is masked).
std::string LfImageBytes(const PinholeCamera& camera, const LfPixels& pixels);

}  // namespace lf

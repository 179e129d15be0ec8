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

// Returns the length of the JSON text, and the text, padded to a multiple of 4 bytes.
std::string WithHead(const nlohmann::ordered_json& json);

// Returns why the page cannot render live pictures of these LF images itself; "" if it can.
std::string WhyNotInBrowser(const LightField& field);

// Returns {"width": of the LF image, "height": ..., "matrix": [3][3] calibration matrix times
// rotation, "centre": [...]}.
nlohmann::ordered_json LfCameraJson(const PinholeCamera& camera);

// Returns the lens of a picture that is rendered in the browser: `json`, to which the facts of the
// lens are added, and the weights at the nodes.
std::string LensBytes(const LiveRenderer::LensPlan& plan, const RenderCamera& frame,
                      nlohmann::ordered_json json);

// Returns the LF camera, and the radiances of the pixels of its shrunken LF image.
std::string LfImageBytes(const PinholeCamera& camera, const LfPixels& pixels);

}  // namespace lf

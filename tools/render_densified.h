// SPDX-License-Identifier: Apache-2.0
// lfrenderer --densify: makes the densified light field that is rendered.
#pragma once

#include "tools/common/allow_missing.h"
#include "tools/render_arguments.h"

#include "lf/camera/path/camera_path.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct DensifiedFilm {
  LightField light_field;  // with virtual LF images; the recorded one if it is dense enough
  MissingImages missing;   // broken LF images, which the densified store lacks
};

// Makes DIR/densified.lfs with the virtual LF images that the path needs, with the default options
// of lfdensify, and opens it. A complete store is kept if it is of the same light field and path.
//   options  made of the arguments; the options that densified light fields cannot be rendered with
//            are refused before any work
// Errors as Densify(), CheckRenderOptions() and OpenLightField().
Result<DensifiedFilm> DensifyForFilm(LightField light_field, const CameraPath& path,
                                     const RenderArguments& arguments, const RenderOptions& options,
                                     const CommonOptions& common, ThreadPool& pool);

}  // namespace lf

// Derives the needs of frames from the options of a render.
#include "lf/pipeline/check_render_options.h"
#include "lf/pipeline/render.h"
#include "lf/preprocess/film_order.h"

namespace lf {

NeedsOptions NeedsOfRender(const Package& package, const RenderOptions& options) {
  NeedsOptions needs;
  needs.select.reach = ReachOf(options.reading.estimator);
  needs.select.max_angle_rad = package.choices.max_angle_rad;
  if (options.signals != nullptr) needs.select.interrupted = &options.signals->stop;
  needs.lens_weights = options.lens_weights;
  needs.max_image_count = options.max_image_count;
  needs.mode = options.mode;
  needs.rebin = options.rebin;
  return needs;
}

Result<void> PutInOrder(ImageOrder order, const RenderOptions& options, ThreadPool& pool,
                        Package* package) {
  LF_RETURN_IF_ERROR(CheckRenderOptions(*package, options));
  LF_ASSIGN_OR_RETURN(package->places,
                      PlacesOfFilm(order, package->choices.seed, package->light_field,
                                   package->path, NeedsOfRender(*package, options), pool));
  package->choices.order = order;
  return {};
}

}  // namespace lf

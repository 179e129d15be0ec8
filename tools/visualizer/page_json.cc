// SPDX-License-Identifier: Apache-2.0
// Makes the answers of the page that are JSON.
#include <fmt/format.h>

#include <cmath>

#include "tools/common/program.h"
#include "tools/visualizer/film_commands.h"
#include "tools/visualizer/page_answers.h"

#include "lf/core/geometry.h"
#include "lf/core/spelling.h"
#include "lf/core/version.h"
#include "lf/distribute/preprocess/frame_density.h"
#include "lf/render/state/record_fields.h"
#include "lf/view/overlap_outline.h"
#include "lf/view/scene_bytes.h"
#include "lf/view/shown_frames.h"

namespace lf {
namespace {

Json OfVector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json OfPackages(const PageScene& scene) {
  Json packages = Json::array();
  for (const auto& package : scene.packages()) {
    Json frames = Json::array();
    for (const FrameId frame : package->FrameIds()) frames.push_back(frame.value);
    packages.push_back({{"name", package->name}, {"frames", std::move(frames)}});
  }
  return packages;
}

// Returns the world directions, at depth 1, of the rays through the four corners of the LF image,
// without lens distortion: clockwise from the upper left corner.
Json CornersOf(const PinholeCamera& camera) {
  PinholeCamera straight = camera;
  straight.intrinsics.distortion = {};
  const double w = camera.intrinsics.width_px, h = camera.intrinsics.height_px;
  Json corners = Json::array();
  for (const Vec2& corner : {Vec2(0, 0), Vec2(w, 0), Vec2(w, h), Vec2(0, h)})
    corners.push_back(OfVector(RayOfPixel(straight, corner.x(), corner.y()).direction));
  return corners;
}

// Returns the ids of virtual LF images as ranges: [[begin, end], ...].
Json VirtualRanges(const LightField& field) {
  Json ranges = Json::array();
  for (size_t i = 0; i < field.size(); ++i) {
    if (!field.cameras[i].is_virtual) continue;
    if (i > 0 && field.cameras[i - 1].is_virtual)
      ranges.back()[1] = i + 1;
    else
      ranges.push_back({i, i + 1});
  }
  return ranges;
}

Json OfDepths(const PageScene& scene) {
  Json depths = Json::array();
  for (const DepthFile& file : scene.depths()) {
    const DepthPoints& points = file.points;
    Json facts = {{"name", file.name},
                  {"points", points.places.size()},
                  {"points_in_file", points.count_in_file},
                  {"unknown", points.unknown_count},
                  {"has_confidence", points.has_confidence},
                  {"has_colours", points.has_colours},
                  {"spread", points.spread}};
    if (points.centre) facts["centre"] = OfVector(*points.centre);
    depths.push_back(std::move(facts));
  }
  return depths;
}

}  // namespace

PageAnswer Refusal(int status, const std::string& message) {
  const std::string text = Spelled(message);
  return {status, "application/json", RecordLine({{"error", text}}), text};
}

PageAnswer Refusal(const Error& error) {
  return Refusal(error.kind == ErrorKind::kOutput ? 507 : 422, error.message);
}

std::string PathHeadJson(const PathDraft& draft) {
  const PathFrames& path = *draft.path;
  const RenderCamera first = *path.Camera(path.frames().At(0));
  const Intrinsics& k = first.pinhole.intrinsics;
  Json head = {{"id", draft.id},
               {"frames", path.frame_count()},
               {"first_frame", path.frames().first},
               {"shown_step", ShownStep(path.frame_count())},
               {"fps", path.fps()},
               {"unit_m", path.unit_m()},
               {"width", k.width_px},
               {"height", k.height_px},
               {"widest_radius", path.widest_radius_w()}};
  if (first.transmission) head["transmission"] = first.transmission->Text();
  return RecordLine(head);
}

std::string PathNewsJson(PageScene& scene, const std::string& text) {
  const auto draft = scene.AddDraft(text);
  return RecordLine(
      {{"id", IdOfText(text)}, {"fault", draft ? "" : Spelled(draft.error().message)}});
}

std::string SceneJson(const PageScene& scene, const PathDraft& draft,
                      const PageAbilities& abilities) {
  const LightField& field = scene.light_field();
  const PageArguments& arguments = scene.arguments();
  const FilmCommands commands = CommandsOf(
      arguments, !scene.store().IsPartial() &&
                     TakesDensify(field, arguments.film, draft.path->has_focal_surface()));
  Json json = {{"version", Version()},
               {"light_field",
                {{"name", arguments.light_field},
                 {"images", field.size()},
                 {"unit_m", field.unit_m},
                 {"origin", OfVector(SceneOrigin(field))}}},
               {"path", Json::parse(PathHeadJson(draft))},
               {"path_file", arguments.path.string()},
               {"commands",
                {{"forecast", commands.forecast},
                 {"render", commands.render},
                 {"packages", commands.packages},
                 {"densify", commands.densify}}},
               {"packages", OfPackages(scene)},
               {"packages_note", scene.packages_note()},
               {"watch", arguments.watch.string()},
               {"server", abilities.is_server}};
  if (HasVirtual(field)) json["light_field"]["virtual_ranges"] = VirtualRanges(field);
  if (field.depth_range)
    json["light_field"]["depths"] = {field.depth_range->near_w, field.depth_range->far_w};
  if (!scene.depths().empty()) json["depths"] = OfDepths(scene);
  return RecordLine(json);
}

std::string FilmJson(const FilmUse::Facts& facts) {
  return RecordLine({{"done", facts.frames_done},
                     {"total", facts.image_counts.size()},
                     {"images", facts.image_counts},
                     {"rays", facts.ray_counts}});
}

std::string DensityJson(PageScene& scene, const PathDraft& draft, FrameId frame) {
  const FrameDensity density =
      DensityOf(scene.index(), *draft.path->Camera(frame), scene.light_field().depth_range);
  return RecordLine({{"cameras_in_lens", density.cameras_in_lens},
                     {"camera_distance", density.camera_distance_w},
                     {"uncovered_share", density.coverage.uncovered_share},
                     {"fitting_aperture", density.coverage.fitting_diameter_w},
                     {"least_aperture", density.least_aperture_w},
                     {"depths", {density.depths.near_w, density.depths.far_w}},
                     {"depths_known", scene.light_field().depth_range.has_value()},
                     {"near_displacement_px", density.near_displacement_px},
                     {"far_displacement_px", density.far_displacement_px},
                     {"copies_px", WantsVirtual(density, HasVirtual(scene.light_field()))
                                       ? Json(density.MostDisplacement_px())
                                       : Json()}});
}

std::string CameraJson(const PageScene& scene, LfImageId id) {
  const LightField& field = scene.light_field();
  const PinholeCamera camera = field.Camera(id);
  const Intrinsics& k = camera.intrinsics;
  return RecordLine({{"id", id.value},
                     {"name", field.image_names[id.value]},
                     {"centre", OfVector(camera.CentreWorld())},
                     {"forward", OfVector(camera.ForwardWorld())},
                     {"up", OfVector(camera.UpWorld())},
                     {"corners", CornersOf(camera)},
                     {"width", k.width_px},
                     {"height", k.height_px},
                     {"focal_px", k.fx_px},
                     {"distorted", k.has_distortion()},
                     {"virtual", field.cameras[id.value].is_virtual}});
}

std::string OverlapJson(PageScene& scene, const PathDraft& draft, FrameId frame, LfImageId id) {
  const PinholeCamera camera = scene.light_field().Camera(id);
  Json outlines = Json::array();
  for (const auto& polygon : OverlapOutlines(camera, *draft.path->Camera(frame))) {
    Json corners = Json::array();
    for (const Vec2& corner : polygon) corners.push_back({corner.x(), corner.y()});
    outlines.push_back(std::move(corners));
  }
  Json json = {{"outlines", std::move(outlines)}};
  for (const FrameNeeds::Image& image : scene.UseOf(draft, frame).used)
    if (image.id == id)
      json["rect"] = {image.rect.x_begin, image.rect.y_begin, image.rect.x_end, image.rect.y_end};
  return RecordLine(json);
}

}  // namespace lf

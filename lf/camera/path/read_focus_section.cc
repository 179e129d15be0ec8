// SPDX-License-Identifier: Apache-2.0
// The section `focus` of a path file: the focal surface.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "lf/camera/path/read_sections.h"

namespace lf {
namespace {

// Reads a direction of any length but 0, unless the key is missing.
void ReadDirection(YamlMap* focus, std::string_view key, Vec3* direction) {
  const YamlEntry* entry = focus->Find(key);
  if (!entry) return;
  const std::string label = focus->Label(key);
  const auto xyz = ReadNumbers(*entry->value, label, 3, NumberRange::Any(), focus->errors());
  if (!xyz) return;
  const Vec3 given((*xyz)[0], (*xyz)[1], (*xyz)[2]);
  if (given.norm() > 0)
    *direction = given.normalized();
  else
    focus->errors()->Add(entry->value->place, fmt::format("{}: [0, 0, 0] is no direction", label));
}

// Reads the keys that place a height map in the world.
void ReadPlacement(YamlMap* focus, FocalSurfaceSource* source) {
  YamlErrors* errors = focus->errors();
  const auto read_point = [&](const YamlEntry& entry, std::string_view label, Vec3* point) {
    if (const auto xyz = ReadNumbers(*entry.value, label, 3, NumberRange::Any(), errors))
      *point = {(*xyz)[0], (*xyz)[1], (*xyz)[2]};
  };
  const YamlEntry* const origin = focus->Find("origin");
  source->needs_origin = origin == nullptr;
  if (origin) read_point(*origin, "focus.origin", &source->origin_w);
  if (const YamlEntry* map_origin = focus->Find("map_origin")) {
    read_point(*map_origin, "focus.map_origin", &source->map_origin_m);
    if (origin)
      errors->Add(
          map_origin->value->place,
          "focus.map_origin is used only if the origin is read from the GeoTIFF tags of the "
          "file: give either map_origin or origin");
  }
  double cell_w = 1;
  const YamlEntry* const cell = focus->Find("cell");
  source->needs_cell = cell == nullptr;
  if (cell)
    cell_w = ReadNumber(*cell->value, "focus.cell", NumberRange::Above(0), errors).value_or(1);
  Vec3 right = Vec3::UnitX(), down = -Vec3::UnitY();
  ReadDirection(focus, "right", &right);
  ReadDirection(focus, "down", &down);
  ReadDirection(focus, "up", &source->up);
  constexpr double kMostCosine = 1e-6;
  if (std::abs(right.dot(down)) > kMostCosine || std::abs(right.dot(source->up)) > kMostCosine ||
      std::abs(down.dot(source->up)) > kMostCosine)
    errors->Add(focus->place(),
                "focus.right, down and up are not at right angles to each other; give three axes "
                "of the world, such as right: [1, 0, 0], down: [0, -1, 0], up: [0, 0, 1]");
  source->right_w = cell_w * right;
  source->down_w = cell_w * down;
  if (const YamlEntry* offset = focus->Find("offset")) {
    source->has_offset = true;
    source->offset_w =
        ReadNumber(*offset->value, "focus.offset", NumberRange::Any(), errors).value_or(0);
  }
}

}  // namespace

void ReadFocusSection(const YamlNode& node, PathDescription* path, YamlErrors* errors) {
  YamlMap focus(node, "focus", errors);
  FocalSurfaceSource source;
  const YamlEntry* surface = focus.Require("surface", "surface: depth_%04d.exr");
  const YamlEntry* kind = focus.Require("kind", "kind: depth");
  if (!surface || !kind) return;
  const YamlNode& name = *surface->value;
  if ((name.kind != YamlNode::Kind::kPlain && name.kind != YamlNode::Kind::kQuoted) ||
      name.text.empty()) {
    AddExpected(name, "focus.surface", "the name of a picture file, such as depth_%04d.exr",
                errors);
    return;
  }
  source.file = name.text;
  const auto word = ReadWord(*kind->value, "focus.kind", {"depth", "height"}, errors);
  if (!word) return;
  source.kind =
      *word == "depth" ? FocalSurfaceSource::Kind::kDepths : FocalSurfaceSource::Kind::kHeights;
  if (source.kind == FocalSurfaceSource::Kind::kHeights) ReadPlacement(&focus, &source);
  const bool is_depth = source.kind == FocalSurfaceSource::Kind::kDepths;
  const YamlEntry* const scale = focus.Find("scale");
  source.has_scale = scale != nullptr;
  if (scale)
    source.scale = ReadNumber(*scale->value, "focus.scale",
                              is_depth ? NumberRange::Above(0) : NumberRange::Any(), errors)
                       .value_or(1);
  if (const YamlEntry* nodata = focus.Find("nodata"))
    source.nodata = ReadNumber(*nodata->value, "focus.nodata", NumberRange::Any(), errors);
  if (const YamlEntry* blur = focus.Find("blur"))
    source.most_blur_px =
        ReadNumber(*blur->value, "focus.blur", NumberRange::Within(0.01, 100), errors)
            .value_or(0.5);
  focus.CheckKeys();
  path->focal_surface = source;
}

}  // namespace lf

# SPDX-License-Identifier: Apache-2.0
"""The text of transforms.json (doc/formats/transforms_json.md)."""
import json

import bpy
import numpy as np

from .plan import round_to


def unit_m(scene):
    """Returns the metres of a Blender unit."""
    return round_to(scene.unit_settings.scale_length, 7)


def transforms_json(scene, plan):
    """Returns the text of transforms.json. It names every LF image, also those that are not rendered yet."""
    k = plan.intrinsics(0)
    shared = {"camera_model": "PINHOLE", "w": k.width, "h": k.height, "fl_x": k.fx, "fl_y": k.fy, "cx": k.cx,
              "cy": k.cy, "lf_unit_m": unit_m(scene), "lf_depth_range": list(plan.depth_range),
              "lf_pixels": "areas", "lf_max_radiance": round_to(scene.lfrendertools.max_radiance, 7)}
    if scene.render.film_transparent:
        shared.update(lf_alpha="premultiplied", lf_background="none")
    shared["blender"] = provenance(scene, plan)
    lines = [f"  {json.dumps(key)}: {json.dumps(value)},\n" for key, value in shared.items()]
    frames = [json.dumps(lf_image(plan, index, k)) for index in range(plan.rig.count)]
    return "{\n" + "".join(lines) + '  "frames": [\n    ' + ",\n    ".join(frames) + "\n  ]\n}\n"


def lf_image(plan, index, shared):
    """Returns the entry of one LF image."""
    # Rounded, so that other processors, which multiply with other rounding, write the same text.
    matrix = np.round(plan.world_from_lf[index], 12) + 0.0
    entry = {"file_path": f"images/{plan.name(index)}", "transform_matrix": matrix.tolist()}
    k = plan.intrinsics(index)
    if (k.cx, k.cy) != (shared.cx, shared.cy):
        entry.update(cx=k.cx, cy=k.cy)
    return entry


def provenance(scene, plan):
    """Returns what decides about the pixels besides the scene itself. A capture is resumed only if it is the same."""
    result = {"version": bpy.app.version_string, "scene": scene.name, "frame": scene.frame_current,
              "rig": plan.rig.shape.lower(), "columns": plan.rig.columns, "rows": plan.rig.rows,
              "bits": 32 if scene.lfrendertools.use_float else 16, "engine": scene.render.engine}
    if scene.render.engine == "CYCLES":
        result.update(samples=scene.cycles.samples, seed=scene.cycles.seed)
    return result

# SPDX-License-Identifier: Apache-2.0
"""Finds the F-curves of a data-block, in Blender with and without action slots. Needs no Blender."""


def fcurves_of(animation):
    """Returns the F-curves by which an action animates a data-block.

    animation  the animation_data of the data-block (bpy.types.AnimData), or None

    From Blender 4.4 on, an action has layers of strips, and a strip has a channelbag for each slot, that is, for each
    data-block that it animates. Blender 5 has no Action.fcurves any more.
    """
    action = animation.action if animation else None
    if action is None:
        return []
    slot = getattr(animation, "action_slot", None)
    if slot is None:
        return list(getattr(action, "fcurves", ()))
    bags = [strip.channelbag(slot) for layer in action.layers for strip in layer.strips]
    return [curve for bag in bags if bag is not None for curve in bag.fcurves]

# SPDX-License-Identifier: Apache-2.0
"""More kinds of LF images with alpha, which were drawn for half D alone. They are made like those of alpha.py."""
import cv2
import numpy as np

from drawn_cards import srgb_of
from judgements.alpha import EITHER, HEIGHT, MASK, OVER_BLACK, OVER_WHITE, PREMULTIPLIED, WIDTH, joined, straight
from judgements.alpha_unseen import compressed, filtered_views, shadow_catcher, warped


def multiplied_shadow(drawing):
    """A black shadow around an object, in premultiplied colours."""
    pictures, _, _ = shadow_catcher(drawing)
    return [joined(picture[..., :3] * picture[..., 3:], picture[..., 3:]) for picture in pictures], "png", PREMULTIPLIED


def stabilised_video(drawing):
    """Frames were shifted by other amounts; borders became transparent and black."""
    return warped(drawing, [np.float64([[1, 0, x], [0, 1, y], [0, 0, 1]]) for x, y in
                            drawing.generator.uniform(-11, 11, (3, 2))])


def round_photographs(drawing):
    """Photographs in a circle, white outside."""
    x, y = np.meshgrid(np.linspace(-WIDTH / HEIGHT, WIDTH / HEIGHT, WIDTH), np.linspace(-1, 1, HEIGHT))
    inside = np.clip((0.97 - np.hypot(x, y)) * HEIGHT / 2, 0, 1)[..., None]
    return [joined(np.where(inside > 0, picture, 1), inside) for picture, _ in
            drawing.photographs()], "png", {**MASK, **OVER_WHITE}


def bust_on_a_turntable(drawing):
    """An object that touches the lower border, and has the same outline from all sides."""
    pictures = []
    for light, _ in drawing.views():
        x, y = np.meshgrid(np.linspace(-1.33, 1.33, WIDTH), np.linspace(-1, 1, HEIGHT))
        inside = (np.hypot(x, y + 0.3) < 0.4) | ((np.abs(x) < 0.2 + 0.5 * np.clip(y, 0, 1)) & (y > -0.2))
        soft = cv2.GaussianBlur(inside.astype(float), (0, 0), 0.6)[..., None]
        soft[soft < 0.01] = 0
        pictures.append(joined(np.where(soft > 0, srgb_of(light), 0), soft))
    return pictures, "png", OVER_BLACK


def lossy_alpha(drawing):
    """Alpha went through JPEG too, and is never quite 0 near outlines."""
    pictures = []
    for light, opacity in drawing.views():
        alpha = compressed(np.repeat(opacity, 3, -1), format="JPEG", quality=85)[..., :1]
        pictures.append(joined(np.where(opacity > 0, srgb_of(light), 0), alpha))
    return pictures, "png", OVER_BLACK


def faded_photographs(drawing):
    """Photographs fade out towards their borders; their colours were kept."""
    x, y = np.meshgrid(np.linspace(-1, 1, WIDTH), np.linspace(-1, 1, HEIGHT))
    fade = np.clip((1 - np.maximum(np.abs(x), np.abs(y))) * 6 - 0.3, 0, 1)[..., None]
    return [joined(picture, fade) for picture, _ in drawing.photographs()], "png", MASK


def filled_beneath(drawing):
    """Masked parts were filled smoothly beneath, as programs do that remove people."""
    pictures = []
    for picture, opacity in drawing.photographs():
        hidden = cv2.resize(opacity[..., 0], None, fx=0.4, fy=0.4) > 0.5
        mask = np.zeros((HEIGHT, WIDTH), bool)
        x, y = drawing.generator.integers(0, (WIDTH - hidden.shape[1], HEIGHT - hidden.shape[0]))
        mask[y:y + hidden.shape[0], x:x + hidden.shape[1]] = hidden
        pictures.append(joined(np.where(mask[..., None], cv2.GaussianBlur(picture, (0, 0), 12), picture),
                               ~mask[..., None]))
    return pictures, "png", MASK


def foliage(drawing):
    """A tree: leaves of some pixels, with gaps."""
    pictures = []
    leaves = drawing.generator.standard_normal((900, 2)) * 0.3
    for k, (light, _) in enumerate(drawing.views()):
        canvas = np.zeros((4 * HEIGHT, 4 * WIDTH), np.uint8)
        for x, y in leaves[np.hypot(*leaves.T) < 0.75]:
            at = int(4 * (WIDTH / 2 + 90 * x + 12 * (k - 1) + 4 * k * y)), int(4 * (HEIGHT / 2 + 90 * y))
            cv2.ellipse(canvas, at, (11, 6), float(999 * x), 0, 360, 255, -1)
        soft = canvas.reshape(HEIGHT, 4, WIDTH, 4).mean((1, 3))[..., None] / 255
        pictures.append(joined(np.where(soft > 0, srgb_of(light), 0), soft))
    return pictures, "png", OVER_BLACK


def multiplied_out_of_focus(drawing):
    return [joined(srgb_of(light * opacity), opacity) for light, opacity in
            filtered_views(drawing, 6)], "png", PREMULTIPLIED


def coarse_alpha(drawing):
    """Alpha has half the resolution of the colours, which are 0 outside."""
    pictures = []
    for light, opacity in drawing.views():
        small = cv2.resize(opacity[..., 0], (WIDTH // 2, HEIGHT // 2), interpolation=cv2.INTER_AREA)
        alpha = cv2.resize(small, (WIDTH, HEIGHT), interpolation=cv2.INTER_LINEAR)[..., None]
        pictures.append(joined(np.where(opacity > 0.5, srgb_of(light), 0), alpha))
    return pictures, "png", EITHER


def coal(drawing):
    return straight([(0.02 * light, opacity) for light, opacity in drawing.views()]), "png", OVER_BLACK


def two_objects(drawing):
    """Two objects of which one is small, over white, drawn by float files."""
    pictures = []
    for light, opacity in drawing.views():
        other = np.roll(cv2.resize(opacity[..., 0], None, fx=0.3, fy=0.3), 0)
        both = np.roll(opacity, -40, 1)
        both[110:110 + other.shape[0], 160:160 + other.shape[1], 0] = np.maximum(
            both[110:110 + other.shape[0], 160:160 + other.shape[1], 0], other)
        pictures.append(np.concatenate([np.where(both > 0, light, 1), both], -1))
    return pictures, "exr", OVER_WHITE


def wires(drawing):
    """Lines thinner than a pixel, over white."""
    pictures = []
    ends = drawing.generator.uniform(0.15, 0.85, (60, 4))
    for k, (light, _) in enumerate(drawing.views()):
        canvas = np.zeros((4 * HEIGHT, 4 * WIDTH), np.uint8)
        for a, b, c, d in ends:
            cv2.line(canvas, (int(4 * (WIDTH * a + 6 * k)), int(4 * HEIGHT * b)),
                     (int(4 * (WIDTH * c + 9 * k)), int(4 * HEIGHT * d)), 255, 2)
        soft = canvas.reshape(HEIGHT, 4, WIDTH, 4).mean((1, 3))[..., None] / 255
        pictures.append(joined(np.where(soft > 0, srgb_of(light), 1), soft))
    return pictures, "png", OVER_WHITE


KINDS = [
    multiplied_shadow, stabilised_video, round_photographs, bust_on_a_turntable, lossy_alpha, faded_photographs,
    filled_beneath, foliage, multiplied_out_of_focus, coarse_alpha, coal, two_objects, wires]

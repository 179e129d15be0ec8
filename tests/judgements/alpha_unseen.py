# SPDX-License-Identifier: Apache-2.0
"""More kinds of LF images with alpha, which were drawn when the thresholds were fixed. They are made like those of
alpha.py."""
import io

import cv2
import numpy as np
from PIL import Image

from drawn_cards import srgb_of
from judgements.alpha import (EITHER, FILTERS, HEIGHT, MASK, OVER_BLACK, OVER_WHITE, PREMULTIPLIED, WIDTH, each_band,
                              eight_bits, grown, joined, light_of, noise, straight)

LARGE = {"width": 2 * WIDTH, "height": 2 * HEIGHT, "finer": 2}


def over(colour):
    """Returns the answers for an object alone before a stored colour."""
    return {"straight": tuple(light_of(np.array(colour, float)))}


def compressed(picture, **options):
    """Returns RGBA or RGB values after lossy compression."""
    file = io.BytesIO()
    pixels = eight_bits(picture)
    Image.fromarray(pixels).save(file, **options)
    return np.asarray(Image.open(file).convert("RGBA" if pixels.shape[2] == 4 else "RGB")) / 255


def blurred(picture, sigma):
    soft = cv2.GaussianBlur(picture, (0, 0), sigma)
    return soft.reshape(picture.shape)


# Files and resampling

def lossy_webp(drawing):
    """The encoder also changes the colours of transparent pixels, block by block."""
    return [compressed(picture, format="WEBP", quality=80) for picture in straight(drawing.views())], "png", OVER_BLACK


def webp_of_photographs_with_masks(drawing):
    return [compressed(joined(picture, opacity > 0.5), format="WEBP", quality=90, exact=True)
            for picture, opacity in drawing.photographs()], "png", MASK


def jpeg_with_separate_alpha(drawing):
    """Colours were stored over black as JPEG, which rings beyond outlines; alpha was stored apart."""
    return [joined(compressed(srgb_of(light) * opacity, format="JPEG", quality=75), opacity) for light, opacity in
            drawing.views()], "png", PREMULTIPLIED


def quarter_size_each_band(drawing):
    pictures = [joined(np.where(opacity > 0.5, srgb_of(light), 0), opacity > 0.5) for light, opacity in
                drawing.views(width=4 * WIDTH, height=4 * HEIGHT, finer=1)]
    return [each_band(picture, 0.25, FILTERS["bicubic"]) for picture in pictures], "png", PREMULTIPLIED


def resized_twice(drawing):
    """Larger, then smaller, in each band."""
    pictures = [each_band(each_band(picture, 1.6, FILTERS["bicubic"]), 0.4, FILTERS["lanczos"]) for picture in
                straight(drawing.views(**LARGE), 1.0)]
    return pictures, "png", OVER_WHITE


def enlarged_pixels(drawing):
    """Three times larger without interpolation."""
    return [np.repeat(np.repeat(picture, 3, 0), 3, 1) for picture in straight(drawing.views())], "png", OVER_BLACK


def palette_with_transparency(drawing):
    """256 dithered colours, one of which is transparent and white, as in a GIF."""
    pictures = []
    for light, opacity in drawing.views():
        few = Image.fromarray(eight_bits(srgb_of(light))).quantize(255).convert("RGB")
        pictures.append(joined(np.where(opacity > 0.5, np.asarray(few) / 255, 1), opacity > 0.5))
    return pictures, "png", OVER_WHITE


def sixteen_bits_multiplied(drawing):
    return [joined(srgb_of(light * opacity), opacity) for light, opacity in drawing.views()], "png16", PREMULTIPLIED


def sixteen_bit_masks(drawing):
    return [joined(picture, blurred(opacity, 1.5)) for picture, opacity in drawing.photographs()], "png16", MASK


def grey_masked_photographs(drawing):
    return [joined(picture, opacity > 0.5)[..., [1, 3]] for picture, opacity in drawing.photographs()], "png", MASK


def floats_with_nan(drawing):
    """Light was divided by an alpha of 0."""
    return [np.concatenate([np.where(opacity > 0, light, np.nan), opacity], -1) for light, opacity in
            drawing.views()], "exr", OVER_BLACK


def ringing_floats(drawing):
    """Lanczos made small negative values beside outlines."""
    pictures = []
    for light, opacity in drawing.views(**LARGE):
        times = np.concatenate([light * opacity, opacity], -1).astype(np.float32)
        pictures.append(np.stack([np.asarray(Image.fromarray(band).resize((WIDTH, HEIGHT), Image.LANCZOS)) for band in
                                  np.moveaxis(times, -1, 0)], -1))
    return pictures, "exr", PREMULTIPLIED


# Renderers

def filtered_views(drawing, sigma):
    """Returns light and opacity after a wide filter of a renderer; light is 0 where nothing is."""
    pairs = []
    for light, opacity in drawing.views():
        wide = blurred(opacity, sigma)
        wide[wide < 1 / 1024] = 0
        pairs.append((np.where(wide > 0, blurred(light * opacity, sigma) / np.maximum(wide, 1e-9), 0), wide))
    return pairs


def wide_filter_straight(drawing):
    return [joined(srgb_of(light), opacity) for light, opacity in filtered_views(drawing, 1.2)], "png", OVER_BLACK


def wide_filter_multiplied(drawing):
    return [joined(srgb_of(light * opacity), opacity) for light, opacity in
            filtered_views(drawing, 1.2)], "png", PREMULTIPLIED


def out_of_focus(drawing):
    """Outlines are as soft as a lens makes them."""
    return [joined(srgb_of(light), opacity) for light, opacity in filtered_views(drawing, 6)], "png", OVER_BLACK


def shadow_catcher(drawing):
    """A black shadow, up to 60 % opaque, lies around the object."""
    pictures = []
    for light, opacity in drawing.views():
        shadow = 0.6 * blurred(np.roll(opacity, (14, 18), (0, 1)), 9)
        shadow[shadow < 1 / 255] = 0
        alpha = opacity + (1 - opacity) * shadow
        pictures.append(joined(srgb_of(light * opacity / np.maximum(alpha, 1e-9)), alpha))
    return pictures, "png", OVER_BLACK


def glass(drawing, stored=lambda light, alpha: joined(srgb_of(light), alpha)):
    """An opaque rim around tinted glass."""
    tint = light_of(drawing.generator.uniform(0.3, 0.9, 3))
    pictures = []
    for light, opacity in drawing.views():
        inside = cv2.erode((opacity > 0.99).astype(np.uint8), np.ones((13, 13)))[..., None] * opacity
        alpha = opacity * np.where(inside > 0, 0.35, 1)
        seen = np.where(inside > 0, 0.25 * light + 0.75 * tint, light)
        pictures.append(stored(np.where(alpha > 0, seen, 0), alpha))
    return pictures, "png", OVER_BLACK


def multiplied_glass(drawing):
    pictures, _, _ = glass(drawing, lambda light, alpha: np.concatenate([light * alpha, alpha], -1))
    return pictures, "exr", PREMULTIPLIED


def faint_figure(drawing):
    """Nothing is opaque: the object was faded to 60 %."""
    return [picture * (1, 1, 1, 0.6) for picture in straight(drawing.views())], "png", OVER_BLACK


def glow(drawing):
    """Light around the object has no alpha, as that of fire and lens flares."""
    pictures = []
    for light, opacity in drawing.views():
        shine = 0.4 * blurred(light * opacity, 14)
        pictures.append(np.concatenate([light * opacity + shine, opacity], -1))
    return pictures, "exr", PREMULTIPLIED


def hair_opacity(drawing):
    """Returns three pairs of light and opacity: strands thinner than a pixel around a head."""
    finer = 4
    wide, high = WIDTH * finer, HEIGHT * finer
    angles, lengths = drawing.generator.uniform(0, 2 * np.pi, 500), drawing.generator.uniform(0.25, 0.42, 500)
    bends = drawing.generator.uniform(-0.6, 0.6, 500)
    pairs = []
    texture = 0.05 + 0.5 * noise(drawing.generator, 2 * WIDTH, HEIGHT, 40)
    for k in range(3):
        canvas = np.zeros((high, wide), np.uint8)
        middle = np.array([wide / 2 + (k - 1) * 0.06 * wide, high / 2])
        cv2.circle(canvas, middle.astype(int).tolist(), int(0.2 * high), 255, -1)
        for angle, length, bend in zip(angles, lengths, bends):
            steps = np.linspace(0.15, length, 12)
            turned = angle + bend * steps / length
            line = middle + high * steps[:, None] * np.stack([np.cos(turned), np.sin(turned)], 1)
            cv2.polylines(canvas, [line.round().astype(np.int32)], False, 255, 1)
        opacity = canvas.reshape(HEIGHT, finer, WIDTH, finer).mean((1, 3))[..., None] / 255
        pairs.append((texture[:, WIDTH // 2 + 14 * (1 - k):][:, :WIDTH], opacity))
    return pairs


def hair(drawing):
    return straight(hair_opacity(drawing)), "png", OVER_BLACK


def multiplied_hair(drawing):
    return [joined(srgb_of(light * opacity), opacity) for light, opacity in hair_opacity(drawing)], "png", PREMULTIPLIED


def splats(drawing):
    """Hundreds of soft blobs, blended into premultiplied light."""
    count = 400
    places = np.clip(drawing.generator.standard_normal((count, 2)) * (0.16 * WIDTH, 0.15 * HEIGHT), -60, 60)
    sizes, colours = drawing.generator.uniform(2, 9, count), drawing.generator.uniform(0.02, 0.9, (count, 3))
    x, y = np.meshgrid(np.arange(WIDTH) - WIDTH / 2, np.arange(HEIGHT) - HEIGHT / 2)
    pictures = []
    for k in range(3):
        light, through = np.zeros((HEIGHT, WIDTH, 3)), np.ones((HEIGHT, WIDTH, 1))
        for place, size, colour in zip(places, sizes, colours):
            near = np.exp(-((x - place[0] - 14 * (k - 1)) ** 2 + (y - place[1]) ** 2) / (2 * size * size))
            alpha = np.where(near > 0.02, 0.9 * near, 0)[..., None]
            light += through * alpha * colour
            through *= 1 - alpha
        pictures.append(joined(srgb_of(light), 1 - through))
    return pictures, "png", PREMULTIPLIED


def points(drawing):
    """A point cloud that was drawn as single pixels."""
    pictures = []
    for light, opacity in drawing.views():
        seen = (opacity > 0.5) & (drawing.generator.random(opacity.shape) < 0.5)
        pictures.append(joined(np.where(seen, srgb_of(light), 0), seen))
    return pictures, "png", EITHER


def dithered_opacity(drawing):
    """Soft outlines were dithered to opaque and transparent pixels."""
    pictures = []
    for light, opacity in drawing.views():
        seen = blurred(opacity, 4) > drawing.generator.random(opacity.shape)
        pictures.append(joined(np.where(seen, srgb_of(light), 0), seen))
    return pictures, "png", EITHER


# Objects

def over_blue(drawing):
    blue = np.array([0.1, 0.2, 0.8])
    return straight(drawing.views(), blue), "png", over(blue)


def small_object(drawing):
    """The object covers hardly more than a hundredth of the image."""
    pictures = []
    for picture in straight(drawing.views()):
        small = each_band(picture, 0.14, FILTERS["box"])
        canvas = np.zeros((HEIGHT, WIDTH, 4))
        canvas[70:70 + small.shape[0], 90:90 + small.shape[1]] = small
        pictures.append(canvas)
    return pictures, "png", EITHER


def figure_from_top_to_bottom(drawing):
    """A statue on a turntable is cut off by the upper and the lower border."""
    pictures = []
    for k, (light, _) in enumerate(drawing.views()):
        x, y = np.meshgrid(np.linspace(-1.33, 1.33, WIDTH), np.linspace(-1, 1, HEIGHT))
        inside = np.abs(x - 0.12 * np.sin(3 * y + 1.5 * k)) < 0.45 + 0.15 * np.sin(4 * y + 2 * k)
        soft = cv2.GaussianBlur(inside.astype(float), (0, 0), 0.7)[..., None]
        soft[soft < 0.01] = 0
        pictures.append(joined(np.where(soft > 0, srgb_of(light), 0), soft))
    return pictures, "png", OVER_BLACK


def close_up(drawing):
    """The object leaves the image on two sides and above."""
    pictures = []
    for k, (light, _) in enumerate(drawing.views()):
        x, y = np.meshgrid(np.linspace(-1.33, 1.33, WIDTH), np.linspace(-1, 1, HEIGHT))
        height = 0.35 + 0.2 * np.sin(4 * x + 0.5 * k + drawing.scale) + 0.08 * np.sin(11 * x + k)
        soft = np.clip((height - y) * HEIGHT / 2, 0, 1)[..., None]
        pictures.append(joined(np.where(soft > 0, srgb_of(light), 0), soft))
    return pictures, "png", OVER_BLACK


def window_lattice(drawing):
    """An object that spans the image, with holes through which nothing is seen."""
    pictures = []
    for k, (light, _) in enumerate(drawing.views()):
        x, y = np.meshgrid(np.arange(WIDTH) - 11.5 * k, np.arange(HEIGHT))
        bars = np.maximum(np.clip(8.5 - np.abs(x % 58 - 29), 0, 1), np.clip(7.5 - np.abs(y % 60 - 30), 0, 1))
        soft = bars[..., None]
        pictures.append(joined(np.where(soft > 0, srgb_of(light), 0), soft))
    return pictures, "png", OVER_BLACK


# Photographs

def keyed_with_grey_matte(drawing):
    """Colours still hold the grey wall, also beneath soft edges."""
    grey = drawing.generator.uniform(0.35, 0.65)
    return [joined(picture, blurred(opacity, 1.2)) for picture, opacity in
            drawing.photographs(ground=grey, grain=0.004)], "png", {**MASK, **over([grey] * 3)}


def green_screen(drawing):
    """The screen was keyed, but its colour was kept; it is lit unevenly."""
    pictures = []
    for light, opacity in drawing.views():
        uneven = 0.6 + 0.25 * np.linspace(0, 1, WIDTH)[None, :, None]
        picture = opacity * srgb_of(light) + (1 - opacity) * uneven * np.array([0.15, 0.9, 0.25])
        pictures.append(joined(picture + 0.01 * drawing.generator.standard_normal(picture.shape), opacity))
    return pictures, "png", {**MASK, **over(np.array([0.15, 0.9, 0.25]) * 0.725)}


def product_on_white(drawing):
    """A photograph before pure white, with JPEG's rings, whose white was made transparent."""
    pictures = []
    for light, opacity in drawing.views():
        picture = compressed(opacity * srgb_of(light) + (1 - opacity), format="JPEG", quality=85)
        pictures.append(joined(picture, blurred(opacity, 0.6)))
    return pictures, "png", {**MASK, **OVER_WHITE}


def brush(drawing, opacity, strokes=40):
    """Returns a mask painted by hand with a round brush, roughly around an object."""
    mask = np.zeros((HEIGHT, WIDTH), np.uint8)
    y, x = np.nonzero(opacity[..., 0] > 0.5)
    for at in drawing.generator.integers(len(x), size=strokes).tolist():
        cv2.circle(mask, (int(x[at]), int(y[at])), int(drawing.generator.integers(14, 24)), 255, -1)
    return mask[..., None] > 0


def painted_masks(drawing):
    return [joined(picture, brush(drawing, opacity)) for picture, opacity in drawing.photographs()], "png", MASK


def segmented_masks(drawing):
    """Ragged edges of a network's coarse mask, with holes and islands; the photograph was kept."""
    return [joined(picture, ragged(drawing, opacity)) for picture, opacity in drawing.photographs()], "png", MASK


def segmented_objects(drawing):
    """Masks as those of segmented_masks(); everything else was set to 0."""
    pictures = []
    for picture, opacity in drawing.photographs():
        mask = ragged(drawing, opacity)
        pictures.append(joined(picture * mask, mask))
    return pictures, "png", EITHER


def ragged(drawing, opacity):
    coarse = cv2.resize(opacity[..., 0], (WIDTH // 4, HEIGHT // 4), interpolation=cv2.INTER_AREA)
    coarse = coarse + 0.28 * drawing.generator.standard_normal(coarse.shape) * (coarse > 0.02)
    return cv2.resize((coarse > 0.5).astype(np.uint8), (WIDTH, HEIGHT), interpolation=cv2.INTER_NEAREST)[..., None] > 0


def masked_blue_sky(drawing):
    """The sky, a smooth gradient, is masked above a skyline that moves."""
    pictures = []
    for k, (picture, _) in enumerate(drawing.photographs()):
        x, y = np.meshgrid(np.arange(WIDTH) + 9 * k, np.arange(HEIGHT))
        sky = (y < 70 + 18 * np.sin(x / 23) + 9 * np.sin(x / 7))[..., None]
        blue = np.array([0.25, 0.45, 0.8]) + 0.35 * (y / HEIGHT)[..., None] * np.array([1, 1, 0.5])
        pictures.append(joined(np.where(sky, blue, picture), ~sky))
    return pictures, "png", MASK


def removed_people(drawing):
    """Passers-by, in other places in each photograph, were set to 0; none is in the second."""
    pictures = []
    for k, (picture, _) in enumerate(drawing.photographs()):
        hidden = np.zeros((HEIGHT, WIDTH), np.uint8)
        for _ in range(0 if k == 1 else 3):
            x, y = int(drawing.generator.integers(20, WIDTH - 20)), int(drawing.generator.integers(70, 120))
            cv2.ellipse(hidden, (x, y), (9, 26), 0, 0, 360, 1, -1)
            cv2.circle(hidden, (x, y - 30), 7, 1, -1)
        seen = (hidden == 0)[..., None]
        pictures.append(joined(picture * seen, seen))
    return pictures, "png", MASK


def warped(drawing, matrices, filter=cv2.INTER_LINEAR):
    """Photographs that were warped, each in another way; what lies outside became transparent and black."""
    pictures = []
    for (picture, opacity), matrix in zip(drawing.photographs(), matrices):
        whole = joined(picture, np.ones_like(opacity)).astype(np.float32)
        pictures.append(np.clip(cv2.warpPerspective(whole, matrix, (WIDTH, HEIGHT), flags=filter), 0, 1))
    return pictures, "png", MASK


def levelled_photographs(drawing):
    """Each photograph was turned by a few degrees."""
    matrices = []
    for angle in drawing.generator.uniform(3, 8, 3) * drawing.generator.choice([-1, 1], 3):
        matrices.append(np.vstack([cv2.getRotationMatrix2D((WIDTH / 2, HEIGHT / 2), angle, 1), [0, 0, 1]]))
    return warped(drawing, matrices)


def rectified_photographs(drawing):
    """Each photograph was rectified by another homography."""
    corners = np.float32([[0, 0], [WIDTH, 0], [WIDTH, HEIGHT], [0, HEIGHT]])
    matrices = []
    for _ in range(3):
        moved = corners + drawing.generator.uniform(2, 26, (4, 2)) * np.sign(np.float32([WIDTH, HEIGHT]) / 2 - corners)
        matrices.append(cv2.getPerspectiveTransform(corners, moved.astype(np.float32)))
    return warped(drawing, matrices, cv2.INTER_CUBIC)


def undistorted_with_soft_borders(drawing):
    """Bilinear interpolation made the border of undistortion soft, the same in all images."""
    x, y = np.meshgrid(np.linspace(-1, 1, WIDTH), np.linspace(-1, 1, HEIGHT))
    curve = drawing.generator.uniform(0.03, 0.08)
    maps = [np.float32((c * (1 + curve * (x * x + y * y)) + 1) / 2 * n - 0.5) for c, n in ((x, WIDTH), (y, HEIGHT))]
    pictures = [np.clip(cv2.remap(joined(picture, np.ones_like(opacity)).astype(np.float32), *maps, cv2.INTER_LINEAR),
                        0, 1) for picture, opacity in drawing.photographs()]
    return pictures, "png", MASK


def outlines_drawn_by_hand(drawing):
    """Objects cut out with a margin of their surroundings of a few pixels; the rest was made white."""
    pictures = []
    for picture, opacity in drawing.photographs():
        near = grown(opacity[..., 0] > 0.5, 5)[..., None]
        pictures.append(joined(np.where(near, picture, 1), near))
    return pictures, "png", {**MASK, **OVER_WHITE}


KINDS = [
    lossy_webp, webp_of_photographs_with_masks, jpeg_with_separate_alpha, quarter_size_each_band, resized_twice,
    enlarged_pixels, palette_with_transparency, sixteen_bits_multiplied, sixteen_bit_masks, grey_masked_photographs,
    floats_with_nan, ringing_floats, wide_filter_straight, wide_filter_multiplied, out_of_focus, shadow_catcher, glass,
    multiplied_glass, faint_figure, glow, hair, multiplied_hair, splats, points, dithered_opacity, over_blue,
    small_object, figure_from_top_to_bottom, close_up, window_lattice, keyed_with_grey_matte, green_screen,
    product_on_white, painted_masks, segmented_masks, segmented_objects, masked_blue_sky, removed_people,
    levelled_photographs, rectified_photographs, undistorted_with_soft_borders, outlines_drawn_by_hand]

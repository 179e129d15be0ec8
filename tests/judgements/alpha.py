# SPDX-License-Identifier: Apache-2.0
"""Draws LF images with alpha as people have them: objects that were cut out or rendered alone, and photographs of which
parts are masked; resampled by filters that know alpha and by filters that do not.

A kind is a function of (Drawing) -> (list of RGBA pictures, suffix, answers). Pictures have stored values from 0 to 1;
for EXR files they hold light. Answers are the meanings of alpha that are right, with their backgrounds.
"""
import cv2
import numpy as np
from PIL import Image

from drawn_cards import srgb_of
from judgements.captures import NOT_SURE, RIGHT, WRONG, pose, write_transforms

WIDTH, HEIGHT, FINER = 240, 180, 4
FILTERS = {"box": Image.BOX, "bilinear": Image.BILINEAR, "bicubic": Image.BICUBIC, "lanczos": Image.LANCZOS}
BLACK, WHITE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)


def light_of(srgb):
    return np.where(srgb <= 0.04045, srgb / 12.92, ((np.maximum(srgb, 0) + 0.055) / 1.055) ** 2.4)


def noise(generator, width, height, cells):
    """Returns smooth noise from 0 to 1, [height][width][3], with details of width / cells pixels and of a fifth of
    that."""
    total = np.zeros((height, width, 3))
    for factor, share in ((1, 0.6), (5, 0.4)):
        grid = generator.random((max(2, cells * factor * height // width), cells * factor, 3)).astype(np.float32)
        total += share * cv2.resize(grid, (width, height), interpolation=cv2.INTER_CUBIC)
    return np.clip(total, 0, 1)


class Drawing:
    """An object in front of nothing, and a photograph, as three LF cameras see them."""

    def __init__(self, seed):
        self.generator = np.random.default_rng(seed)
        self.filter = FILTERS[list(FILTERS)[seed % 4]]
        self.scale = (0.5, 0.37, 0.75)[seed % 3]

    def views(self, shape="blob", width=WIDTH, height=HEIGHT, finer=FINER):
        """Returns three pairs of the object's light (not multiplied) and its exact opacity."""
        wide, high = width * finer, height * finer
        texture = 0.04 + 0.9 * noise(self.generator, 2 * wide, high, 24) ** 1.5
        turn = self.generator.random() * 3
        pairs = []
        for k in range(3):
            shift = int((k - 1) * 0.06 * wide)
            x, y = np.meshgrid(np.linspace(-1.33, 1.33, wide) - 2.66 * shift / wide, np.linspace(-1, 1, high))
            if shape == "vase":  # stands on the axis of the turntable and looks alike from all sides
                x = x + 2.66 * shift / wide
                inside = np.abs(x) < 0.35 + 0.12 * np.sin(5 * y + turn)
                inside &= np.abs(y) < 0.8
            elif shape == "bars":
                inside = (np.abs(((x * 1.2 + 0.5 * y + turn) % 0.4) - 0.2) < 0.03 + 0.02 * k) & (np.hypot(x, y) < 0.9)
            elif shape == "large":  # only the corners are empty
                inside = np.hypot((x - 0.1 * k) / 1.5, y / 1.25) < 1
            else:
                radius = 0.55 + 0.12 * np.sin(5 * np.arctan2(y, x) + turn) + 0.05 * np.sin(17 * np.arctan2(y, x))
                inside = (np.hypot(x, y) < radius) & (np.hypot(x - 0.1, y - 0.05) > 0.12)
            light = texture[:, wide // 2 - shift:wide // 2 - shift + wide]
            opacity = inside.astype(float)[..., None]
            if finer > 1:
                def mean(picture):
                    return picture.reshape(height, finer, width, finer, -1).mean((1, 3))
                covered = mean(light * opacity)
                opacity = mean(opacity)
                light = np.where(opacity > 0, covered / np.maximum(opacity, 1e-9), mean(light))
            pairs.append((light, opacity))
        return pairs

    def photographs(self, blur=0.0, ground=None, grain=0.008):
        """Returns three photographs (stored values): the object before a room. `blur` of the room is in pixels;
        `ground` is its stored value if it has one colour."""
        room = srgb_of(0.03 + 0.8 * noise(self.generator, 2 * WIDTH, HEIGHT, 30) ** 2)
        if blur:
            room = cv2.GaussianBlur(room, (0, 0), blur)
        pictures = []
        for k, (light, opacity) in enumerate(self.views()):
            shift = WIDTH // 2 - 9 * k
            behind = room[:, shift:shift + WIDTH] if ground is None else np.full_like(light, ground)
            picture = opacity * srgb_of(light) + (1 - opacity) * behind
            pictures.append((np.clip(picture + grain * self.generator.standard_normal(picture.shape), 0, 1), opacity))
        return pictures


def joined(colours, alpha):
    return np.concatenate([np.clip(colours, 0, 1), np.clip(alpha, 0, 1)], -1)


def eight_bits(picture):
    return (np.clip(picture, 0, 1) * 255).round().astype(np.uint8)


def each_band(picture, scale, filter):
    """Resamples colours and alpha alike, as `ffmpeg -vf scale` does."""
    size = [max(2, round(scale * n)) for n in picture.shape[1::-1]]
    return np.stack([np.asarray(Image.fromarray(band).resize(size, filter)) for band in
                     np.moveaxis(eight_bits(picture), -1, 0)], -1) / 255


def with_alpha(picture, scale, filter, keeps_colours=False):
    """Resamples colours times alpha, and divides by alpha, as Pillow does. keeps_colours: colours stay where alpha has
    become 0, as in ImageMagick's ringing."""
    size = [max(2, round(scale * n)) for n in picture.shape[1::-1]]
    if not keeps_colours:
        return np.asarray(Image.fromarray(eight_bits(picture), "RGBA").resize(size, filter)) / 255
    times = np.concatenate([picture[..., :3] * picture[..., 3:], picture[..., 3:]], -1).astype(np.float32)
    bands = [np.asarray(Image.fromarray(band).resize(size, filter)) for band in np.moveaxis(times, -1, 0)]
    alpha = bands[3][..., None]
    colours = np.stack(bands[:3], -1) / np.where(np.abs(alpha) < 1e-4, np.inf, alpha)
    return eight_bits(joined(colours, alpha)) / 255


def straight(views, beneath=0.0):
    return [joined(np.where(opacity > 0, srgb_of(light), beneath), opacity) for light, opacity in views]


def grown(mask, pixels):
    return cv2.dilate(mask.astype(np.uint8), np.ones((2 * pixels + 1,) * 2)) > 0


OVER_BLACK, OVER_WHITE = {"straight": BLACK}, {"straight": WHITE}
PREMULTIPLIED = {"premultiplied": BLACK}
EITHER = {**OVER_BLACK, **PREMULTIPLIED}
MASK = {"mask": None}


def cut_out_over_black(drawing):
    return straight(drawing.views()), "png", OVER_BLACK


def cut_out_over_white(drawing):
    return straight(drawing.views(), 1.0), "png", OVER_WHITE


def thin_bars(drawing):
    return straight(drawing.views("bars")), "png", OVER_BLACK


def object_that_fills_the_image(drawing):
    beneath = int(drawing.generator.integers(2))
    return straight(drawing.views("large"), beneath), "png", OVER_WHITE if beneath else OVER_BLACK


def outlines_of_a_renderer(drawing):
    """Alpha that rounds to 0 keeps the colour of the object, two pixels around the outline."""
    pictures = []
    for light, opacity in drawing.views():
        near = grown(opacity[..., 0] > 0, 2)[..., None]
        pictures.append(joined(np.where(near, srgb_of(light), 0), opacity))
    return pictures, "png", OVER_BLACK


def hard_edges(drawing):
    return [joined(np.where(opacity > 0.5, srgb_of(light), 0), opacity > 0.5) for light, opacity in
            drawing.views()], "png", EITHER


def smaller_each_band_over_black(drawing):
    """A filter that multiplies hard edges over black by its weights makes premultiplied colours."""
    pictures = [each_band(picture, drawing.scale, drawing.filter) for picture in
                [joined(np.where(opacity > 0.5, srgb_of(light), 0), opacity > 0.5)
                 for light, opacity in drawing.views(width=2 * WIDTH, height=2 * HEIGHT, finer=2)]]
    return pictures, "png", PREMULTIPLIED


def smaller_each_band_over_white(drawing):
    pictures = [each_band(picture, drawing.scale, drawing.filter) for picture in
                straight(drawing.views(width=2 * WIDTH, height=2 * HEIGHT, finer=2), 1.0)]
    return pictures, "png", OVER_WHITE


def larger_each_band(drawing):
    pictures = [each_band(picture, 1.7, drawing.filter) for picture in straight(drawing.views())]
    return pictures, "png", EITHER


def smaller_with_alpha(drawing):
    pictures = [with_alpha(picture, drawing.scale, drawing.filter) for picture in
                straight(drawing.views(width=2 * WIDTH, height=2 * HEIGHT, finer=2))]
    return pictures, "png", OVER_BLACK


def smaller_with_ringing(drawing):
    pictures = [with_alpha(picture, drawing.scale, Image.LANCZOS, keeps_colours=True) for picture in
                straight(drawing.views(width=2 * WIDTH, height=2 * HEIGHT, finer=2))]
    return pictures, "png", OVER_BLACK


def floats_of_a_renderer(drawing):
    return [np.concatenate([light * opacity, opacity], -1) for light, opacity in drawing.views()], "exr", PREMULTIPLIED


def straight_floats(drawing):
    return [np.concatenate([light * (opacity > 0), opacity], -1) for light, opacity in
            drawing.views()], "exr", OVER_BLACK


def pasted_on_nothing(drawing):
    """Stored colours times alpha, as rembg and other cut-out programs leave them."""
    return [joined(srgb_of(light) * opacity, opacity) for light, opacity in drawing.views()], "png", PREMULTIPLIED


def multiplied_light(drawing):
    return [joined(srgb_of(light * opacity), opacity) for light, opacity in drawing.views()], "png", PREMULTIPLIED


def sixteen_bits(drawing):
    return straight(drawing.views()), "png16", OVER_BLACK


def grey_with_alpha(drawing):
    return [picture[..., [0, 3]] for picture in straight(drawing.views(), 1.0)], "png", OVER_WHITE


def lossy_values(drawing):
    """Colours and alpha are off by up to two values, as after lossy compression."""
    pictures = [np.clip(picture + drawing.generator.integers(-2, 3, picture.shape) / 255, 0, 1) for picture in
                straight(drawing.views())]
    return pictures, "png", OVER_BLACK


def invented_colours(drawing):
    """Transparent pixels have the colour of the nearest opaque ones, as textures for games do."""
    pictures = []
    for light, opacity in drawing.views():
        colours = srgb_of(light)
        seen = opacity[..., 0] > 0.5
        _, labels = cv2.distanceTransformWithLabels((~seen).astype(np.uint8), cv2.DIST_L2, 5,
                                                    labelType=cv2.DIST_LABEL_PIXEL)
        of_label = np.zeros((labels.max() + 1, 3))
        of_label[labels[seen]] = colours[seen]
        pictures.append(joined(np.where(seen[..., None], colours, of_label[labels]), opacity))
    return pictures, "png", OVER_BLACK


def vase_on_a_turntable(drawing):
    return straight(drawing.views("vase")), "png", OVER_BLACK


def masked_photographs(drawing):
    return [joined(picture, opacity > 0.5) for picture, opacity in drawing.photographs()], "png", MASK


def feathered_masks(drawing):
    return [joined(picture, cv2.GaussianBlur(opacity, (0, 0), 2)[..., None]) for picture, opacity in
            drawing.photographs()], "png", MASK


def smaller_masked_photographs(drawing):
    return [each_band(joined(picture, opacity > 0.5), drawing.scale, drawing.filter) for picture, opacity in
            drawing.photographs()], "png", MASK


def masked_blurred_rooms(drawing):
    return [joined(picture, opacity > 0.5) for picture, opacity in drawing.photographs(blur=6)], "png", MASK


def masked_studio(drawing):
    """The wall of a studio has one colour, but for its noise."""
    grey = drawing.generator.uniform(0.4, 0.7)
    over_grey = {"straight": tuple([float(light_of(np.array(grey)))] * 3)}
    return [joined(picture, opacity > 0.5) for picture, opacity in
            drawing.photographs(ground=grey, grain=0.012)], "png", {**MASK, **over_grey}


def masked_white_sky(drawing):
    """Two thirds of what is masked are white."""
    pictures = []
    for picture, opacity in drawing.photographs():
        sky = np.arange(HEIGHT)[:, None, None] < 0.7 * HEIGHT
        pictures.append(joined(np.where(sky & (opacity < 0.5), 1, picture), opacity > 0.5))
    return pictures, "png", MASK


def masked_spots(drawing):
    """Dust and passers-by are masked, in different places."""
    pictures = []
    for picture, _ in drawing.photographs():
        alpha = np.ones((HEIGHT, WIDTH), np.uint8)
        for x, y, r in drawing.generator.integers((0, 0, 3), (WIDTH, HEIGHT, 14), (12, 3)).tolist():
            cv2.circle(alpha, (x, y), r, 0, -1)
        pictures.append(joined(picture, alpha[..., None]))
    return pictures, "png", MASK


def bordered(drawing, filter=None, beneath=0.0):
    x, y = np.meshgrid(np.linspace(-1, 1, WIDTH), np.linspace(-1, 1, HEIGHT))
    strength = drawing.generator.uniform(0.05, 0.12)
    inside = (np.abs(x) < 1.02 - strength * y * y) & (np.abs(y) < 1.02 - strength * x * x)
    pictures = [joined(np.where(inside[..., None], picture, beneath), inside[..., None]) for picture, _ in
                drawing.photographs()]
    return [each_band(picture, drawing.scale, filter) for picture in pictures] if filter else pictures


def borders_of_undistortion(drawing):
    return bordered(drawing), "png", MASK


def white_borders(drawing):
    return bordered(drawing, beneath=1.0), "png", MASK


def smaller_borders(drawing):
    return bordered(drawing, drawing.filter), "png", MASK


def fish_eyes(drawing):
    x, y = np.meshgrid(np.linspace(-WIDTH / HEIGHT, WIDTH / HEIGHT, WIDTH), np.linspace(-1, 1, HEIGHT))
    inside = (np.hypot(x, y) < drawing.generator.uniform(1.0, 1.2))[..., None]
    return [joined(picture * inside, inside) for picture, _ in drawing.photographs()], "png", MASK


KINDS = [
    cut_out_over_black, cut_out_over_white, thin_bars, object_that_fills_the_image, outlines_of_a_renderer, hard_edges,
    smaller_each_band_over_black, smaller_each_band_over_white, larger_each_band, smaller_with_alpha,
    smaller_with_ringing, floats_of_a_renderer, straight_floats, pasted_on_nothing, multiplied_light, sixteen_bits,
    grey_with_alpha, lossy_values, invented_colours, vase_on_a_turntable, masked_photographs, feathered_masks,
    smaller_masked_photographs, masked_blurred_rooms, masked_studio, masked_white_sky, masked_spots,
    borders_of_undistortion, white_borders, smaller_borders, fish_eyes]


def write_picture(file, picture, suffix):
    if suffix == "exr":
        cv2.imwrite(str(file.with_suffix(".exr")), picture[..., [2, 1, 0, 3]].astype(np.float32))
    elif suffix == "png16":
        cv2.imwrite(str(file.with_suffix(".png")), (picture[..., [2, 1, 0, 3]] * 65535).round().astype(np.uint16))
    else:
        mode = "LA" if picture.shape[2] == 2 else "RGBA"
        Image.fromarray(eight_bits(picture), mode).save(file.with_suffix(".png"))


def draw(folder, kind, seed):
    """Writes three LF images. Returns the right answers."""
    pictures, suffix, answers = kind(Drawing(seed))
    folder.mkdir()
    frames = []
    for number, picture in enumerate(pictures):
        write_picture(folder / str(number), picture, suffix)
        frames.append({"file_path": next(folder.glob(f"{number}.*")).name,
                       "transform_matrix": pose(0.1 * number, 0)})
    height, width = pictures[0].shape[:2]
    write_transforms(folder, frames, fl_x=width, w=width, h=height)
    return answers


def judge(report, said, answers):
    """Returns the verdict about what lfimport --json reported and said."""
    if "not sure what alpha means" in said:
        return NOT_SURE
    alpha = report["alpha"] or {}
    if alpha.get("meaning") not in answers:
        return WRONG
    expected = answers[alpha["meaning"]]
    near = expected is None or np.allclose(alpha["background"], expected, atol=0.02)
    return RIGHT if near else WRONG

# SPDX-License-Identifier: Apache-2.0
"""Prediction between the LF images of a group, for prediction_gain.py.

One LF image of a group, the key image, is coded by itself. Each other one is predicted from up to four that are decoded
before it: a block has the number of an inverse depth and a mode, the mean of the references or one of them, and the
rest is coded as an LF image is. The plane at this depth, parallel to the image, leads to the pixels of the references.
"""
import dataclasses
import itertools

import cv2
import numpy as np

import prediction_model as model
from prediction_captures import warped

CELL = 4  # blocks for which errors are kept; larger blocks have the sums of several
FRACTIONS = 64  # of a pixel: positions in references are rounded to them


@dataclasses.dataclass(frozen=True)
class Way:
    """One way to predict. The defaults are those of the tables of doc/codec.md."""
    block: int = 8  # in pixels of the LF image
    references: int = 3
    depths: int = 64  # number of inverse depths, at equal distances
    modes: str = "mean or one"  # of the references; or mean, weighted (by distance), any (mean of any of them)
    overlap: str = "half"  # windows of neighbouring blocks: none, half, full; or depths (interpolated between blocks)
    taps: str = "cubic -0.75"  # or cubic -0.5, linear, lanczos 6, lanczos 8
    smoothness: float = 1.0  # weight of a bit of side information, in steps
    steps: tuple = (0.6, 0.8, 1.1)  # of the key image, of other references, and of leaves
    key: str = "corner"  # or middle
    leaves: str = "unused"  # as references: LF images between neighbours, which are the last; or used
    shared: bool = False  # one map of depths for the group instead of one for each LF image
    closed: bool = False  # depths are searched in decoded references instead of the originals
    rounded: bool = True  # predictions are rounded to whole grey steps


def order_of(capture, key):
    """Returns the numbers of the LF images: the key image, then each time the one that is farthest from all before."""
    centres = capture.centres()
    from_middle = np.linalg.norm(centres - centres.mean(0), axis=1)
    order = [int(np.argmin(np.round(from_middle, 9)) if key == "middle" else np.argmax(np.round(from_middle, 9)))]
    while len(order) < len(centres):
        nearest = np.linalg.norm(centres[:, None] - centres[order], axis=2).min(1)
        order.append(int(np.argmax(np.round(nearest, 9))))
    return order


def leaves_of(capture, order):
    """Returns the numbers of the LF images that are about as near to one before them as any LF images are."""
    centres = capture.centres()
    distances = [np.linalg.norm(centres[order[:place]] - centres[number], axis=1).min()
                 for place, number in enumerate(order) if place]
    return {number for number, distance in zip(order[1:], distances) if distance < 1.2 * min(distances)}


def references_of(capture, number, done, most):
    """Returns (number, distance) of the nearest decoded LF image of each quadrant, the nearest first. Those that are
    more than three times as far as the nearest are left out."""
    centres = capture.centres() @ capture.rotations[done[0]].T
    best = {}
    for other in done:
        across, down = (centres[other] - centres[number])[:2]
        quadrant = int((np.degrees(np.arctan2(down, across)) + 405) % 360 // 90)
        distance = float(np.hypot(across, down))
        if quadrant not in best or distance < best[quadrant][0]:
            best[quadrant] = distance, other
    near = sorted(best.values())[:most]
    return [(other, distance) for distance, other in near if distance <= 3 * near[0][0]]


def inverse_depths_of(capture, count):
    return np.linspace(*capture.inverse_depths, count)


class Search:
    """Errors of all inverse depths and modes, for each cell of an LF image."""

    def __init__(self, capture):
        self.capture = capture
        self.kept, self.seen = {}, {}

    def errors(self, number, references, pictures, depths, modes, scale):
        """Returns [depth][mode][rows of cells][columns of cells]; modes: the combination, then each reference."""
        is_open = pictures is self.capture.pictures
        key = number, tuple(references), depths, modes, scale
        if is_open and key in self.kept:
            return self.kept[key]
        target = model.luma_of(self.capture.pictures[number])
        shares = shares_of(references, modes)
        cell = CELL // scale
        rows, columns = (n // cell for n in target.shape)
        sums = lambda error: cell * cell * cv2.resize(np.abs(error), (columns, rows), interpolation=cv2.INTER_AREA)
        errors = np.empty((depths, len(shares), rows, columns), np.float32)
        every = [self.views(number, other, pictures, depths) for other, _ in references]
        for i in range(depths):
            seen = [views[i] for views in every]
            for mode, of_references in enumerate(shares):
                errors[i, mode] = sums(target - sum(w * s for w, s in zip(of_references, seen) if w))
        if is_open:
            self.kept[key] = errors
        return errors

    def views(self, number, other, pictures, depths):
        """Returns the brightness of a reference as an LF image sees it at each inverse depth."""
        is_open = pictures is self.capture.pictures
        if is_open and (number, other, depths) in self.seen:
            return self.seen[number, other, depths]
        luma, (a, b) = model.luma_of(pictures[other]), self.capture.homography(number, other)
        views = [warped(luma, a + np.outer(b, (0, 0, depth)), cv2.INTER_CUBIC)
                 for depth in inverse_depths_of(self.capture, depths)]
        if is_open and depths == Way.depths:
            self.seen[number, other, depths] = views
        return views


def shares_of(references, modes):
    """Returns the shares of the references in a block: [mode][reference]."""
    count = len(references)
    sets = [(1,) * count]
    if modes == "weighted":
        sets = [[1 / distance for _, distance in references]]
    elif modes == "mean or one" and count > 1:
        sets += np.eye(count).tolist()
    elif modes == "any":
        sets = sorted(itertools.product((0, 1), repeat=count), key=sum, reverse=True)[:-1]
    return np.float32([np.divide(one, sum(one)) for one in sets])


def in_blocks(errors, cells):
    """Returns the sums of squares of `cells` x `cells` cells; the last blocks may have fewer."""
    rows, columns = errors.shape[2:]
    errors = np.pad(errors, ((0, 0), (0, 0), (0, -rows % cells), (0, -columns % cells)))
    shape = errors.shape
    return errors.reshape(shape[:2] + (shape[2] // cells, cells, shape[3] // cells, cells)).sum((3, 5))


def chosen(errors, rate):
    """Returns (depth, mode) [rows][columns] of least error and side information, by iterated conditional modes: the
    blocks of each colour of a chess board in turn.

    rate  error that a bit is worth
    """
    count, modes, rows, columns = errors.shape
    best = errors.reshape(count * modes, rows, columns).argmin(0)
    depth, mode = best // modes, best % modes
    if rate == 0:
        return depth, mode
    change = np.abs(np.arange(count)[:, None] - np.arange(count))
    depth_bits = np.minimum(2 * np.log2(1 + change), 7).astype(np.float32)
    mode_bits = 1.5 * (1 - np.eye(modes, dtype=np.float32))
    colour = np.add.outer(np.arange(rows), np.arange(columns)) % 2
    for sweep in range(6):
        at = np.nonzero(colour == sweep % 2)
        of_depths, of_modes = np.zeros((count, len(at[0])), np.float32), np.zeros((modes, len(at[0])), np.float32)
        for down, across in ((-1, 0), (1, 0), (0, -1), (0, 1)):
            y, x = at[0] + down, at[1] + across
            inside = (y >= 0) & (y < rows) & (x >= 0) & (x < columns)
            y, x = np.clip(y, 0, rows - 1), np.clip(x, 0, columns - 1)
            of_depths += depth_bits[:, depth[y, x]] * inside
            of_modes += mode_bits[:, mode[y, x]] * inside
        total = errors[:, :, at[0], at[1]] + rate / 2 * (of_depths[:, None] + of_modes[None])
        best = total.reshape(count * modes, -1).argmin(0)
        depth[at], mode[at] = best // modes, best % modes
    return depth, mode


# Kernels of four to eight taps: weight of a sample at the distance x.
def _cubic(x, a):
    x = np.abs(x)
    return np.where(x < 1, (a + 2) * x ** 3 - (a + 3) * x ** 2 + 1,
                    np.where(x < 2, a * (x ** 3 - 5 * x ** 2 + 8 * x - 4), 0))


KERNELS = {"linear": (2, lambda x: np.maximum(1 - np.abs(x), 0)),
           "cubic -0.5": (4, lambda x: _cubic(x, -0.5)),
           "cubic -0.6": (4, lambda x: _cubic(x, -0.6)),
           "cubic -0.75": (4, lambda x: _cubic(x, -0.75)),
           "lanczos 6": (6, lambda x: np.where(np.abs(x) < 3, np.sinc(x) * np.sinc(x / 3), 0)),
           "lanczos 8": (8, lambda x: np.where(np.abs(x) < 4, np.sinc(x) * np.sinc(x / 4), 0))}
_OPENCV = {"cubic -0.75": cv2.INTER_CUBIC, "lanczos 8": cv2.INTER_LANCZOS4, "linear": cv2.INTER_LINEAR}


def sampled(picture, x, y, taps):
    """Returns the picture at positions in pixels, (0, 0) being the centre of the first pixel."""
    if taps in _OPENCV:
        return cv2.remap(picture, x.astype(np.float32), y.astype(np.float32), _OPENCV[taps],
                         borderMode=cv2.BORDER_REPLICATE)
    count, kernel = KERNELS[taps]
    offsets = np.arange(count) - count // 2 + 1
    table = kernel(np.arange(FRACTIONS)[:, None] / FRACTIONS - offsets).astype(np.float32)
    table /= table.sum(1, keepdims=True)
    x, y = (np.floor(value * FRACTIONS + 0.5).astype(np.int32) for value in (x, y))
    height, width, channels = picture.shape
    flat = picture.reshape(-1, channels)
    total = np.zeros(x.shape + (channels,), np.float32)
    of_x = [(np.clip(x // FRACTIONS + offset, 0, width - 1), table[x % FRACTIONS, i])
            for i, offset in enumerate(offsets)]
    for j, offset in enumerate(offsets):
        row = np.clip(y // FRACTIONS + offset, 0, height - 1) * width
        line = sum(weight[..., None] * flat[row + column] for column, weight in of_x)
        total += table[y % FRACTIONS, j][..., None] * line
    return total


def windows(length, block, count, overlap):
    """Returns [(number of the block, weight)] of the blocks that each position along an axis is predicted by."""
    at = (np.arange(length) + 0.5) / block - 0.5
    if overlap == "none":
        return [(np.clip(np.floor(at + 0.5).astype(int), 0, count - 1), np.ones(length, np.float32))]
    first = np.floor(at).astype(int)
    share = at - first
    if overlap == "half":
        share = np.clip(2 * share - 0.5, 0, 1)
    return [(np.clip(first + k, 0, count - 1), (share if k else 1 - share).astype(np.float32)) for k in (0, 1)]


def predicted(capture, number, references, decoded, depth, mode, way, block):
    """Returns the prediction of an LF image from the blocks' depths (not their numbers) and modes."""
    height, width, channels = capture.pictures[number].shape
    rows, columns = depth.shape
    grid = np.stack(np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5) + [np.ones((height, width))], -1)
    usage = shares_of(references, way.modes)
    homographies = [capture.homography(number, other) for other, _ in references]
    bases = [grid @ a.T for a, _ in homographies]
    total = np.zeros((height, width, channels), np.float32)
    parts = [(y, x) for y in windows(height, block, rows, "full" if way.overlap == "depths" else way.overlap)
             for x in windows(width, block, columns, "full" if way.overlap == "depths" else way.overlap)]
    fields = [(depth[y[0][:, None], x[0]], mode[y[0][:, None], x[0]], y[1][:, None] * x[1]) for y, x in parts]
    if way.overlap == "depths":  # one position of each reference, and the shares of the references are interpolated
        smooth = sum(d * w for d, _, w in fields)
        fields = [(smooth, None, [sum(usage[m, k] * w for _, m, w in fields) for k in range(len(references))])]
    for d, m, window in fields:
        for k, (other, _) in enumerate(references):
            share = window[k] if m is None else usage[m, k] * window
            if not share.any():
                continue
            position = bases[k] + d[..., None] * homographies[k][1]
            x, y = (position[..., i] / position[..., 2] - 0.5 for i in (0, 1))
            total += share[..., None] * sampled(decoded[other], x, y, way.taps)
    return np.rint(total) if way.rounded else total


def side_bits(maps, modes):
    """Returns the bits of the depths' numbers and of the modes of a group: differences to the median of the neighbours
    that are known, in contexts of how much these differ; modes in the contexts of those to the left and above."""
    symbols, contexts, of_modes, mode_contexts, raw = [], [], [], [], 0.0
    for depth, mode in maps:
        padded = np.pad(depth, ((1, 0), (1, 1)), mode="edge")
        left, above, right = padded[1:, :-2], padded[:-1, 1:-1], padded[:-1, 2:]
        guess = np.median([left, above, right], axis=0).astype(int)
        symbol = depth - guess
        numbers = ((symbol << 1) ^ (symbol >> 31)).ravel()
        tokens, more = model.tokens_of(numbers, 8)
        raw += more.sum()
        symbols.append(tokens)
        contexts.append(np.digitize(np.abs(left - above) + np.abs(right - above), (1, 3, 8)).ravel())
        padded = np.pad(mode, ((1, 0), (1, 0)))
        of_modes.append(mode.ravel())
        mode_contexts.append((padded[1:, :-1] * modes + padded[:-1, 1:]).ravel())
    if not symbols:
        return 0.0, 0.0
    depths = sum(model.counted_bits(np.concatenate(contexts), np.concatenate(symbols), 4, 40)) + raw
    if modes == 1:
        return float(depths), 0.0
    return float(depths), sum(model.counted_bits(np.concatenate(mode_contexts), np.concatenate(of_modes),
                                                 modes * modes, modes))


class Group:
    """Codes a capture by one way; keeps the errors of the search for others."""

    def __init__(self, capture):
        self.capture, self.search = capture, Search(capture)
        self.scale = 2 if capture.pictures[0].shape[-1] == 4 else 1

    def code(self, threshold, way, kept=None):
        """Returns a dictionary: bytes [packed, contexts] with side information, decoded pictures, and more.

        threshold  None for lossless
        kept       a list that gets the packets of each LF image, in the order of coding
        """
        capture, order = self.capture, order_of(self.capture, way.key)
        unused = leaves_of(capture, order) if way.leaves == "unused" else set()
        links = {number: references_of(capture, number, [n for n in order[:place] if n not in unused], way.references)
                 for place, number in enumerate(order) if place}
        used = {other for references in links.values() for other, _ in references}
        decoded = [None] * len(order)
        sizes, maps, by_role = np.zeros(2), [], {}
        for number in order:
            role = 0 if number == order[0] else 1 if number in used else 2
            step = None if threshold is None else threshold * way.steps[role]
            values = capture.pictures[number].astype(np.float32)
            prediction = 128.0
            if number in links:
                depth, mode = self.blocks(number, links[number], decoded, step, way)
                maps.append((depth, mode))
                inverse = inverse_depths_of(capture, way.depths)[depth]
                prediction = predicted(capture, number, links[number], decoded, inverse, mode, way,
                                       way.block // self.scale)
            if step is None:
                size = model.code_lossless(np.rint(values - prediction))
                decoded[number] = values
            else:
                packets = []
                size, rest = model.code(values - prediction, step, packets)
                if kept is not None:
                    kept.append(packets)
                decoded[number] = model.clipped(rest + prediction).astype(np.float32)
            sizes += size
            by_role.setdefault(role, []).append(size.tolist())
        if way.shared:
            maps = [(self.map_of_group(way, step)[0], mode) for _, mode in maps[:1]] + \
                   [(np.zeros_like(mode), mode) for _, mode in maps[1:]]
        modes = max(len(shares_of(references, way.modes)) for references in links.values())
        depth_bits, mode_bits = side_bits(maps, modes)
        side = (depth_bits + mode_bits) / 8
        return {"bytes": (sizes + side).tolist(), "side": side, "depth_bytes": depth_bits / 8,
                "pictures": [model.clipped(picture) for picture in decoded],
                "roles": {role: np.mean(of_role, 0).tolist() for role, of_role in by_role.items()}}

    def blocks(self, number, references, decoded, step, way):
        """Returns the numbers of the depths and the modes of the blocks of an LF image."""
        pictures = decoded if way.closed else self.capture.pictures
        errors = in_blocks(self.search.errors(number, references, pictures, way.depths, way.modes, self.scale),
                           way.block // CELL)
        rate = way.smoothness * model.STEP_PER_THRESHOLD * (step or 1)
        if not way.shared:
            return chosen(errors, rate)
        depth = self.warped_map(way, step, number, errors.shape[2:])
        mode = np.take_along_axis(errors, depth[None, None], 0)[0].argmin(0) if errors.shape[1] > 1 else \
            np.zeros_like(depth)
        return depth, mode

    def map_of_group(self, way, step):
        """Returns the numbers of the depths of the blocks of the key image, found with all others."""
        key = order_of(self.capture, way.key)[0]
        others = [(number, 1.0) for number in range(len(self.capture.pictures)) if number != key]
        errors = in_blocks(self.search.errors(key, others, self.capture.pictures, way.depths, "mean", self.scale),
                           way.block // CELL)
        return chosen(errors, way.smoothness * model.STEP_PER_THRESHOLD * (step or 1))

    def warped_map(self, way, step, number, shape):
        """Returns the key image's depths as another LF image sees them: the nearest one that falls into a block, or
        that of the block at the same place in the key image."""
        key, block = order_of(self.capture, way.key)[0], way.block // self.scale
        depth = self.map_of_group(way, step)[0]
        a, b = self.capture.homography(key, number)
        inverse = inverse_depths_of(self.capture, way.depths)
        found = np.full(shape, -1)
        step_px = max(1, block // 4)
        for y in range(step_px // 2, shape[0] * block, step_px):
            for x in range(step_px // 2, shape[1] * block, step_px):
                index = depth[y // block, x // block]
                at = a @ (x + 0.5, y + 0.5, 1) + inverse[index] * b
                row, column = int(at[1] / at[2] // block), int(at[0] / at[2] // block)
                if 0 <= row < shape[0] and 0 <= column < shape[1]:
                    found[row, column] = max(found[row, column], index)
        return np.where(found < 0, depth, found)

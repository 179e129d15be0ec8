# SPDX-License-Identifier: Apache-2.0
"""Contexts of the entropy coder that prediction_gain.py compares, on LF images and on the rest after prediction."""
import numpy as np

import prediction_groups as groups
import prediction_model as model

THRESHOLDS = (3, 8)


def _at(magnitudes, down, across):
    """Returns the magnitudes of the neighbours at this place; 0 beyond the borders."""
    height, width = magnitudes.shape
    return np.pad(magnitudes, 2)[2 + down:2 + down + height, 2 + across:2 + across + width]


def _row_above(magnitudes, _):
    return 2 * _at(magnitudes, -1, 0) + 2 * _at(magnitudes, -1, -1) + 2 * _at(magnitudes, -1, 1)


def _nearest(magnitudes, _):
    return 3 * _at(magnitudes, 0, -1) + 3 * _at(magnitudes, -1, 0)


def _four(magnitudes, _):
    return (2 * _at(magnitudes, 0, -1) + 2 * _at(magnitudes, -1, 0) + _at(magnitudes, -1, -1) + _at(magnitudes, -1, 1))


def _six(magnitudes, parent):
    return _four(magnitudes, parent) + _at(magnitudes, 0, -2) + _at(magnitudes, -2, 0)


def _with_parent(magnitudes, parent):
    if parent is None:
        return _four(magnitudes, parent)
    height, width = magnitudes.shape
    finer = np.repeat(np.repeat(parent, 2, 0), 2, 1)
    finer = np.pad(finer, ((0, max(0, height - len(finer))), (0, max(0, width - finer.shape[1]))), mode="edge")
    return _four(magnitudes, parent) + 2 * finer[:height, :width]


SIX_LIMITS, MORE_LIMITS = (1, 2, 4, 8, 18), (1, 2, 5, 10, 24)
# Words of the table: (sum of magnitudes, limits between contexts)
ROWS = {"one context": (_four, ()),
        "6, row above": (_row_above, SIX_LIMITS),
        "6, W and N": (_nearest, SIX_LIMITS),
        "4, 2 W + 2 N + NW + NE": (_four, (1, 4, 12)),
        "6, 2 W + 2 N + NW + NE": (_four, SIX_LIMITS),
        "11, 2 W + 2 N + NW + NE": (_four, model.CONTEXT_LIMITS),
        "6, with WW and NN": (_six, MORE_LIMITS),
        "6, with the coefficient of the coarser level": (_with_parent, MORE_LIMITS)}


def packets_of(capture, threshold, predicted):
    """Returns the packets of three LF images: [[bands] of each level and component, finest level first]."""
    if predicted:
        kept = []
        groups.Group(capture).code(threshold, groups.Way(), kept)
        return kept[4::5]
    kept = []
    for picture in capture.pictures[4::5]:
        kept.append([])
        model.code(picture.astype(np.float32) - 128, threshold, kept[-1])
    return kept


def change_of(packets, sum_of, limits):
    """Returns the bytes against those of the packing, less 1."""
    packed = bits = 0
    for image in packets:
        for place, bands in enumerate(image):
            has_parent = (place + 1) % model.LEVELS > 0
            parents = image[place + 1] if has_parent else [None] * 3
            sums = iter([sum_of(np.abs(band), None if parent is None else np.abs(parent))
                         for band, parent in zip(bands, parents)])
            bits += model.context_bits(bands, limits, sums=lambda _: next(sums))[0]
            packed += model.packed_bytes(np.concatenate([band.ravel() for band in bands]))
    return bits / 8 / packed - 1

# SPDX-License-Identifier: Apache-2.0
"""The codec of LF images in NumPy, for prediction_gain.py: the 5/3 wavelets, the quantiser and the packing of
lf/pixels/codec, and beside the packing an ideal coder with contexts.

Pictures are float32 [height][width][channels]: R G B, or the four colours of a mosaic, each a picture of half the size:
the pixels at (even, even), (odd, even), (even, odd) and (odd, odd) columns and rows. Sizes are in bytes and leave out
heads and tables of contents, which all ways have.
"""
import cv2
import numpy as np
import zstandard

LEVELS = 4
DEAD_ZONE = 2 / 3  # coefficients below this part of a step become 0
STEP_PER_THRESHOLD = 1.5
NORMS_OF_COLOURS = (3 ** 0.5, 0.75 ** 0.5, 0.5 ** 0.5)  # of y, cg and co

# The settings of lf/pixels/codec/entropy.cc.
_zstd = zstandard.ZstdCompressor(compression_params=zstandard.ZstdCompressionParameters.from_level(
    1, min_match=7, hash_log=6, write_content_size=0))


def halves(x, lossless):
    """Returns low and high along the first axis."""
    low, high = x[0::2].copy(), x[1::2].copy()
    after = low[1:] if len(low) > len(high) else np.concatenate([low[1:], low[-1:]])
    high -= (low[:len(high)] + after) >> 1 if lossless else (low[:len(high)] + after) / 2
    before = np.concatenate([high[:1], high])[:len(low)]
    here = high if len(high) == len(low) else np.concatenate([high, high[-1:]])
    low += (before + here + 2) >> 2 if lossless else (before + here) / 4
    return low, high


def joined(low, high):
    """Returns the inverse of halves() of floats."""
    low, high = low.copy(), high.copy()
    before = np.concatenate([high[:1], high])[:len(low)]
    here = high if len(high) == len(low) else np.concatenate([high, high[-1:]])
    low -= (before + here) / 4
    after = low[1:] if len(low) > len(high) else np.concatenate([low[1:], low[-1:]])
    high += (low[:len(high)] + after) / 2
    x = np.empty((len(low) + len(high),) + low.shape[1:], low.dtype)
    x[0::2], x[1::2] = low, high
    return x


def bands_of(plane, lossless=False):
    """Returns LL, HL, LH, HH; the first letter is of the horizontal direction."""
    low, high = (half.T for half in halves(np.ascontiguousarray(plane.T), lossless))
    low_low, low_high = halves(low, lossless)
    high_low, high_high = halves(high, lossless)
    return low_low, high_low, low_high, high_high


def plane_of(low_low, high_low, low_high, high_high):
    return joined(joined(low_low, low_high).T, joined(high_low, high_high).T).T


def _norm(level, is_high):
    x = np.zeros(64)
    x[32] = 1
    for number in range(level):
        x = joined(np.zeros_like(x), x) if is_high and number == 0 else joined(x, np.zeros_like(x))
    return float(np.sqrt((x ** 2).sum()))


NORMS = {(level, high): _norm(level, high) for level in range(1, LEVELS + 1) for high in (False, True)}
_LOW, _HIGH = NORMS[1, False], NORMS[1, True]
NORMS_OF_MOSAICS = (_LOW * _LOW, _HIGH * _LOW, _LOW * _HIGH, _HIGH * _HIGH)


def mosaic_of(quarters):
    mosaic = np.empty((2 * quarters.shape[0], 2 * quarters.shape[1]), quarters.dtype)
    for i in range(4):
        mosaic[i // 2::2, i % 2::2] = quarters[..., i]
    return mosaic


def quarters_of(mosaic):
    return np.stack([mosaic[i // 2::2, i % 2::2] for i in range(4)], -1)


def components_of(values):
    """Returns the components, and the norm of the picture of one value of each."""
    if values.shape[-1] == 4:
        return bands_of(mosaic_of(values)), NORMS_OF_MOSAICS
    r, g, b = (values[..., i] for i in range(3))
    co = r - b
    t = b + co / 2
    cg = g - t
    return (t + cg / 2, cg, co), NORMS_OF_COLOURS


def values_of(components):
    if len(components) == 4:
        return quarters_of(plane_of(*components))
    y, cg, co = components
    t = y - cg / 2
    b = t - co / 2
    return np.stack([b + co, cg + t, b], -1)


def integer_components_of(values):
    """Returns the components of integers that the profile lossless has."""
    if values.shape[-1] == 4:
        return bands_of(mosaic_of(values), True)
    r, g, b = (values[..., i] for i in range(3))
    co = r - b
    t = b + (co >> 1)
    cg = g - t
    return t + (cg >> 1), cg, co


def _entropy_bytes(symbols):
    counts = np.bincount(symbols)
    counts = counts[counts > 0]
    return float(-(counts * np.log2(counts / counts.sum())).sum() / 8)


def _packed(numbers, per_byte):
    few = np.minimum(numbers, (1 << (8 // per_byte)) - 1)
    few = np.pad(few, (0, -len(few) % per_byte)).reshape(-1, per_byte)
    return sum(few[:, place] << (8 // per_byte * place) for place in range(per_byte)).astype(np.uint8)


def _planes(numbers):
    return np.concatenate([(numbers >> shift) & 255 for shift in (0, 8)]).astype(np.uint8)


def _best_packing(numbers, depth):
    """Returns (estimated bytes, values per byte) as BestPacking() of lf/pixels/codec/packing.cc does; 0 per byte stands
    for whole planes of bytes."""
    if len(numbers) == 0 or not numbers.any():
        return 1, 4
    offers = []
    if numbers.max() >= 255:
        planes = _planes(numbers)
        offers.append((40 + sum(map(_entropy_bytes, np.split(planes, 2))), 0))
    for per_byte in (1, 2, 4):
        escape = (1 << (8 // per_byte)) - 1
        escapes = numbers[numbers >= escape] - escape
        if len(escapes) and depth == 4:
            continue
        cost = 40 + _entropy_bytes(_packed(numbers, per_byte))
        if len(escapes) and (not offers or cost < min(offers)[0]):
            cost += _best_packing(escapes, depth + 1)[0]
        offers.append((cost, per_byte))
    return min(offers)


def _number_bytes(number):
    return max(1, (int(number).bit_length() + 6) // 7)


def packed_bytes(coefficients, depth=0):
    """Returns the size of a stream of signed integers, packed and compressed as lfcompressor does."""
    numbers = (coefficients << 1) ^ (coefficients >> 31) if depth == 0 else coefficients
    if len(numbers) == 0 or not numbers.any():
        return 1
    per_byte = _best_packing(numbers, depth)[1]
    data = _planes(numbers) if per_byte == 0 else _packed(numbers, per_byte)
    frame = len(_zstd.compress(data.tobytes()))
    size = 1 + _number_bytes(frame) + frame
    if per_byte:
        escape = (1 << (8 // per_byte)) - 1
        escapes = numbers[numbers >= escape] - escape
        size += _number_bytes(len(escapes)) + (packed_bytes(escapes, depth + 1) if len(escapes) else 0)
    return size


def counted_bits(contexts, symbols, context_count, symbol_count):
    """Returns the bits of symbols whose frequencies are counted in each context, and the bits of the counts: half the
    logarithm of the number of symbols for each count that is not 0."""
    counts = np.bincount(contexts * symbol_count + symbols, minlength=context_count * symbol_count)
    counts = counts.reshape(context_count, symbol_count).astype(float)
    sums = counts.sum(1, keepdims=True)
    some = counts > 0
    bits = -(counts[some] * np.log2((counts / np.maximum(sums, 1))[some])).sum()
    tables = (some.sum(1) / 2 * np.log2(np.maximum(sums[:, 0], 2))).sum()
    return float(bits), float(tables)


CONTEXT_LIMITS = (1, 2, 3, 4, 6, 9, 14, 22, 36, 60)


def context_sums(band):
    """Returns 2 W + 2 N + NW + NE of the magnitudes of the neighbours that are decoded before a coefficient."""
    magnitudes = np.pad(np.abs(band), ((1, 0), (1, 1)))
    return 2 * magnitudes[1:, :-2] + 2 * magnitudes[:-1, 1:-1] + magnitudes[:-1, :-2] + magnitudes[:-1, 2:]


def tokens_of(magnitudes, direct):
    """Returns (tokens, raw bits): magnitudes below `direct`, a power of 2, are tokens; of larger ones the token tells
    the length and the highest two bits, and the other bits are raw."""
    tokens, raw = magnitudes.copy(), np.zeros(magnitudes.shape, int)
    large = magnitudes >= direct
    over = magnitudes[large]
    length = np.floor(np.log2(np.maximum(over, 1))).astype(int)
    tokens[large] = direct + 2 * (length - int(np.log2(direct))) + ((over >> (length - 1)) & 1)
    raw[large] = length - 1
    return tokens, raw


def context_bits(bands, limits=CONTEXT_LIMITS, direct=8, sums=context_sums):
    """Returns (bits, bits of tables among them) of the bands of one packet and component."""
    contexts = np.concatenate([np.searchsorted(limits, sums(band).ravel(), side="right") for band in bands])
    magnitudes = np.abs(np.concatenate([band.ravel() for band in bands])).astype(int)
    tokens, raw = tokens_of(magnitudes, direct)
    bits, tables = counted_bits(contexts, tokens, len(limits) + 1, direct + 32)
    return bits + tables + int(raw.sum()) + int((magnitudes > 0).sum()), tables


def sizes_of(bands):
    """Returns the bytes of the bands of one packet and component: packed, and with contexts."""
    return np.array([packed_bytes(np.concatenate([band.ravel() for band in bands])), context_bits(bands)[0] / 8])


def with_differences(low):
    """Returns approximations as they are stored: differences to the value above or before."""
    rest = low.copy()
    rest[1:] -= low[:-1]
    rest[0, 1:] -= low[0, :-1]
    return rest


def quantized(band, step):
    return (np.sign(band) * np.floor(np.abs(band) / step + 1 - DEAD_ZONE)).astype(np.int32)


def code(values, threshold, keep=None):
    """Codes a picture less its prediction with loss. Returns (bytes [packed, contexts], decoded values).

    keep  a list that gets the bands of each packet and component
    """
    sizes, decoded, step = np.zeros(2), [], STEP_PER_THRESHOLD * threshold
    components, norms = components_of(values.astype(np.float32))
    for component, norm in zip(components, norms):
        low, levels = component, []
        for level in range(1, LEVELS + 1):
            low, *bands = bands_of(low)
            packet, details = [], []
            for band, (across, down) in zip(bands, ((1, 0), (0, 1), (1, 1))):
                of_band = step / norm / NORMS[level, bool(across)] / NORMS[level, bool(down)]
                packet.append(quantized(band, of_band))
                details.append((packet[-1] * of_band).astype(np.float32))
            sizes += sizes_of(packet)
            if keep is not None:
                keep.append(packet)
            levels.append(details)
        of_band = step / norm / NORMS[LEVELS, False] ** 2
        rounded = np.rint(low / of_band).astype(np.int32)
        sizes += sizes_of([with_differences(rounded)])
        low = (rounded * of_band).astype(np.float32)
        for details in reversed(levels):
            low = plane_of(low, *details)
        decoded.append(low)
    return sizes, values_of(decoded)


def code_lossless(values):
    """Returns the bytes [packed, contexts] of integers, without loss."""
    sizes = np.zeros(2)
    for component in integer_components_of(values.astype(np.int32)):
        low = component
        for _ in range(LEVELS):
            low, *bands = bands_of(low, True)
            sizes += sizes_of(bands)
        sizes += sizes_of([with_differences(low)])
    return sizes


def clipped(values):
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)


def luma_of(values):
    """Returns the brightness that depths are searched in."""
    weights = (0.3, 0.59, 0.11) if values.shape[-1] == 3 else (0.25,) * 4
    return values.astype(np.float32) @ np.float32(weights)


def colours_of(values):
    """Returns R G B of a picture; of a mosaic (RGGB), by bilinear interpolation."""
    if values.shape[-1] == 3:
        return values
    return cv2.cvtColor(np.ascontiguousarray(mosaic_of(values)), cv2.COLOR_BayerBG2RGB)

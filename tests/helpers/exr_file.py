# SPDX-License-Identifier: Apache-2.0
"""Reads EXR files as lfrenderer writes them, for tests: written from the description of the file layout
(openexr.com, "OpenEXR File Layout"), without OpenEXR."""
import struct
import zlib

import numpy as np

BLOCK_ROWS = {2: 1, 3: 16}  # rows that are compressed together, by the compression: zips, zip
PIXEL_TYPES = [np.dtype("<u4"), np.dtype("<f2"), np.dtype("<f4")]

# Formats of attribute values by type; other types, such as channel lists, stay bytes.
FORMATS = {"int": "<i", "float": "<f", "double": "<d", "v2f": "<2f", "rational": "<iI",
           "chromaticities": "<8f", "m44f": "<16f", "box2i": "<4i", "compression": "<B"}


def read_header(data, at=8):
    """Returns the attributes of the part whose header begins at a byte, {name: (type, value)}, and the index of the
    byte after its header. The header of the first part begins at byte 8.

    A matrix is an array [row][column]; a value of one number is that number, other values are tuples, texts or bytes.
    """
    attributes = {}
    while data[at]:
        words = []
        for _ in range(2):
            end = data.index(b"\0", at)
            words.append(data[at:end].decode())
            at = end + 1
        size, = struct.unpack_from("<i", data, at)
        name, kind = words
        attributes[name] = kind, _value(kind, data[at + 4:at + 4 + size])
        at += 4 + size
    return attributes, at + 1


def channels_of(path):
    """Returns {name: array [height][width]} of a file of rows that are compressed by zip or zips."""
    data = path.read_bytes()
    header, at = read_header(data)
    return _channels(data, header, at, 0)


def parts_of(path):
    """Returns, for each part of a file of several parts, its attributes {name: value} and its channels, as
    attributes_of() and channels_of() do."""
    data = path.read_bytes()
    assert struct.unpack_from("<I", data, 4)[0] & 0x1000, "expected a file of several parts"
    headers, at = [], 8
    while data[at]:
        header, at = read_header(data, at)
        headers.append(header)
    at += 1
    parts = []
    for header in headers:
        parts.append(({name: value for name, (_, value) in header.items()}, _channels(data, header, at, 4)))
        at += 8 * header["chunkCount"][1]
    return parts


def _channels(data, header, at, extra):
    """Returns the channels of a part whose table of blocks begins at a byte. Each block begins with `extra` bytes."""
    block_rows = BLOCK_ROWS[header["compression"][1]]
    left, top, right, bottom = header["dataWindow"][1]
    width, height = right - left + 1, bottom - top + 1
    types = _channel_types(header["channels"][1])
    row = np.dtype([(name, kind, width) for name, kind in types.items()])
    rows = np.empty(height, row)
    for block, offset in enumerate(np.frombuffer(data, "<u8", -(-height // block_rows), at)):
        pixels = int(offset) + extra + 8
        begin, size = struct.unpack_from("<ii", data, pixels - 8)
        assert begin - top == block * block_rows
        count = min(block_rows, height - block * block_rows)
        packed = data[pixels:pixels + size]
        rows[begin - top:begin - top + count] = np.frombuffer(
            packed if size == count * row.itemsize else _unpacked(packed), row)
    return {name: rows[name] for name in types}


def _channel_types(data):
    """Returns {name: type of pixels}, in the order of the file."""
    types, at = {}, 0
    while data[at]:
        end = data.index(b"\0", at)
        types[data[at:end].decode()] = PIXEL_TYPES[data[end + 1]]
        at = end + 17  # type, linearity and two samplings follow the name
    return types


def _unpacked(packed):
    """Undoes the three steps of zip compression: deflation, differences and the sorting of bytes."""
    differences = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
    differences[1:] -= 128
    sorted_bytes = np.cumsum(differences).astype(np.uint8)
    half = (len(sorted_bytes) + 1) // 2
    result = np.empty_like(sorted_bytes)
    result[::2], result[1::2] = sorted_bytes[:half], sorted_bytes[half:]
    return result.tobytes()


def attributes_of(path):
    """Returns {name: value} of a file."""
    return {name: value for name, (_, value) in read_header(path.read_bytes())[0].items()}


def _value(kind, data):
    if kind == "string":
        return data.decode()
    if kind not in FORMATS:
        return data
    numbers = struct.unpack(FORMATS[kind], data)
    if kind == "m44f":
        return np.reshape(numbers, (4, 4))
    return numbers[0] if len(numbers) == 1 else numbers
